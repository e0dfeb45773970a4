// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// Measures the speed of the solver: by size, instruction set, connections, features, sleep and views; a scene's
/// substeps.
void speedSuite(Report& report);

}  // namespace viscera::bench
