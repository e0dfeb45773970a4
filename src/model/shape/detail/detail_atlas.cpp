// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/detail/detail_atlas.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "math/number_text.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

constexpr int kMortonBits = 10;
constexpr int kLeg = 4;     // texels by which a triangle's legs are shorter than a tile's side
constexpr int kBorder = 1;  // texels between a tile's side and a triangle's leg

uint32_t spread(uint32_t value) {
  uint32_t out = 0;
  for (int bit = 0; bit < kMortonBits; ++bit) out |= (value >> bit & 1U) << (3 * bit);
  return out;
}

/// Returns the triangles in the order of a space-filling curve.
std::vector<uint32_t> alongCurve(const TriangleMesh& skin) {
  Eigen::AlignedBox3f box;
  for (const Vector3f& p : skin.positions_m) box.extend(p);
  const float scale = ((1 << kMortonBits) - 1) / std::max(box.sizes().maxCoeff(), 1e-20F);
  std::vector<uint32_t> keys, order(skin.triangles.size());
  for (const auto& t : skin.triangles) {
    const Vector3f middle = (skin.positions_m[t[0]] + skin.positions_m[t[1]] + skin.positions_m[t[2]]) / 3;
    const Vector3i at = (scale * (middle - box.min())).cast<int>();
    keys.push_back(spread(static_cast<uint32_t>(at.x())) | spread(static_cast<uint32_t>(at.y())) << 1U |
                   spread(static_cast<uint32_t>(at.z())) << 2U);
  }
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return keys[a] < keys[b]; });
  return order;
}

/// Returns column and row of an index along a curve that fills a square.
std::array<int, 2> inSquare(uint32_t position) {
  std::array<int, 2> out{};
  for (int bit = 0; bit < 16; ++bit) {
    out[0] |= static_cast<int>(position >> (2 * bit) & 1U) << bit;
    out[1] |= static_cast<int>(position >> (2 * bit + 1) & 1U) << bit;
  }
  return out;
}

}  // namespace

DetailAtlas::DetailAtlas(const TriangleMesh& skin, int tile_px) : tile_(tile_px) {
  const std::vector<uint32_t> order = alongCurve(skin);
  for (size_t i = 0; i < order.size(); i += 2)
    order_.push_back({order[i], i + 1 < order.size() ? order[i + 1] : UINT32_MAX});
  const int columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(order_.size()))));
  side_ = columns * tile_px;
  for (uint32_t position = 0; positions_.size() < order_.size();
       ++position) {  // the part of the curve within the columns
    const std::array<int, 2> at = inSquare(position);
    if (at[0] < columns && at[1] < columns) positions_.push_back({at[0] * tile_px, at[1] * tile_px});
  }
}

Eigen::Vector3d DetailAtlas::weightsOf(int x, int y, int half) const {
  double u = (x + 0.5 - kBorder) / (tile_ - kLeg), v = (y + 0.5 - kBorder) / (tile_ - kLeg);
  if (half == 1) {
    u = (tile_ - kBorder - (x + 0.5)) / (tile_ - kLeg);
    v = (tile_ - kBorder - (y + 0.5)) / (tile_ - kLeg);
  }
  return {1 - u - v, u, v};
}

std::array<Eigen::Vector2d, 3> DetailAtlas::cornersOf(size_t tile, int half) const {
  const Eigen::Vector2d low(positions_[tile][0], positions_[tile][1]);
  const double near = half == 0 ? kBorder : tile_ - kBorder, step = half == 0 ? tile_ - kLeg : kLeg - tile_;
  const Eigen::Vector2d corner = low + Eigen::Vector2d(near, near);
  return {corner / side_, (corner + Eigen::Vector2d(step, 0)) / side_, (corner + Eigen::Vector2d(0, step)) / side_};
}

namespace {

/// Returns the number of tiles along a side of the square.
int tilesAcross(size_t triangles) {
  return std::max(1, static_cast<int>(std::ceil(std::sqrt(std::ceil(static_cast<double>(triangles) / 2)))));
}

}  // namespace

int DetailAtlas::leastSide(size_t triangles) {
  return kSmallestTile_px * tilesAcross(triangles);
}

int DetailAtlas::largestTile(size_t triangles, int largest_px) {
  const int fits = largest_px / tilesAcross(triangles);
  if (fits >= kSmallestTile_px) return fits;
  TextOut out;
  out << "a skin of " << triangles << " faces does not fit into a detail texture of " << largest_px << " x "
      << largest_px << " texels; reduce the faces with bodies[].skin_faces or raise bodies[].detail_px";
  throw MeshError(out.str());
}

TriangleMesh DetailAtlas::dressed(const TriangleMesh& skin, const SurfaceMaterial& material,
                                  std::vector<TextureImage> images) const {
  TriangleMesh out = skin;
  auto detail = std::make_shared<SurfaceDetail>();
  if (skin.detail) {
    detail->materials = skin.detail->materials;
    detail->part_materials = skin.detail->part_materials;
  }
  for (SurfaceMaterial& of : detail->materials) of.color_texture = of.normal_texture = of.roughness_texture = {};
  const auto index = static_cast<uint32_t>(detail->materials.size());
  detail->images = std::move(images);
  detail->materials.push_back(material);
  detail->charts.resize(out.triangles.size());
  out.charts.assign(out.triangles.size(), kNoChart);
  for (size_t tile = 0; tile < tiles(); ++tile) {
    for (int half = 0; half < 2; ++half) {
      const uint32_t t = order_[tile][static_cast<size_t>(half)];
      if (t == UINT32_MAX) continue;
      std::array<Eigen::Vector3d, 3> corners;
      for (size_t i = 0; i < 3; ++i) corners[i] = out.positions_m[out.triangles[t][i]].cast<double>();
      detail->charts[t] = textureChart(corners, cornersOf(tile, half), index);
      out.charts[t] = t;
    }
  }
  out.detail = std::move(detail);
  return out;
}

}  // namespace viscera
