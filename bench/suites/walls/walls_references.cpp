// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Output of bench/references/walls.py (CalculiX 2.20): with --levels 2 3 for bowl, block and, except for nu 0.49,
// bladder; otherwise with the defaults.
#include "bench/suites/walls/walls_references.h"

#include <cmath>
#include <stdexcept>

namespace viscera::bench {

namespace {

const std::vector<WallsReference> kReferences = {
    {"bowl", 0.3, 30.03e-3, 0.001, 0.0006, 38909},      {"bowl", 0.45, 30.75e-3, 0.005, 0.003, 38909},
    {"bowl", 0.49, 30.76e-3, 0.01, 0.005, 38909},       {"bladder", 0.3, 5.97e-3, 0.003, 0.001, 59133},
    {"bladder", 0.45, 6.309e-3, 0.008, 0.004, 59133},   {"bladder", 0.49, 6.382e-3, 0.04, 0.02, 18855},
    {"tube", 0.3, 15.23e-3, 0.0007, 8e-05, 8543},       {"tube", 0.45, 14.65e-3, 0.001, 0.0002, 8543},
    {"tube", 0.49, 14.45e-3, 0.002, 0.0002, 8543},      {"ellipsoid", 0.3, 12.92e-3, 0.001, 0.0008, 13539},
    {"ellipsoid", 0.45, 13.49e-3, 0.004, 0.003, 13539}, {"ellipsoid", 0.49, 13.61e-3, 0.009, 0.006, 13539},
    {"torus", 0.3, 3.892e-3, 0.0003, 0.0001, 7950},     {"torus", 0.45, 3.98e-3, 0.002, 0.0008, 7950},
    {"torus", 0.49, 3.99e-3, 0.004, 0.002, 7950},       {"stomach", 0.3, 32.58e-3, 0.001, 0.0006, 22609},
    {"stomach", 0.45, 33.52e-3, 0.005, 0.002, 22609},   {"stomach", 0.49, 33.64e-3, 0.009, 0.005, 22609},
    {"block", 0.3, 11.66e-3, 0.002, 0.002, 20811},      {"block", 0.45, 11.62e-3, 0.005, 0.003, 20811},
    {"block", 0.49, 11.55e-3, 0.01, 0.006, 20811},
};

}  // namespace

const std::vector<WallsReference>& wallsReferences() {
  return kReferences;
}

const WallsReference& wallsReference(const std::string& organ, double nu) {
  for (const WallsReference& reference : kReferences) {
    if (organ == reference.organ && std::abs(nu - reference.nu) < 1e-9) return reference;
  }
  throw std::invalid_argument("no reference of " + organ);
}

}  // namespace viscera::bench
