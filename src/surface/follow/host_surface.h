// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "surface/skins/joined_skins.h"
#include "surface/visible_triangles.h"
#include "surface/wounds/wounds.h"
#include "viscera/model/model.h"
#include "viscera/solver/state.h"

namespace viscera {

/// Surface without OpenGL: the surface meshes of all bodies follow a state on the host, and cuts split triangles. It
/// compiles the text of the same shaders as C++, so the two differ by rounding only.
class HostSurface {
 public:
  explicit HostSurface(const Model& model, MovedNormals normals = MovedNormals::kCarried);

  /// Returns the bricks that a snapshot must hold, like StateMirror::shownBricks().
  const std::vector<uint32_t>& shownBricks() const { return shown_bricks_; }
  /// Computes the surface mesh in a state. Reads the springs only if cut_revision differs from the last call.
  /// @param snapshot  of shownBricks()   @param out  gets positions, normals and topology
  void show(const StateSnapshot& snapshot, VisibleMesh& out);
  /// Makes every triangle whole again.
  void reset();

  size_t vertices() const { return wounds_ ? wounds_->bindings().size() : skins_.bindings.size(); }
  const VisibleTriangles& skin() const { return shown_; }
  const VisibleWounds* wounds() const { return wounds_ ? wounds_->shown().get() : nullptr; }  ///< null if impossible
  uint64_t mappings() const { return mappings_; }                                             ///< calls of show()

 private:
  struct Buffers;
  void split(const StateSnapshot& snapshot);

  JoinedSkins skins_;
  std::unique_ptr<Wounds> wounds_;  ///< null where no body with an inside can be cut
  VisibleTriangles shown_;
  std::vector<uint32_t> shown_bricks_, brick_positions_, alive_;
  std::vector<layout::Brick> bricks_;
  std::vector<layout::BodyParams> bodies_;
  std::vector<layout::vec4> rest_m_, node_normals_;
  uint64_t cut_revision_ = 0, mappings_ = 0;
};

}  // namespace viscera
