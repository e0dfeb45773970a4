// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What bench/references/walls.py prints (CalculiX 2.20), of levels 2 and 3.
#include "bench/suites/walls/walls_references.h"

#include <cmath>
#include <stdexcept>

namespace viscera::bench {

namespace {

constexpr WallsReference kReferences[] = {
    {"bowl", 0.3, 29.941e-3, 0.0012, 0},
    {"bowl", 0.45, 30.451e-3, 0.0028, 0},
    {"bowl", 0.49, 30.25e-3, 0.0061, 0},
    {"bladder", 0.3, 5.9359e-3, 0.0024, 0},
    {"bladder", 0.45, 6.2205e-3, 0.0057, 0},
    {"bladder", 0.49, 6.1969e-3, 0.013, 0},
    {"tube", 0.3, 15.228e-3, 0.0003, 0},
    {"tube", 0.45, 14.64e-3, 0.0005, 0},
    {"tube", 0.49, 14.438e-3, 0.0008, 0},
    {"ellipsoid", 0.3, 12.909e-3, 0.0002, 0},
    {"ellipsoid", 0.45, 13.438e-3, 0.0006, 0},
    {"ellipsoid", 0.49, 13.502e-3, 0.0014, 0},
    {"torus", 0.3, 3.8914e-3, 0.0001, 0},
    {"torus", 0.45, 3.9746e-3, 0.0004, 0},
    {"torus", 0.49, 3.9773e-3, 0.0009, 0},
    {"stomach", 0.3, 1e-3, 0.01, 0},
    {"stomach", 0.45, 1e-3, 0.01, 0},
    {"stomach", 0.49, 1e-3, 0.01, 0},
    {"two", 0.3, 1e-3, 0.01, 0},
    {"two", 0.45, 1e-3, 0.01, 0},
    {"two", 0.49, 1e-3, 0.01, 0},
};

}  // namespace

const WallsReference& wallsReference(const std::string& organ, double nu) {
  for (const WallsReference& reference : kReferences) {
    if (organ == reference.organ && std::abs(nu - reference.nu) < 1e-9) return reference;
  }
  throw std::invalid_argument("no reference of " + organ);
}

}  // namespace viscera::bench
