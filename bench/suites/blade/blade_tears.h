// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// Part of bladeSuite(): tissue that is pulled apart, in a notched strip and a trouser test.
void bladeTears(Report& report);

}  // namespace viscera::bench
