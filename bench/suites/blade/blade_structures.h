// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// Measures the law of docs/cutting.md in sheets and explicit lattices.
void bladeStructures(Report& report);

}  // namespace viscera::bench
