// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace viscera::bench {

/// What CalculiX finds of an organ under its weight.
struct WallsReference {
  const char* organ;
  double nu;
  double mean_m;   ///< displacement along gravity, mean of the mass, small strain, E 20 kPa, 1060 kg/m3, 9.81 m/s2
  double unsure;   ///< half of what full and reduced integration are apart, as a share
  double refined;  ///< change from the coarser mesh, as a share
};
constexpr double kWallsYoung_pa = 20e3, kWallsSoft_pa = 2e3, kWallsDensity_kg_per_m3 = 1060, kWallsGravity = 9.81;

/// Returns the reference of an organ. @throws std::invalid_argument  there is none
const WallsReference& wallsReference(const std::string& organ, double nu);

}  // namespace viscera::bench
