// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// Measures tissue that is torn by pulling: a notched strip and a trouser test. Part of bladeSuite().
void bladeTears(Report& report);

}  // namespace viscera::bench
