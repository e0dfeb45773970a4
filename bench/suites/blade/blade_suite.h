// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// Compares forces and work of blades that tissue resists with the law of docs/cutting.md.
void bladeSuite(Report& report);

}  // namespace viscera::bench
