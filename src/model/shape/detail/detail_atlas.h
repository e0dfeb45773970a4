// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// Where the texels of a skin's triangles are: two triangles to a square tile, each with a border of texels that
/// filters reach, so that nothing of a neighbour shows. Tiles next to each other are next to each other on the skin, or
/// nearly: so that coarse mipmaps, which mix them, mix what belongs together.
class DetailAtlas {
 public:
  /// @param tile_px  side of a tile, >= kSmallestTile_px
  DetailAtlas(const TriangleMesh& skin, int tile_px);
  static constexpr int kSmallestTile_px = 8;
  /// Side of the largest tiles with which so many triangles fit into a square of `largest_px`.
  /// @throws MeshError  none do
  static int largestTile(size_t triangles, int largest_px);
  /// Side of the square that so many triangles need at least [px].
  static int leastSide(size_t triangles);

  int side() const { return side_; }  ///< of all tiles [px]
  int tile() const { return tile_; }
  size_t tiles() const { return order_.size(); }
  /// Lowest texel of a tile.
  std::array<int, 2> placeOf(size_t tile) const { return places_[tile]; }
  /// The triangles of a tile; the second may be MeshPlace::kNone.
  const std::array<uint32_t, 2>& trianglesOf(size_t tile) const { return order_[tile]; }
  /// Which of its triangles has a texel of a tile, and the barycentric coordinates of its centre there: outside of 0..1
  /// on the border.
  int halfOf(int x, int y) const { return x + y + 1 <= tile_ ? 0 : 1; }
  Eigen::Vector3d weightsOf(int x, int y) const { return weightsOf(x, y, halfOf(x, y)); }
  Eigen::Vector3d weightsOf(int x, int y, int half) const;  ///< of that triangle, wherever the texel is
  /// Texture coordinates of a triangle's corners, 0..1.
  std::array<Eigen::Vector2d, 3> cornersOf(size_t tile, int half) const;
  /// The skin with charts of one material, and the colours of its parts as before.
  TriangleMesh dressed(const TriangleMesh& skin, const SurfaceMaterial& material,
                       std::vector<TextureImage> images) const;

 private:
  int tile_ = 0, side_ = 0;
  std::vector<std::array<uint32_t, 2>> order_;
  std::vector<std::array<int, 2>> places_;
};

}  // namespace viscera
