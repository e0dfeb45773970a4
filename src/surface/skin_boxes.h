// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "viscera/layout/skin.h"
#include "viscera/model/model.h"
#include "viscera/solver/state.h"

namespace viscera {

using SkinBox = Eigen::AlignedBox3f;  ///< [m, tissue frame]

/// Displacements of nodes on the host [m].
struct HostDisplacements {
  const float* first_m = nullptr;
  const uint32_t* brick_positions = nullptr;  ///< [bricks] place of a brick in there; null: bricks are in order
  size_t node_stride = 1, axis_stride = layout::kBrickSlots, brick_stride = kBrickFloats;

  /// Returns a view of StateSnapshot::displacement_m.
  static HostDisplacements ofBricks(const float* bricks_m, const uint32_t* brick_positions) {
    return {bricks_m, brick_positions};
  }
  /// Returns a view of one vector per slot. @param slots_m  [slots]
  static HostDisplacements ofSlots(const std::vector<layout::vec4>& slots_m) {
    return {&slots_m.data()->x, nullptr, 4, 1, size_t{4} * layout::kBrickSlots};
  }
  Vector3f operator()(uint32_t slot) const {
    const uint32_t brick = slot / layout::kBrickSlots;
    const float* const at = first_m + brick_stride * (brick_positions ? brick_positions[brick] : brick) +
                            node_stride * (slot % layout::kBrickSlots);
    return {at[0], at[axis_stride], at[2 * axis_stride]};
  }
};

/// Bounding boxes of the surface meshes of bodies. Bodies that no camera sees are neither mapped nor drawn
/// (docs/surface.md).
class SkinBoxes {
 public:
  SkinBoxes() = default;
  /// @param bindings  of the surface meshes of all bodies (JoinedSkins)
  SkinBoxes(const Model& model, const std::vector<layout::SkinBinding>& bindings);

  /// Enlarges the boxes for vertices with these bindings.
  void add(const std::vector<layout::SkinBinding>& bindings);
  /// Returns a box per body [bodies] that contains all its triangles in a state; empty for a body without triangles. A
  /// displacement that is not finite makes a box that contains everything.
  std::vector<SkinBox> place(const HostDisplacements& displacements) const;
  std::vector<SkinBox> atRest() const;

 private:
  struct Node {
    uint32_t slot;
    Vector3f rest_m;
  };
  struct OfBody {
    uint32_t first_slot;
    double spacing_m;
    std::vector<Node> nodes;  ///< that vertices may be bound to
    float offset_m = 0;       ///< how far a triangle may reach beyond the box of its nodes, on every side
    float beyond = 0;         ///< the same as a share of that box
  };
  static SkinBox around(const OfBody& body, const HostDisplacements& displacements);

  std::vector<OfBody> bodies_;
  size_t slots_ = 0;  ///< of all bodies
};

}  // namespace viscera
