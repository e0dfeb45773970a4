// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "viscera/api.h"
#include "viscera/layout/links.h"
#include "viscera/math/types.h"
#include "viscera/model/shape/surface_detail.h"

namespace VISCERA_PUBLIC viscera {

/// Explicit connection: F = k (L - l0) n (GW eq 1; without the factor 1/2 of VR05).
struct NetworkSpring {
  uint32_t a = 0, b = 0;  ///< slots of the two ends, a < b; two springs may join the same two nodes
  double stiffness_n_per_m = 0;
  double rest_length_m = 0;  ///< rest length [m]; may be 0, and may differ from the distance of the ends at rest
  /// Index of the spring seen from a (neighbors.h) in an explicit lattice.
  uint32_t lattice_spring = layout::kNoLatticeSpring;
  bool against_bending = false;  ///< spans two other springs and resists bending between them
};

/// Explicit connections of one body (VR05 2.5.1, GW 4): any graph over its slots.
struct SpringNetwork {
  std::vector<Vector3d> positions_m;   ///< [slots] rest positions [m], tissue frame; zero where there is no node
  std::vector<double> masses_kg;       ///< [slots] mass [kg]: > 0 where there is a node, else 0
  std::vector<NetworkSpring> springs;  ///< springs, ordered by (a, b)
  /// Triangles of its surface: slots, counter-clockwise seen from outside.
  std::vector<std::array<uint32_t, 3>> triangles;
  std::vector<uint32_t> charts;                 ///< charts of the triangles, as in TriangleMesh
  std::shared_ptr<const SurfaceDetail> detail;  ///< detail of the surface, as in TriangleMesh
  bool of_lattice = false;  ///< the nodes are those of the body's lattice, and bricks have positions in space

  /// Returns the mean rest length [m] of the springs, without those against bending; 0 without any.
  double meanLength() const;
};

/// Links of every slot, in the order of its springs: the kernels gather over them.
struct NetworkLinks {
  std::vector<uint32_t> starts;          ///< [slots + 1] index of the first link of each slot
  std::vector<layout::Link> links;       ///< [2 * springs] links, node by node
  std::vector<layout::SpringEnds> ends;  ///< [springs] ends of each spring
};
NetworkLinks linksOf(const SpringNetwork& network);

}  // namespace viscera
