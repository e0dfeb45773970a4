// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// Measures the sag of organs with thin walls and of a block of two materials against CalculiX (docs/material.md).
void wallsSuite(Report& report);

}  // namespace viscera::bench
