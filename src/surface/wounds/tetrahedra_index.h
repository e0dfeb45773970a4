// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "viscera/model/body/skin.h"
#include "viscera/model/body/spring_network.h"

namespace viscera {

/// Items of each of a number of keys, one run after the other.
struct ItemRuns {
  std::vector<uint32_t> starts;  ///< [keys + 1]
  std::vector<uint32_t> items;
};

/// What of a body of tetrahedra lies beside what, as wounds ask for it.
struct TetrahedraIndex {
  static constexpr uint32_t kNone = UINT32_MAX;

  struct Tetrahedron {
    std::array<uint32_t, 4> slots;
    std::array<uint32_t, 6> springs;  ///< by kTetrahedronEdges
    std::array<uint32_t, 4> faces;    ///< by kTetrahedronFaces
  };
  struct Face {
    std::array<uint32_t, 3> slots;  ///< ascending
    uint32_t triangle = kNone;      ///< of the skin
  };
  std::vector<Tetrahedron> tetrahedra;
  std::vector<Face> faces;
  ItemRuns of_spring, of_slot;                            ///< indices of tetrahedra
  std::vector<std::array<uint32_t, 3>> triangle_springs;  ///< [triangles of the skin] of the edges 01, 12, 20
  std::vector<uint32_t> triangle_faces;                   ///< [triangles of the skin]
  std::vector<uint32_t> vertex_of_slot;                   ///< [slots] of the skin, or kNone
  std::vector<float> depth_m;                             ///< [slots] below the skin at rest

  /// @param skin  bindNetworkSkin() of the network, whose nodes are renumbered
  TetrahedraIndex(const SpringNetwork& network, const Skin& skin);

 private:
  void findFaces(const Skin& skin);
  void findDepths(const SpringNetwork& network, const Skin& skin);
};

}  // namespace viscera
