// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// A device in a hand touches tissue again and again (docs/haptics.md 3): what it gives back in all, also where the
/// delay of the device is another than was told.
void hapticsPokes(Report& report);

}  // namespace viscera::bench
