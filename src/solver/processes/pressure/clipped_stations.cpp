// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/pressure/clipped_stations.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace viscera {

namespace {

constexpr double kClosesAcross = 0.5;  // radii to both sides of its axis that a clip must reach to close a lumen
constexpr double kClipPi = 3.14159265358979323846;

/// Reach of a clip along one tube or branch.
struct ClipReach {
  double low = 0, high = 0;  ///< to both sides of the axis [radii]
  std::vector<size_t> stations;
};

}  // namespace

std::vector<uint8_t> clippedStations(const LumenNetwork& lumen, uint32_t body,
                                     const std::vector<Clips::Squeezed>& squeezed) {
  std::vector<uint8_t> out(lumen.stations.size(), 0);
  const auto isOfBody = [&](const Clips::Squeezed& one) { return one.bodies[0] == body && one.bodies[1] == body; };
  // All vectors of a clip run from one jaw to the other one, so that their sum is its direction.
  std::map<uint32_t, Vector3d> across;
  for (const Clips::Squeezed& one : squeezed)
    if (isOfBody(one)) across.try_emplace(one.clip, Vector3d::Zero()).first->second += one.ends_m[1] - one.ends_m[0];
  std::map<std::pair<uint32_t, uint32_t>, ClipReach> reaches;  // by clip and axis
  for (const Clips::Squeezed& one : squeezed) {
    if (!isOfBody(one)) continue;
    const auto& [a, b] = one.ends_m;
    for (size_t i = 0; i < lumen.stations.size(); ++i) {
      const LumenStation& station = lumen.stations[i];
      const Vector3d middle = 0.5 * (a + b) - station.at_m;
      if (station.length_m == 0 || std::abs(middle.dot(station.along)) > 0.5 * station.length_m ||
          middle.norm() > (b - a).norm())
        continue;
      const Vector3d aside = station.along.cross(across.at(one.clip)).stableNormalized();
      const double radii = middle.dot(aside) / std::sqrt(station.area_m2 / kClipPi);
      ClipReach& reach = reaches[{one.clip, station.axis}];
      reach.low = std::min(reach.low, radii);
      reach.high = std::max(reach.high, radii);
      reach.stations.push_back(i);
    }
  }
  for (const auto& [of, reach] : reaches) {
    if (reach.low >= -kClosesAcross || reach.high <= kClosesAcross) continue;
    for (const size_t i : reach.stations) out[i] = 1;
  }
  return out;
}

}  // namespace viscera
