// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// Compares sutures with the laws of docs/sutures.md: bending, hanging, sliding over obstacles and through channels,
/// knots, pulling, flight, cost, stress.
void sutureSuite(Report& report);

}  // namespace viscera::bench
