// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/process.h"

namespace viscera {

uint64_t hashWith(uint64_t hash, const TissueProcess& process) {
  StateHash with;
  with.add(static_cast<uint32_t>(hash));
  with.add(static_cast<uint32_t>(hash >> 32));
  return process.addTo(with) ? with.value() : hash;
}

}  // namespace viscera
