// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// Measures how far organs with thin walls and a block of two materials hang beside CalculiX's (docs/material.md).
void wallsSuite(Report& report);

}  // namespace viscera::bench
