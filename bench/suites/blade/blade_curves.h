// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// Parts of the suite. Compares a needle in liver with the published curve (bladeOnset), and measures a user's stroke
/// that presses a blade into tissues and draws it (bladeTool).
void bladeOnset(Report& report);
void bladeTool(Report& report);

}  // namespace viscera::bench
