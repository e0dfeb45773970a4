// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "viscera/layout/links.h"
#include "viscera/math/types.h"
#include "viscera/model/shape/surface_detail.h"

namespace viscera {

/// One explicit connection: F = k (L - l0) n (GW eq 1; without VR05's factor 1/2).
struct NetworkSpring {
  uint32_t a = 0, b = 0;  ///< slots of its ends, a < b; two springs may join the same two nodes
  double stiffness_n_per_m = 0;
  double rest_length_m = 0;  ///< may be 0, and may differ from the distance of the ends at rest
  uint32_t lattice_spring = layout::kNoLatticeSpring;  ///< of an explicit lattice: its index from a (neighbors.h)
  bool against_bending = false;                        ///< spans two others, to keep them straight
};

/// Explicit connections of one body (VR05 2.5.1, GW 4): any graph over its slots.
struct SpringNetwork {
  std::vector<Vector3d> positions_m;               ///< [slots] at rest, tissue frame; zero where no node is
  std::vector<double> masses_kg;                   ///< [slots] > 0 where a node is, else 0
  std::vector<NetworkSpring> springs;              ///< ordered by (a, b)
  std::vector<std::array<uint32_t, 3>> triangles;  ///< its surface: slots, counter-clockwise seen from outside
  std::vector<uint32_t> charts;                    ///< of the triangles, as in TriangleMesh
  std::shared_ptr<const SurfaceDetail> detail;     ///< the same
  bool of_lattice = false;                         ///< the nodes are those of the body's lattice, with bricks in space

  /// Mean rest length of the springs but those against bending [m]; 0 without any.
  double meanLength() const;
};

/// Links of every slot in the order of its springs: what the gather runs over.
struct NetworkLinks {
  std::vector<uint32_t> starts;          ///< [slots + 1]
  std::vector<layout::Link> links;       ///< [2 * springs] node by node
  std::vector<layout::SpringEnds> ends;  ///< [springs]
};
NetworkLinks linksOf(const SpringNetwork& network);

}  // namespace viscera
