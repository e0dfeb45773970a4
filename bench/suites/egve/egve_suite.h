// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// EGVE's experiments with its mappings: what each costs, and, which the paper has not, how far each is off.
void egveSuite(Report& report);

}  // namespace viscera::bench
