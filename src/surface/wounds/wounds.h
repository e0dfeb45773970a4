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

/// What cuts have made of the skins of bodies on lattices: not changed while anybody shows it, so that who does
/// shares it.
struct ShownWounds {
  /// Triangles of one body, [3 * n] vertex indices as in JoinedSkins, and beyond its vertices those added by cuts.
  struct OfBody {
    bool wounded = false;  ///< else its skin is whole, and the lists are empty
    std::vector<uint32_t> skin, walls;
    std::vector<uint32_t> skin_sources;  ///< [n] which triangle of the body's whole skin each of `skin` is a piece of
  };
  uint64_t revision = 0;
  size_t vertices = 0;         ///< of the whole skins and added ones
  size_t holes = 0;            ///< wounds left open, as they run out of a skin at a border of it
  size_t slivers = 0;          ///< edges of skins of which a piece between two wounds is not shown
  std::vector<OfBody> bodies;  ///< in the model's order
};

/// The wounds of a model's bodies on lattices that can be cut (docs/wounds.md). Vertices and slots are numbered
/// through as in JoinedSkins.
class Wounds {
 public:
  /// @param model  must outlive this   @param skins  of this model
  Wounds(const Model& model, const JoinedSkins& skins);
  /// Can any body get one?
  static bool possible(const Model& model);

  /// @returns whether anything is cut now that was not: else nothing has changed
  bool update(const CutSprings& cuts);
  void reset();

  const std::shared_ptr<const ShownWounds>& shown() const { return shown_; }
  const std::vector<layout::SkinBinding>& bindings() const { return bindings_; }  ///< [shown()->vertices]
  const std::vector<uint32_t>& colors() const { return colors_; }                 ///< [shown()->vertices] RGBA8
  /// [added] of the vertices beyond the whole skins', as JoinedSkins::rests; w: depth below the skin [m]
  const std::vector<layout::vec4>& addedRests() const { return added_rests_; }

 private:
  struct Place {
    std::unique_ptr<BodyWound> wound;  ///< none where the body is no lattice or cannot be cut
    uint32_t slot = 0, vertex = 0;     ///< where the body's begin
    Vector3d color, origin_m;
    double spacing_m = 1;
    std::unique_ptr<WoundDepths> depths;  ///< where there is a wound
    std::vector<double> wall_depths_m;    ///< [wall vertices] of it
    uint32_t number = 0;                  ///< of the body
  };
  void appendTriangles(const Place& place, const BodyWound& wound, ShownWounds::OfBody& out) const;
  void append(Place& place, ShownWounds::OfBody& out);
  void addRest(const Place& place, const WoundVertex& vertex, double depth_m);
  void forget();
  std::shared_ptr<ShownWounds> next();
  bool isKnown(const layout::NodeBits* nodes);

  size_t slots_ = 0;
  std::vector<Place> places_;              ///< [bodies]
  std::vector<layout::NodeBits> springs_;  ///< [slots] of the last update; empty before the first one
  std::vector<layout::SkinBinding> whole_bindings_, bindings_;
  std::vector<uint32_t> whole_colors_, colors_;
  std::vector<layout::vec4> added_rests_;
  std::vector<std::shared_ptr<ShownWounds>> kept_;  ///< what was shown: used again when not shown any more
  std::shared_ptr<const ShownWounds> shown_;
  uint64_t revisions_ = 1;
};

}  // namespace viscera
