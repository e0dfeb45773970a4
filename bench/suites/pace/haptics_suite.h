// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// Measures the local model at 1 kHz between simulated devices and tissue (docs/haptics.md): forces, limit cycles and
/// energy, over masses, delays and tissues.
void hapticsSuite(Report& report);

}  // namespace viscera::bench
