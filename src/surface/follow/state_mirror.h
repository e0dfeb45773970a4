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

/// A state that lives on the host, brought to the GPU for surface and images: only the bricks that the skins look at,
/// and of these only the ones that differ from what is there.
class StateMirror {
 public:
  /// The model at rest. Needs a current context. @throws GpuError
  explicit StateMirror(const Model& model);

  /// Bricks that a snapshot must hold, ascending: those of the nodes to which skins are bound, and of their neighbours.
  const std::vector<uint32_t>& shownBricks() const { return shown_; }
  /// @param snapshot  of shownBricks()
  void upload(const StateSnapshot& snapshot);
  StateView view() const;
  /// Displacements of shownBricks() as uploaded last.
  HostDisplacements displacements() const { return HostDisplacements::ofBricks(known_m_.data(), places_.data()); }
  uint64_t movedBricks() const {
    return moved_bricks_;
  }  ///< how many bricks were found to have moved, over all uploads

 private:
  bool hasMoved(const StateSnapshot& snapshot, size_t index) const;
  void uploadMoved(const StateSnapshot& snapshot);
  void take(const StateSnapshot& snapshot, size_t index);
  void flush();

  uint32_t revision_ = 1, moved_revision_ = 1;
  std::vector<layout::Brick> bricks_;
  std::vector<uint32_t> shown_;
  std::vector<uint32_t> places_;   ///< [bricks] of a brick in known_m_
  std::vector<float> known_m_;     ///< [192 * shown] as in the last snapshot
  std::vector<layout::vec4> run_;  ///< bricks on their way to the GPU, one behind the other there
  uint32_t run_begin_ = 0, run_end_ = 0;
  std::vector<uint32_t> stale_;  ///< [bricks], see StateView::stale_bricks
  gpu::Buffer<layout::vec4> displacement_;
  gpu::Buffer<layout::NodeBits> nodes_;
  gpu::Buffer<layout::Brick> brick_buffer_;
  gpu::Buffer<layout::BodyParams> bodies_;
  gpu::Buffer<uint32_t> stale_buffer_;
  gpu::Buffer<layout::vec4> rest_;  ///< none where no body is a network, as the next
  gpu::Buffer<float> spring_cut_;
  uint64_t cut_revision_ = 0, moved_bricks_ = 0;
};

}  // namespace viscera
