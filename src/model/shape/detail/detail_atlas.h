// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// Layout of the texels of a surface's triangles. Two triangles share a square tile, each with a border of texels for
/// filters, so that nothing of a neighbour shows. Adjacent tiles are adjacent or nearly so on the surface, so that
/// coarse mipmaps mix what belongs together.
class DetailAtlas {
 public:
  /// @param tile_px  side of a tile, >= kSmallestTile_px
  DetailAtlas(const TriangleMesh& skin, int tile_px);
  static constexpr int kSmallestTile_px = 8;
  /// Returns the side of the largest tiles with which this many triangles fit into a square of `largest_px`.
  /// @throws MeshError  none do
  static int largestTile(size_t triangles, int largest_px);
  /// Returns the smallest side of a square for this many triangles [px].
  static int leastSide(size_t triangles);

  int side() const { return side_; }  ///< side of the square of all tiles [px]
  int tile() const { return tile_; }
  size_t tiles() const { return order_.size(); }
  /// Returns the lowest texel of a tile.
  std::array<int, 2> positionOf(size_t tile) const { return positions_[tile]; }
  /// Returns the triangles of a tile; the second may be MeshPoint::kNone.
  const std::array<uint32_t, 2>& trianglesOf(size_t tile) const { return order_[tile]; }
  /// Returns which triangle of the tile contains a texel. weightsOf() returns the barycentric coordinates of its centre
  /// there: outside 0..1 on the border.
  int halfOf(int x, int y) const { return x + y + 1 <= tile_ ? 0 : 1; }
  Eigen::Vector3d weightsOf(int x, int y) const { return weightsOf(x, y, halfOf(x, y)); }
  Eigen::Vector3d weightsOf(int x, int y, int half) const;  ///< for the given triangle, wherever the texel is
  /// Returns the texture coordinates of a triangle's corners, 0..1.
  std::array<Eigen::Vector2d, 3> cornersOf(size_t tile, int half) const;
  /// Returns the surface with charts of one material, and the previous colours of its parts.
  TriangleMesh dressed(const TriangleMesh& skin, const SurfaceMaterial& material,
                       std::vector<TextureImage> images) const;

 private:
  int tile_ = 0, side_ = 0;
  std::vector<std::array<uint32_t, 2>> order_;
  std::vector<std::array<int, 2>> positions_;
};

}  // namespace viscera
