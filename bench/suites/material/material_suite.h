// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// Is the lattice the material that its E, nu and density say (docs/material.md)?
void materialSuite(Report& report);

}  // namespace viscera::bench
