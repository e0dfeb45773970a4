// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/state/cpu_store.h"

#include "solver/tissue/joined_lattice.h"

namespace viscera {

namespace {

std::vector<uint32_t> firstOfBricks(const std::vector<uint32_t>& active, size_t bricks) {
  std::vector<uint32_t> out(bricks + 1);
  for (uint32_t slot : active) ++out[slot / layout::kBrickSlots + 1];
  for (size_t b = 0; b < bricks; ++b) out[b + 1] += out[b];
  return out;
}

}  // namespace

CpuStore::CpuStore(const Model& model, const std::vector<layout::BodyParams>& params)
    : bricks(allBricks(model)),
      bodies(params),
      nodes(allNodes(model)),
      whole_nodes(nodes),
      active(activeSlots(model)),
      first_active(firstOfBricks(active, bricks.size())),
      cells(cellSlots(model)) {}

}  // namespace viscera
