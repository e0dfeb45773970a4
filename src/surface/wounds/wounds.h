// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "surface/skins/joined_skins.h"
#include "surface/wounds/body_wound.h"
#include "surface/wounds/wound_depths.h"
#include "viscera/model/model.h"
#include "viscera/solver/state.h"

namespace viscera {

/// Surface meshes of bodies on lattices after cuts. It does not change while anyone uses it, so users share it.
struct VisibleWounds {
  /// Triangles of one body, [3 * n] vertex indices as in JoinedSkins; vertices that cuts have added follow all others.
  struct OfBody {
    bool wounded = false;  ///< else its surface mesh is whole, and the lists are empty
    std::vector<uint32_t> skin, walls;
    std::vector<uint32_t> skin_sources;  ///< [n] triangle of the body's uncut mesh that each of `skin` is a piece of
  };
  uint64_t revision = 0;
  size_t vertices = 0;         ///< of the uncut meshes and added ones
  size_t holes = 0;            ///< wounds left open because they reach a border of the mesh
  size_t slivers = 0;          ///< edges with a piece between two wounds that is not shown
  std::vector<OfBody> bodies;  ///< in the model's order
};

/// The wounds of a model's bodies on lattices that can be cut (docs/surface.md). Vertices and slots are numbered
/// globally as in JoinedSkins.
class Wounds {
 public:
  /// @param model  must outlive this   @param skins  of this model
  Wounds(const Model& model, const JoinedSkins& skins);
  /// Returns whether any body can have one.
  static bool possible(const Model& model);

  /// Updates the wounds. @returns whether anything is newly cut; if not, nothing has changed
  bool update(const CutSprings& cuts);
  void reset();

  const std::shared_ptr<const VisibleWounds>& shown() const { return shown_; }
  const std::vector<layout::SkinBinding>& bindings() const { return bindings_; }  ///< [shown()->vertices]
  const std::vector<uint32_t>& colors() const { return colors_; }                 ///< [shown()->vertices] RGBA8
  /// Returns rest positions of added vertices [added], as JoinedSkins::rests; w of walls: depth below the surface [m],
  /// of lips: kOnLip
  const std::vector<layout::vec4>& addedRests() const { return added_rests_; }

 private:
  struct WoundOfBody {
    std::unique_ptr<BodyWound> wound;  ///< null where the body is no lattice or cannot be cut
    uint32_t slot = 0, vertex = 0;     ///< first ones of the body
    std::vector<uint32_t> inside;      ///< [labels] insideColors(), RGBA8
    Vector3d origin_m;
    double spacing_m = 1;
    const Lattice* lattice = nullptr;
    std::unique_ptr<WoundDepths> depths;  ///< where there is a wound
    std::vector<double> wall_depths_m;    ///< [wall vertices] of wound
    std::vector<uint16_t> wall_labels;    ///< [wall vertices] of wound: the part there
    uint32_t number = 0;                  ///< of the body
  };
  void appendTriangles(const WoundOfBody& position, const BodyWound& wound, VisibleWounds::OfBody& out) const;
  void append(WoundOfBody& position, VisibleWounds::OfBody& out);
  void addRest(const WoundOfBody& position, const WoundVertex& vertex, double w);
  void clear();
  std::shared_ptr<VisibleWounds> next();
  bool isKnown(const layout::NodeBits* nodes);

  size_t slots_ = 0;
  std::vector<WoundOfBody> positions_;     ///< [bodies]
  std::vector<layout::NodeBits> springs_;  ///< [slots] of the last update; empty before the first one
  std::vector<layout::SkinBinding> whole_bindings_, bindings_;
  std::vector<uint32_t> whole_colors_, colors_;
  std::vector<layout::vec4> added_rests_;
  std::vector<std::shared_ptr<VisibleWounds>> kept_;  ///< results that were shown, for reuse when nothing shows them
  std::shared_ptr<const VisibleWounds> shown_;
  uint64_t revisions_ = 1;
};

}  // namespace viscera
