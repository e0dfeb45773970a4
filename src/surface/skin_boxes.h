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
  const uint32_t* brick_places = nullptr;  ///< [bricks] of a brick in there; null: they follow each other
  size_t node_stride = 1, axis_stride = layout::kBrickSlots, brick_stride = kBrickFloats;

  /// As StateSnapshot::displacement_m has them.
  static HostDisplacements ofBricks(const float* bricks_m, const uint32_t* brick_places) {
    return {bricks_m, brick_places};
  }
  /// @param slots_m  [slots]
  static HostDisplacements ofSlots(const std::vector<layout::vec4>& slots_m) {
    return {&slots_m.data()->x, nullptr, 4, 1, size_t{4} * layout::kBrickSlots};
  }
  Vector3f operator()(uint32_t slot) const {
    const uint32_t brick = slot / layout::kBrickSlots;
    const float* const at = first_m + brick_stride * (brick_places ? brick_places[brick] : brick) +
                            node_stride * (slot % layout::kBrickSlots);
    return {at[0], at[axis_stride], at[2 * axis_stride]};
  }
};

/// Where the skins of bodies are, so that those that no camera sees are neither mapped nor drawn (docs/hidden.md).
class SkinBoxes {
 public:
  SkinBoxes() = default;
  /// @param bindings  of the skins of all bodies (JoinedSkins)
  SkinBoxes(const Model& model, const std::vector<layout::SkinBinding>& bindings);

  /// Boxes hold vertices that are bound so, too, from now on.
  void add(const std::vector<layout::SkinBinding>& bindings);
  /// @returns [bodies] all that the triangles of a body can cover in a state lies in its box, which is empty for a body
  /// without triangles. What is not a number makes a box that holds everything.
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
    float offset_m = 0;       ///< how far a triangle may reach beyond the box of its nodes, to every side,
    float beyond = 0;         ///< and the same as a share of that box
  };
  static SkinBox around(const OfBody& body, const HostDisplacements& displacements);

  std::vector<OfBody> bodies_;
  size_t slots_ = 0;  ///< of all
};

}  // namespace viscera
