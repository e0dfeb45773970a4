// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "gpu/buffer.h"
#include "surface/skin_boxes.h"
#include "viscera/model/model.h"
#include "viscera/solver/state.h"

namespace viscera {

/// Copy on the GPU of a state in host memory, for surface and images. It uploads only bricks that the surface meshes
/// depend on, and of these only those that have changed.
class StateMirror {
 public:
  /// Uploads the model at rest. Needs a current context. @throws GpuError
  explicit StateMirror(const Model& model);

  /// Returns the bricks that a snapshot must hold, ascending: those of the nodes to which surface meshes are bound, and
  /// of their neighbours.
  const std::vector<uint32_t>& shownBricks() const { return shown_; }
  /// Uploads the bricks that have changed. @param snapshot  of shownBricks()
  void upload(const StateSnapshot& snapshot);
  StateView view() const;
  /// Returns the displacements of shownBricks() as uploaded last.
  HostDisplacements displacements() const { return HostDisplacements::ofBricks(known_m_.data(), positions_.data()); }
  uint64_t movedBricks() const { return moved_bricks_; }  ///< bricks that had moved, over all uploads

 private:
  bool hasMoved(const StateSnapshot& snapshot, size_t index) const;
  void uploadMoved(const StateSnapshot& snapshot);
  void take(const StateSnapshot& snapshot, size_t index);
  void flush();

  uint32_t revision_ = 1, moved_revision_ = 1;
  std::vector<layout::Brick> bricks_;
  std::vector<uint32_t> shown_;
  std::vector<uint32_t> positions_;  ///< [bricks] place of a brick in known_m_
  std::vector<float> known_m_;       ///< [192 * shown] of the last snapshot
  std::vector<layout::vec4> run_;    ///< consecutive bricks on the GPU that are to be uploaded
  uint32_t run_begin_ = 0, run_end_ = 0;
  std::vector<uint32_t> stale_;  ///< [bricks], see StateView::stale_bricks
  gpu::Buffer<layout::vec4> displacement_;
  gpu::Buffer<layout::NodeBits> nodes_;
  gpu::Buffer<layout::Brick> brick_buffer_;
  gpu::Buffer<layout::BodyParams> bodies_;
  gpu::Buffer<uint32_t> stale_buffer_;
  gpu::Buffer<layout::vec4> rest_;  ///< empty where no body is a network, like the next
  gpu::Buffer<float> spring_cut_;
  uint64_t cut_revision_ = 0, moved_bricks_ = 0;
};

}  // namespace viscera
