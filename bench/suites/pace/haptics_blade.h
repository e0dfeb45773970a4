// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// Measures a held device that pushes a blade into tissue that resists it (docs/cutting.md): stiff while the edge is
/// stuck, constant while it cuts, passive.
void hapticsBlade(Report& report);

}  // namespace viscera::bench
