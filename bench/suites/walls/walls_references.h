// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace viscera::bench {

/// CalculiX's result for an organ under its weight.
struct WallsReference {
  const char* organ;
  double nu;
  double mean_m;   ///< displacement along gravity, mean over the mass, small strain, E 20 kPa, 1060 kg/m3, 9.81 m/s2
                   ///< [m]; extrapolated, see bench/references/walls.py
  double full;     ///< relative excess over the finest mesh of C3D20
  double reduced;  ///< same for C3D20R
  int nodes;       ///< number of nodes of that mesh, for half the organ
};
constexpr double kWallsYoung_pa = 20e3, kWallsSoft_pa = 2e3, kWallsDensity_kg_per_m3 = 1060, kWallsGravity = 9.81;

/// Returns all references.
const std::vector<WallsReference>& wallsReferences();

/// Returns the reference of an organ. @throws std::invalid_argument  there is none
const WallsReference& wallsReference(const std::string& organ, double nu);

}  // namespace viscera::bench
