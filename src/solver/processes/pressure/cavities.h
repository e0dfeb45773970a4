// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "solver/processes/pressure/lumen_network.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/body_config.h"

namespace viscera {

/// Border of the cavities of a body, closed: triangles face the tissue, counter-clockwise seen from it.
struct Cavities {
  std::vector<Vector3d> positions_m;               ///< at rest, tissue frame
  std::vector<std::vector<uint32_t>> rims;         ///< vertices of each open end; vertex positions_m.size() + i is the
                                                   ///< centre of rim i, and the cap is a fan around it
  std::vector<std::array<uint32_t, 3>> triangles;  ///< vertices
  std::vector<uint32_t> station_of;                ///< [triangles] station of `lumen`
  LumenNetwork lumen;
};

/// Returns the cavities of a body: the lumen of a tube, or what its surface mesh encloses.
/// @param config  of the body   @throws SceneError  it has none
Cavities cavitiesOf(const Body& body, const BodyConfig& config);

}  // namespace viscera
