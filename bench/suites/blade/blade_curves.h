// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// Parts of the suite: a needle in liver beside the published curve; a hand that presses a blade into tissues and draws
/// it.
void bladeOnset(Report& report);
void bladeHand(Report& report);

}  // namespace viscera::bench
