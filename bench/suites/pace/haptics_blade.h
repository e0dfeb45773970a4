// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// A device in a hand pushes a blade into tissue that resists it (docs/cutting.md): stiff while the edge is stuck,
/// level while it cuts, passive.
void hapticsBlade(Report& report);

}  // namespace viscera::bench
