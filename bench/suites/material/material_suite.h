// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// Measures whether the lattice is a material with the given E, nu and density (docs/material.md).
void materialSuite(Report& report);

}  // namespace viscera::bench
