// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// What does time cost, and what does float32 (docs/accuracy.md)? Errors (a) and (b) of physics.md 7, never mixed.
void accuracySuite(Report& report);

}  // namespace viscera::bench
