// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "viscera/math/types.h"

namespace viscera {

/// Short piece of a lumen with one pressure.
struct LumenStation {
  Vector3d at_m = Vector3d::Zero();   ///< its middle at rest, tissue frame
  Vector3d along = Vector3d::Zero();  ///< unit vector along the lumen; 0: a cavity that is no tube
  double length_m = 0;                ///< along the lumen
  double area_m2 = 0;                 ///< cross-section at rest
  double supply_m3_per_s = 0;         ///< flow into it where its pressure is 0; 0: not supplied
  uint32_t axis = 0;                  ///< number of the tube or branch that it is a piece of
};

/// Flow in a lumen (docs/physics.md 18): Poiseuille's between stations, that of an orifice out of openings.
struct LumenNetwork {
  std::vector<LumenStation> stations;
  std::vector<std::array<uint32_t, 2>> links;  ///< pairs of stations that join

  /// State of the stations.
  struct Openings {
    std::vector<double> open_m2;     ///< [stations] area of holes to the outside
    std::vector<double> narrowing;   ///< [stations] current cross-section over that at rest
    std::vector<uint8_t> is_closed;  ///< [stations] no fluid passes
  };
  struct Flow {
    std::vector<double> pressure_pa;       ///< [stations]
    std::vector<double> outflow_m3_per_s;  ///< [stations] out of holes
  };
  /// Returns the steady flow. @param source_pa  pressure behind the supplies   @param guess_pa  [stations] of pressures
  Flow solve(double source_pa, const Openings& at, const std::vector<double>& guess_pa) const;
};

/// Returns Poiseuille's conductance of a round lumen of a cross-section and a length [m3/(s Pa)].
double poiseuilleConductance(double area_m2, double length_m);

}  // namespace viscera
