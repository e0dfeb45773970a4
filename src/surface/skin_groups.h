// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "surface/joined_skins.h"
#include "surface/wounds.h"
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

/// Faces of the skins in groups, so that what cannot be seen is neither mapped nor drawn (docs/hidden.md). Vertices are
/// grouped by the brick of nodes that they are bound to, a triangle belongs to the group of its first corner. Vertices
/// and triangles are numbered as in JoinedSkins.
class SkinGroups {
 public:
  /// What must be mapped for some groups to be drawn.
  struct Needs {
    std::vector<uint8_t> vertices;  ///< [groups + 1] of their vertices; the last: of those that wounds have added
    std::vector<uint8_t> nodes;     ///< [groups] of the nodes in their bricks
    bool networks = false;          ///< of any network
  };

  SkinGroups() = default;
  SkinGroups(const Model& model, const JoinedSkins& skins);

  size_t count() const { return body_of_.size(); }
  uint32_t groupOfVertex(uint32_t vertex) const { return vertex_groups_[vertex]; }
  uint32_t groupOfSlot(uint32_t slot) const { return brick_groups_[slot / layout::kBrickSlots]; }
  size_t bodyOf(size_t group) const { return body_of_[group]; }

  /// Bodies with wounds are seen whole or not at all. @param bindings  [shown.vertices]
  void wound(const ShownWounds& shown, const std::vector<layout::SkinBinding>& bindings);
  /// Where every group is: all that its triangles can cover in a state lies in its box, which is empty for a group
  /// without triangles. What is not a number makes a box that holds everything.
  void place(const HostDisplacements& displacements, std::vector<SkinBox>& boxes) const;
  bool hasTriangles(size_t group) const { return node_starts_[group + 1] > node_starts_[group]; }
  bool isSplit(size_t body) const { return split_[body] != 0; }  ///< a network that blades can part: shown whole or not
  bool isWounded(size_t body) const { return wounded_[body] != 0; }
  /// @param shown  [groups] 1: is drawn   @returns whether all triangles are
  bool areAll(const std::vector<uint8_t>& shown) const;
  std::vector<uint8_t> bodiesOf(const std::vector<uint8_t>& shown) const;  ///< [bodies] is any group drawn?
  /// Of the bodies. @param boxes  [groups] as place() gives them
  std::vector<SkinBox> bodyBoxes(const std::vector<SkinBox>& boxes) const;
  /// @param shown  [groups] 1: is drawn
  void need(const std::vector<uint8_t>& shown, Needs& needs) const;

 private:
  /// Lists of numbers, one per group: of `items`, those from starts[group] to starts[group + 1].
  struct Lists {
    std::vector<uint32_t> starts, items;
    static Lists of(std::vector<std::vector<uint32_t>> lists);
  };
  struct Node {
    uint32_t slot;
    Vector3f rest_m;
  };
  /// How far beyond the box of its nodes a triangle may reach.
  struct Reach {
    float offset_m = 0;  ///< to every side
    float beyond = 0;    ///< share of the nodes' box to every side
    void add(const Reach& other);
  };
  struct Whole {  ///< what wounds have added to a body
    std::vector<Node> nodes;
    Reach reach;
  };
  struct Draft;
  void number(const Model& model, const JoinedSkins& skins);
  void addTriangles(const JoinedSkins& skins, Draft& draft);
  size_t bodyOfSlot(uint32_t slot) const;
  bool isWhole(size_t body) const { return wounded_[body] || split_[body]; }  ///< all of its groups are as one
  Reach reachOf(size_t body, const layout::SkinBinding& binding) const;
  template <class Visit>
  void forEachSlot(const layout::SkinBinding& binding, Visit visit) const;
  Vector3f restOf(uint32_t slot) const;
  template <class Iterator>
  static SkinBox around(Iterator first, Iterator last, const Reach& reach, const HostDisplacements& displacements);

  const Model* model_ = nullptr;
  std::vector<uint32_t> brick_groups_, vertex_groups_, body_of_;
  std::vector<uint32_t> slot_starts_;  ///< [bodies + 1]
  std::vector<Node> nodes_;            ///< group by group
  std::vector<uint32_t> node_starts_;  ///< [groups + 1]
  std::vector<Reach> reaches_;         ///< [groups]
  Lists vertex_needs_, node_needs_;  ///< groups of the vertices that triangles have; of the nodes that vertices follow
  std::vector<uint8_t> split_, wounded_;  ///< [bodies] networks that can be split; bodies with wounds
  std::vector<Whole> wholes_;             ///< [bodies] of those with wounds
};

}  // namespace viscera
