// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// Runs EGVE's experiments on its mappings: the cost of each, and its error, which the paper does not report.
void egveSuite(Report& report);

}  // namespace viscera::bench
