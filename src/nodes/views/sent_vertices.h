// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "viscera/surface/visible_mesh.h"

namespace viscera::nodes {

/// Selects the vertices of the rendered surface mesh that are sent, and numbers them: first those of the uncut mesh,
/// which keep their numbers, then those that a cut has added. Cloth has six more per vertex in reserve for cuts; none
/// of them is sent before a triangle needs it.
class SentVertices {
 public:
  SentVertices() = default;
  /// @param whole  topology of the uncut surface
  explicit SentVertices(const VisibleTopology& whole);

  /// Adds the vertices that these triangles need. @param topology  topology of the same mesh
  void follow(const VisibleTopology& topology);
  /// Returns vertices of the rendered mesh, in the order in which they are sent.
  const std::vector<uint32_t>& vertices() const { return vertices_; }
  /// Returns the number of a vertex.
  /// @param vertex  vertex of the rendered mesh that the last topology in follow() uses
  uint32_t numberOf(uint32_t vertex) const { return numbers_[vertex]; }

 private:
  void append(const std::vector<uint32_t>& triangles);

  std::vector<uint32_t> vertices_, numbers_;
  size_t whole_ = 0;  ///< number of vertices of the uncut surface in `vertices_`
};

}  // namespace viscera::nodes
