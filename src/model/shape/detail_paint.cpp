// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/detail_paint.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <thread>

#include "math/srgb.h"
#include "model/shape/detail_atlas.h"

namespace viscera {

namespace {

constexpr int kLargestTile_px = 32;
constexpr float kStep_m = 1e-4F;  // for slopes: less than a texel

struct Canvas {
  const TriangleMesh& skin;
  const SurfacePaint& paint;
  const DetailAtlas& atlas;
  std::vector<Vector3f> normals;
  TextureImage color, relief;
};

void paintTexel(Canvas& canvas, size_t tile, int x, int y) {
  const int half = canvas.atlas.halfOf(x, y);
  const uint32_t triangle = canvas.atlas.trianglesOf(tile)[static_cast<size_t>(half)];
  if (triangle == UINT32_MAX) return;
  const auto& c = canvas.skin.triangles[triangle];
  const std::vector<Vector3f>& at = canvas.skin.positions_m;
  const Vector3f w = canvas.atlas.weightsOf(x, y).cast<float>();
  const Vector3f place = w[0] * at[c[0]] + w[1] * at[c[1]] + w[2] * at[c[2]];
  const Vector3f n =
      (w[0] * canvas.normals[c[0]] + w[1] * canvas.normals[c[1]] + w[2] * canvas.normals[c[2]]).stableNormalized();
  const PaintedSpot spot = canvas.paint(place, n);
  const auto [column, row] = canvas.atlas.placeOf(tile);
  const size_t texel = 4 * (static_cast<size_t>(row + y) * canvas.atlas.side() + static_cast<size_t>(column + x));
  for (size_t i = 0; i < 3; ++i) canvas.color.rgba[texel + i] = srgbByte(spot.color[static_cast<int>(i)]);
  canvas.color.rgba[texel + 3] = static_cast<uint8_t>(std::lround(255 * std::clamp(spot.cover, 0.F, 1.F)));
  // The frame of shaders/draw/detail.glsl: T is the way along which u grows.
  const Vector3f along_u = (half == 0 ? 1.F : -1.F) * (at[c[1]] - at[c[0]]);
  const Vector3f t = (along_u - n * n.dot(along_u)).stableNormalized(), b = n.cross(t);
  const float slope_t = (canvas.paint(place + kStep_m * t, n).height_m - spot.height_m) / kStep_m;
  const float slope_b = (canvas.paint(place + kStep_m * b, n).height_m - spot.height_m) / kStep_m;
  const Vector3f bent = Vector3f(-slope_t, -slope_b, 1).normalized();
  for (int i = 0; i < 3; ++i)
    canvas.relief.rgba[texel + static_cast<size_t>(i)] =
        static_cast<uint8_t>(std::lround(std::clamp(128 + 127.5F * bent[i], 0.F, 255.F)));
}

void paintTiles(Canvas& canvas, const Progress& progress) {
  const size_t tiles = canvas.atlas.tiles();
  std::atomic<size_t> next{0};
  const auto work = [&](bool tells) {
    constexpr size_t kTilesAtOnce = 64;
    for (size_t first = next.fetch_add(kTilesAtOnce); first < tiles; first = next.fetch_add(kTilesAtOnce)) {
      for (size_t tile = first; tile < std::min(first + kTilesAtOnce, tiles); ++tile) {
        for (int y = 0; y < canvas.atlas.tile(); ++y) {
          for (int x = 0; x < canvas.atlas.tile(); ++x) paintTexel(canvas, tile, x, y);
        }
      }
      if (tells && progress) progress("paint detail", static_cast<double>(first) / static_cast<double>(tiles));
    }
  };
  std::vector<std::thread> helpers;
  for (unsigned i = 1; i < std::max(1U, std::thread::hardware_concurrency()); ++i) helpers.emplace_back(work, false);
  work(true);
  for (std::thread& helper : helpers) helper.join();
}

}  // namespace

TriangleMesh paintDetail(const TriangleMesh& skin, const SurfacePaint& paint, int largest_px,
                         const Progress& progress) {
  const DetailAtlas atlas(skin, std::min(DetailAtlas::largestTile(skin.triangles.size(), largest_px), kLargestTile_px));
  Canvas canvas{skin, paint, atlas, vertexNormals(skin), {atlas.side(), atlas.side(), {}}, {}};
  canvas.color.rgba.resize(size_t{4} * atlas.side() * atlas.side());
  canvas.relief = canvas.color;
  for (size_t i = 0; i < canvas.relief.rgba.size(); ++i) canvas.relief.rgba[i] = i % 4 < 2 ? 128 : 255;
  paintTiles(canvas, progress);
  if (progress) progress("paint detail", 1);
  SurfaceMaterial material;
  material.color_texture.image = 0;
  material.normal_texture.image = 1;
  material.covers = true;
  return atlas.dressed(skin, material, {std::move(canvas.color), std::move(canvas.relief)});
}

}  // namespace viscera
