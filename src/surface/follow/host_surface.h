// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "surface/shown_triangles.h"
#include "surface/skins/joined_skins.h"
#include "surface/wounds/wounds.h"
#include "viscera/model/model.h"
#include "viscera/solver/state.h"

namespace viscera {

/// What Surface does, without OpenGL: the skins of all bodies follow a state on the host, triangles are split by
/// cuts. The kernels are the text of the same shaders compiled as C++, so the two differ by rounding only.
class HostSurface {
 public:
  explicit HostSurface(const Model& model, MovedNormals normals = MovedNormals::kCarried);

  /// Bricks that a snapshot must hold, as those of StateMirror.
  const std::vector<uint32_t>& shownBricks() const { return shown_bricks_; }
  /// The skin in a state. Looks at the springs only if cut_revision is another one than in the last call.
  /// @param snapshot  of shownBricks()   @param out  gets positions, normals and topology
  void show(const StateSnapshot& snapshot, ShownMesh& out);
  /// Every triangle whole again.
  void reset();

  size_t vertices() const { return wounds_ ? wounds_->bindings().size() : skins_.bindings.size(); }
  const ShownTriangles& skin() const { return shown_; }
  const ShownWounds* wounds() const { return wounds_ ? wounds_->shown().get() : nullptr; }  ///< null where none can be
  uint64_t mappings() const { return mappings_; }                                           ///< times show() was called

 private:
  struct Buffers;
  void split(const StateSnapshot& snapshot);

  JoinedSkins skins_;
  std::unique_ptr<Wounds> wounds_;  ///< null where no body with an inside can be cut
  ShownTriangles shown_;
  std::vector<uint32_t> shown_bricks_, brick_places_, alive_;
  std::vector<layout::Brick> bricks_;
  std::vector<layout::BodyParams> bodies_;
  std::vector<layout::vec4> rest_m_, node_normals_;
  uint64_t cut_revision_ = 0, mappings_ = 0;
};

}  // namespace viscera
