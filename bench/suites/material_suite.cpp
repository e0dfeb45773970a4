// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/material_suite.h"

#include "bench/suites/material_parts.h"

namespace viscera::bench {

void materialSuite(Report& report) {
  measureTension(report);
  measureFiniteStretch(report);
  measureChains(report);
  measurePlaneWaves(report);
  measureCantilever(report);
  measureIndentation(report);
  measureWalls(report);
  measureCircle(report);
  measureContact(report);
}

}  // namespace viscera::bench
