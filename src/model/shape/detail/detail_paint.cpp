// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/detail/detail_paint.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <future>
#include <memory>

#include "math/processors.h"
#include "math/srgb.h"
#include "model/shape/detail/detail_atlas.h"

namespace viscera {

namespace {

constexpr int kLargestPaintTile_px = 32;
constexpr float kStep_m = 1e-4F;  // step for slopes: less than a texel
constexpr float kFlat = 1e-6F;    // slopes too small to change a texel's normal

/// Table of the sRGB value of a linear channel, with the same results as srgbByte().
class SrgbTable {
 public:
  SrgbTable() {
    for (size_t i = 0; i < kBins; ++i) {
      bytes_[i] = srgbByte(static_cast<double>(i) / kBins);
      // No bin has two borders: the curve rises by less than 0.81 bytes from one bin to the next.
      borders_[i] = static_cast<float>(linearFromSrgb((bytes_[i] + 0.5) / 255));
    }
  }
  uint8_t of(float linear) const {
    const auto bin = static_cast<size_t>(std::clamp(linear, 0.0F, kLast) * kBins);
    return static_cast<uint8_t>(bytes_[bin] + (linear > borders_[bin] ? 1 : 0));
  }

 private:
  static constexpr size_t kBins = 4096;
  static constexpr float kLast = 1 - 1.0F / kBins;
  std::array<uint8_t, kBins> bytes_{};
  std::array<float, kBins> borders_{};
};

struct Canvas {
  const TriangleMesh& skin;
  const PlacedPaint& on;
  const DetailAtlas& atlas;
  std::vector<Vector3f> positions, normals;  ///< of the surface's vertices, in the frame of the paint
  TextureImage color, relief;
  SrgbTable srgb;
};

/// One triangle's half of a tile.
class Half {
 public:
  Half(Canvas& canvas, size_t tile, int half) : canvas_(canvas), tile_(tile), half_(half) {
    const uint32_t triangle = canvas.atlas.trianglesOf(tile)[static_cast<size_t>(half)];
    if (triangle == UINT32_MAX) return;
    for (size_t i = 0; i < 3; ++i) {
      at_[i] = canvas.positions[canvas.skin.triangles[triangle][i]];
      normals_[i] = canvas.normals[canvas.skin.triangles[triangle][i]];
    }
    findNear();
  }

  void paint() {
    if (near_.empty()) return;
    const int side = canvas_.atlas.tile();
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        if (canvas_.atlas.halfOf(x, y) != half_) continue;
        add(x, y);
        if (row_.count == PaintRow::kMost) flush();
      }
    }
    flush();
  }

 private:
  /// Finds strokes near the ball around all of its texels, which extend beyond the triangle.
  void findNear() {
    const int last = canvas_.atlas.tile() - 1, low = half_ == 0 ? 0 : last;
    std::array<Vector3f, 3> ends;
    Vector3f middle = Vector3f::Zero();
    for (size_t i = 0; i < 3; ++i) {
      ends[i] = positionAt(i == 1 ? last - low : low, i == 2 ? last - low : low);
      middle += ends[i] / 3;
    }
    float radius = 0;
    for (const Vector3f& end : ends) radius = std::max(radius, (end - middle).norm());
    canvas_.on.paint->findNear(middle, radius + step(), near_);
  }
  float step() const { return kStep_m / static_cast<float>(canvas_.on.unit_m); }
  Vector3f positionAt(int x, int y) const {
    const Vector3d w = canvas_.atlas.weightsOf(x, y, half_);
    return mixed(at_, w.cast<float>());
  }
  static Vector3f mixed(const std::array<Vector3f, 3>& of, const Vector3f& w) {
    return w[0] * of[0] + w[1] * of[1] + w[2] * of[2];
  }

  void add(int x, int y) {
    const Vector3f w = canvas_.atlas.weightsOf(x, y, half_).cast<float>();
    const Vector3f position = mixed(at_, w), n = mixed(normals_, w).stableNormalized();
    for (int i = 0; i < 3; ++i) {
      row_.position[static_cast<size_t>(i)][row_.count] = position[i];
      row_.normal[static_cast<size_t>(i)][row_.count] = n[i];
    }
    texels_[row_.count++] = {x, y};
  }

  void flush() {
    if (row_.count == 0) return;
    const auto [middle, radius] = ballAround(row_.position, row_.count);
    const auto [normal, spread] = ballAround(row_.normal, row_.count);
    canvas_.on.paint->narrow(near_, middle, radius + step(), normal, spread, nearer_);
    if (!nearer_.empty()) {
      canvas_.on.paint->paint(nearer_, row_);
      const PaintRow along_t = stepped(0), along_b = stepped(1);
      for (size_t l = 0; l < row_.count; ++l) put(l, along_t.height[l], along_b.height[l]);
    }
    row_.count = 0;
  }
  static std::pair<Vector3f, float> ballAround(const std::array<PaintRow::Lane, 3>& lanes, size_t count) {
    Vector3f low, high;
    for (size_t i = 0; i < 3; ++i) {
      const auto [least, most] =
          std::minmax_element(lanes[i].begin(), lanes[i].begin() + static_cast<ptrdiff_t>(count));
      low[static_cast<int>(i)] = *least;
      high[static_cast<int>(i)] = *most;
    }
    return {(low + high) / 2, (high - low).norm() / 2};
  }

  /// Returns heights one step along the tangent, or across it. The frame is that of shaders/draw/detail.glsl: T is
  /// where u grows.
  PaintRow stepped(int across) const {
    PaintRow out = row_;
    const Vector3f along_u = (half_ == 0 ? 1.F : -1.F) * (at_[1] - at_[0]);
    for (size_t l = 0; l < row_.count; ++l) {
      const Vector3f n(row_.normal[0][l], row_.normal[1][l], row_.normal[2][l]);
      const Vector3f t = (along_u - n * n.dot(along_u)).stableNormalized();
      const Vector3f offset = step() * (across == 0 ? t : n.cross(t));
      for (int i = 0; i < 3; ++i) out.position[static_cast<size_t>(i)][l] += offset[i];
    }
    canvas_.on.paint->raise(nearer_, out);
    return out;
  }

  void put(size_t l, float along_t, float along_b) {
    const auto [column, row] = canvas_.atlas.positionOf(tile_);
    const auto [x, y] = texels_[l];
    const size_t texel = 4 * (static_cast<size_t>(row + y) * canvas_.atlas.side() + static_cast<size_t>(column + x));
    if (row_.cover[l] > 0) {
      for (size_t i = 0; i < 3; ++i) canvas_.color.rgba[texel + i] = canvas_.srgb.of(row_.color[i][l]);
      canvas_.color.rgba[texel + 3] = static_cast<uint8_t>(std::lround(255 * std::min(row_.cover[l], 1.F)));
    }
    const float slope_t = (along_t - row_.height[l]) / step(), slope_b = (along_b - row_.height[l]) / step();
    if (std::abs(slope_t) + std::abs(slope_b) < kFlat) return;
    const Vector3f bent = Vector3f(-slope_t, -slope_b, 1).normalized();
    for (int i = 0; i < 3; ++i)
      canvas_.relief.rgba[texel + static_cast<size_t>(i)] =
          static_cast<uint8_t>(std::lround(std::clamp(128 + 127.5F * bent[i], 0.F, 255.F)));
  }

  Canvas& canvas_;
  const size_t tile_;
  const int half_;
  std::array<Vector3f, 3> at_, normals_;
  std::vector<uint32_t> near_, nearer_;
  PaintRow row_;
  std::array<std::array<int, 2>, PaintRow::kMost> texels_{};
};

void paintTiles(Canvas& canvas, const Progress& progress) {
  const size_t tiles = canvas.atlas.tiles();
  std::atomic<size_t> next{0};
  const auto work = [&](bool tells) {
    constexpr size_t kTilesAtOnce = 64;
    for (size_t first = next.fetch_add(kTilesAtOnce); first < tiles; first = next.fetch_add(kTilesAtOnce)) {
      for (size_t tile = first; tile < std::min(first + kTilesAtOnce, tiles); ++tile) {
        for (int half = 0; half < 2; ++half) Half(canvas, tile, half).paint();
      }
      if (tells && progress) progress("paint detail", static_cast<double>(first) / static_cast<double>(tiles));
    }
  };
  std::vector<std::future<void>> helpers;  // their destructors wait, also where the progress callback throws
  for (int i = usableProcessors(); i > 1; --i) helpers.push_back(std::async(std::launch::async, work, false));
  work(true);
  for (std::future<void>& helper : helpers) helper.get();
}

}  // namespace

TriangleMesh paintDetail(const TriangleMesh& skin, const PlacedPaint& on, int largest_px, const Progress& progress) {
  const DetailAtlas atlas(skin,
                          std::min(DetailAtlas::largestTile(skin.triangles.size(), largest_px), kLargestPaintTile_px));
  Canvas canvas{skin, on, atlas, {}, vertexNormals(skin), {atlas.side(), atlas.side(), {}}, {}, {}};
  for (const Vector3f& p : skin.positions_m)
    canvas.positions.push_back((on.turn * (p.cast<double>() / on.unit_m) + on.shift).cast<float>());
  for (Vector3f& n : canvas.normals) n = (on.turn * n.cast<double>()).cast<float>();
  canvas.color.rgba.resize(size_t{4} * atlas.side() * atlas.side());
  canvas.relief = canvas.color;
  const Vector3f ground = on.paint->ground();  // mipmaps also mix in uncovered colours
  const std::array<uint8_t, 4> bare = {srgbByte(ground.x()), srgbByte(ground.y()), srgbByte(ground.z()), 0};
  for (size_t i = 0; i < canvas.color.rgba.size(); ++i) {
    canvas.color.rgba[i] = bare[i % 4];
    canvas.relief.rgba[i] = i % 4 < 2 ? 128 : 255;
  }
  paintTiles(canvas, progress);
  if (progress) progress("paint detail", 1);
  SurfaceMaterial material;
  material.color_texture.image = 0;
  material.normal_texture.image = 1;
  material.covers = true;
  return atlas.dressed(skin, material, {std::move(canvas.color), std::move(canvas.relief)});
}

}  // namespace viscera
