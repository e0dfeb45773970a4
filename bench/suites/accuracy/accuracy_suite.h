// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// Measures the errors of time integration and of float32 (docs/verification.md): errors (a) and (b) of physics.md 7,
/// separately.
void accuracySuite(Report& report);

}  // namespace viscera::bench
