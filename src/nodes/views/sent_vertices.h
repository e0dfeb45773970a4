// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "viscera/surface/shown_mesh.h"

namespace viscera::nodes {

/// Which vertices of the shown skin are sent, and under which numbers: those of the whole skin first, which so keep
/// their numbers, then what a cut has added. Cloth has six more per vertex lying ready for cuts: none of them is sent
/// before a triangle needs it.
class SentVertices {
 public:
  SentVertices() = default;
  /// @param whole  the skin as long as nothing is cut
  explicit SentVertices(const ShownTopology& whole);

  /// From now on what these triangles need is sent. @param topology  of the same mesh
  void follow(const ShownTopology& topology);
  /// Vertices of the shown mesh, in the order in which they are sent.
  const std::vector<uint32_t>& vertices() const { return vertices_; }
  /// @param vertex  of the shown mesh, used by the topology that was followed last
  uint32_t numberOf(uint32_t vertex) const { return numbers_[vertex]; }

 private:
  void append(const std::vector<uint32_t>& triangles);

  std::vector<uint32_t> vertices_, numbers_;
  size_t whole_ = 0;  ///< how many of `vertices_` are the whole skin's
};

}  // namespace viscera::nodes
