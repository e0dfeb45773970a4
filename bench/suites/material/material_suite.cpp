// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/material/material_suite.h"

#include "bench/suites/material/material_parts.h"

namespace viscera::bench {

void materialSuite(Report& report) {
  measureParts(report, {{"tension", measureTension},
                        {"stretch", measureFiniteStretch},
                        {"chains", measureChains},
                        {"waves", measurePlaneWaves},
                        {"cantilever", measureCantilever},
                        {"indentation", measureIndentation},
                        {"walls", measureWalls},
                        {"circle", measureCircle},
                        {"law", measureLaw},
                        {"contact", measureContact}});
}

}  // namespace viscera::bench
