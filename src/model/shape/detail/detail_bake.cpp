// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/detail/detail_bake.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <memory>
#include <random>

#include "math/number_text.h"
#include "math/processors.h"
#include "math/srgb.h"
#include "model/shape/detail/detail_atlas.h"
#include "model/shape/detail/detail_cache.h"
#include "model/shape/mesh/triangle_tree.h"

namespace viscera {

namespace {

constexpr float kReach = 0.03F;       // share of the surface's box: largest distance of the detailed mesh
constexpr double kTexelsPerFace = 4;  // per face of the detailed mesh: enough to show each
constexpr int kLargestTile_px = 64;
constexpr size_t kMostSamples = 20000;  // points at which the angles are measured
constexpr double kDegrees = 57.29577951308232;

/// Surface, and the detailed mesh that is baked onto it.
class Baker {
 public:
  Baker(const BakeInput& input, const DetailAtlas& atlas)
      : skin_(input.skin),
        detailed_(input.detailed),
        atlas_(atlas),
        with_colors_(input.with_colors),
        tree_(input.detailed),
        normals_(vertexNormals(input.skin)),
        detailed_normals_(vertexNormals(input.detailed)) {
    Eigen::AlignedBox3f box;
    for (const Vector3f& p : skin_.positions_m) box.extend(p);
    reach_m_ = kReach * box.diagonal().norm();
  }

  /// Point on a triangle of the surface.
  struct Spot {
    Vector3f position_m, normal;
  };
  Spot spotOn(uint32_t triangle, const Eigen::Vector3d& weights) const {
    const auto& c = skin_.triangles[triangle];
    const Vector3f w = weights.cast<float>();
    Spot out;
    out.position_m = w[0] * skin_.positions_m[c[0]] + w[1] * skin_.positions_m[c[1]] + w[2] * skin_.positions_m[c[2]];
    out.normal = (w[0] * normals_[c[0]] + w[1] * normals_[c[1]] + w[2] * normals_[c[2]]).stableNormalized();
    return out;
  }
  /// Returns the point of the detailed mesh that is visible there.
  MeshPoint seenFrom(const Spot& spot) const {
    const MeshPoint ahead = tree_.along(spot.position_m, spot.normal, reach_m_);
    return ahead.found() ? ahead : tree_.nearest(spot.position_m, reach_m_);
  }
  Vector3f detailedNormal(const MeshPoint& at) const {
    const auto& c = detailed_.triangles[at.triangle];
    return (at.weights[0] * detailed_normals_[c[0]] + at.weights[1] * detailed_normals_[c[1]] +
            at.weights[2] * detailed_normals_[c[2]])
        .stableNormalized();
  }

  /// Returns T, B, N of shaders/draw/detail.glsl at rest.
  static Eigen::Matrix3f frame(const Vector3f& along_u, const Vector3f& n) {
    const Vector3f t = (along_u - n * n.dot(along_u)).stableNormalized();
    Eigen::Matrix3f out;
    out.col(0) = t;
    out.col(1) = n.cross(t);
    out.col(2) = n;
    return out;
  }
  /// Returns the direction in which u grows and v does not: to the second corner, or in the tile's other half from it.
  Vector3f alongU(uint32_t triangle, int half) const {
    const auto& c = skin_.triangles[triangle];
    const Vector3f edge = skin_.positions_m[c[1]] - skin_.positions_m[c[0]];
    return half == 0 ? edge : Vector3f(-edge);
  }

  void bakeTile(size_t tile, TextureImage& relief, TextureImage& color, size_t& texels, size_t& uncovered) const {
    for (int y = 0; y < atlas_.tile(); ++y) {
      for (int x = 0; x < atlas_.tile(); ++x) {
        const int half = atlas_.halfOf(x, y);
        const uint32_t triangle = atlas_.trianglesOf(tile)[static_cast<size_t>(half)];
        if (triangle == MeshPoint::kNone) continue;
        const Eigen::Vector3d weights = atlas_.weightsOf(x, y);
        const Spot spot = spotOn(triangle, weights);
        const MeshPoint at = seenFrom(spot);
        const bool within = weights.minCoeff() >= 0;
        texels += within ? 1 : 0;
        uncovered += within && !at.found() ? 1 : 0;
        if (!at.found()) continue;
        const auto [column, row] = atlas_.positionOf(tile);
        const size_t texel = 4 * (static_cast<size_t>(row + y) * atlas_.side() + static_cast<size_t>(column + x));
        const Vector3f bent = frame(alongU(triangle, half), spot.normal).transpose() * detailedNormal(at);
        for (int i = 0; i < 3; ++i)
          relief.rgba[texel + i] = static_cast<uint8_t>(std::lround(std::clamp(128 + 127.5F * bent[i], 0.F, 255.F)));
        if (with_colors_) putColor(at, &color.rgba[texel]);
      }
    }
  }

  /// Writes the texel of a chart with a texture; else the part's colour, in sRGB.
  void putColor(const MeshPoint& at, uint8_t* out) const;

  const DetailAtlas& atlas() const { return atlas_; }
  const TriangleMesh& skin() const { return skin_; }

 private:
  const TriangleMesh &skin_, &detailed_;
  const DetailAtlas& atlas_;
  bool with_colors_;
  TriangleTree tree_;
  std::vector<Vector3f> normals_, detailed_normals_;
  float reach_m_ = 0;
};

int wrappedTexel(double coordinate, int count, TextureWrap wrap) {
  double at = coordinate;
  if (wrap == TextureWrap::kMirror) at = std::abs(std::fmod(std::fmod(at - 1, 2) + 2, 2) - 1);
  if (wrap == TextureWrap::kRepeat) at -= std::floor(at);
  return std::clamp(static_cast<int>(std::floor(at * count)), 0, count - 1);
}

void Baker::putColor(const MeshPoint& at, uint8_t* out) const {
  out[3] = 255;
  const SurfaceDetail& detail = *detailed_.detail;
  const uint32_t chart = detailed_.charts.empty() ? kNoChart : detailed_.charts[at.triangle];
  const uint32_t part = detailed_.parts[at.triangle];
  const uint32_t index = chart != kNoChart                     ? detail.charts[chart].material
                         : part < detail.part_materials.size() ? detail.part_materials[part]
                                                               : kNoChart;
  if (index == kNoChart) return;
  const SurfaceMaterial& material = detail.materials[index];
  std::array<double, 3> color = {material.color[0], material.color[1], material.color[2]};
  if (chart != kNoChart && material.color_texture.image >= 0) {
    const TextureImage& image = detail.images[static_cast<size_t>(material.color_texture.image)];
    const auto& c = detailed_.triangles[at.triangle];
    const Vector3f position = at.weights[0] * detailed_.positions_m[c[0]] +
                              at.weights[1] * detailed_.positions_m[c[1]] + at.weights[2] * detailed_.positions_m[c[2]];
    const TextureChart& of = detail.charts[chart];
    const int x = wrappedTexel(of.u.head<3>().dot(position) + of.u[3], image.width_px, material.color_texture.wrap_u);
    const int y = wrappedTexel(of.v.head<3>().dot(position) + of.v[3], image.height_px, material.color_texture.wrap_v);
    for (size_t i = 0; i < 3; ++i)
      color[i] *= linearFromSrgb(image.rgba[4 * (static_cast<size_t>(y) * image.width_px + x) + i] / 255.0);
  }
  for (size_t i = 0; i < 3; ++i) out[i] = srgbByte(color[i]);
}

TextureImage filled(int side, std::array<uint8_t, 4> texel) {
  TextureImage image{side, side, {}};
  image.rgba.resize(size_t{4} * side * side);
  for (size_t i = 0; i < image.rgba.size(); ++i) image.rgba[i] = texel[i % 4];
  return image;
}

void bakeTiles(const Baker& baker, Baked& out, const Progress& progress) {
  const size_t tiles = baker.atlas().tiles();
  std::atomic<size_t> next{0}, texels{0}, uncovered{0};
  const auto work = [&](bool tells) {
    size_t own = 0, bare = 0;
    constexpr size_t kTilesAtOnce = 64;
    for (size_t first = next.fetch_add(kTilesAtOnce); first < tiles; first = next.fetch_add(kTilesAtOnce)) {
      for (size_t tile = first; tile < std::min(first + kTilesAtOnce, tiles); ++tile)
        baker.bakeTile(tile, out.relief, out.color, own, bare);
      if (tells && progress) progress("bake detail", static_cast<double>(first) / static_cast<double>(tiles));
    }
    texels += own;
    uncovered += bare;
  };
  std::vector<std::future<void>> helpers;  // their destructors wait, also where the progress callback throws
  for (int i = usableProcessors(); i > 1; --i) helpers.push_back(std::async(std::launch::async, work, false));
  work(true);
  for (std::future<void>& helper : helpers) helper.get();
  out.report.uncovered_share = texels > 0 ? static_cast<double>(uncovered) / static_cast<double>(texels) : 0;
}

/// Returns the filtered texel at u, v.
Vector3f sampled(const TextureImage& image, const Eigen::Vector2d& uv) {
  const double x = uv.x() * image.width_px - 0.5, y = uv.y() * image.height_px - 0.5;
  const double left = std::floor(x), low = std::floor(y);
  Vector3f sum = Vector3f::Zero();
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 2; ++i) {
      const int column = std::clamp(static_cast<int>(left) + i, 0, image.width_px - 1);
      const int row = std::clamp(static_cast<int>(low) + j, 0, image.height_px - 1);
      const uint8_t* texel = &image.rgba[4 * (static_cast<size_t>(row) * image.width_px + column)];
      const double weight = (i ? x - left : 1 - (x - left)) * (j ? y - low : 1 - (y - low));
      for (int c = 0; c < 3; ++c) sum[c] += static_cast<float>(weight) * (texel[c] - 128) / 127.5F;
    }
  }
  return sum;
}

double percentile(std::vector<double>& values, double share) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Measures the angles between shown and detailed normals at random points.
void measure(const Baker& baker, Baked& baked) {
  const DetailAtlas& atlas = baker.atlas();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(0, 1);
  std::vector<double> angles, bare;
  for (size_t i = 0; i < kMostSamples; ++i) {
    const size_t tile =
        std::min(static_cast<size_t>(any(random) * static_cast<double>(atlas.tiles())), atlas.tiles() - 1);
    const int half = any(random) < 0.5 ? 0 : 1;
    const uint32_t triangle = atlas.trianglesOf(tile)[static_cast<size_t>(half)];
    double v = any(random), w = any(random);
    if (v + w > 1) {
      v = 1 - v;
      w = 1 - w;
    }
    if (triangle == MeshPoint::kNone) continue;
    const Baker::Spot spot = baker.spotOn(triangle, {1 - v - w, v, w});
    const MeshPoint at = baker.seenFrom(spot);
    if (!at.found()) continue;
    const std::array<Eigen::Vector2d, 3> uv = atlas.cornersOf(tile, half);
    const Vector3f bent = sampled(baked.relief, (1 - v - w) * uv[0] + v * uv[1] + w * uv[2]);
    const Vector3f shown = Baker::frame(baker.alongU(triangle, half), spot.normal) * bent.stableNormalized();
    const Vector3f truth = baker.detailedNormal(at);
    const auto angle = [&](const Vector3f& n) { return kDegrees * std::atan2(n.cross(truth).norm(), n.dot(truth)); };
    angles.push_back(angle(shown));
    bare.push_back(angle(spot.normal));
  }
  baked.report.median_deg = percentile(angles, 0.5);
  baked.report.percentile95_deg = percentile(angles, 0.95);
  baked.report.bare_median_deg = percentile(bare, 0.5);
}

/// Returns a tile size fine enough for the faces of the detailed mesh, and within the largest square.
int tileOf(const BakeInput& input) {
  const double pairs = std::ceil(static_cast<double>(input.skin.triangles.size()) / 2);
  const int fits = DetailAtlas::largestTile(input.skin.triangles.size(), input.largest_px);
  const double faces = static_cast<double>(input.detailed.triangles.size()) / pairs;
  const int wanted = static_cast<int>(std::ceil(std::sqrt(kTexelsPerFace * faces))) + 4;
  return std::clamp(wanted, DetailAtlas::kSmallestTile_px, std::min(fits, kLargestTile_px));
}

TriangleMesh dressed(const BakeInput& input, const DetailAtlas& atlas, const Baked& baked) {
  SurfaceMaterial material;
  material.normal_texture.image = 0;
  std::vector<TextureImage> images = {baked.relief};
  if (input.with_colors) {
    material.has_color = true;
    material.color_texture.image = 1;
    images.push_back(baked.color);
  }
  return atlas.dressed(input.skin, material, std::move(images));
}

}  // namespace

std::string BakeReport::text() const {
  TextOut out;
  out.precision(3);
  out << "detail: " << side_px << " x " << side_px << " texels" << (from_cache ? " (from the cache)" : "")
      << "; shading normals differ from the detailed mesh's by " << median_deg
      << " degrees (median; 95th percentile: " << percentile95_deg << "), without the detail by " << bare_median_deg;
  if (uncovered_share > 0.001) {
    out << "; " << 100 * uncovered_share << " % of the skin is not near the detailed mesh and stays smooth";
  }
  return out.str();
}

TriangleMesh bakeDetail(const BakeInput& input, BakeReport* report, const Progress& progress) {
  const DetailAtlas atlas(input.skin, tileOf(input));
  const DetailCache cache(detailCacheFolder(), input, atlas.tile());
  Baked baked;
  if (!cache.find(baked)) {
    baked.relief = filled(atlas.side(), {128, 128, 255, 255});
    if (input.with_colors) baked.color = filled(atlas.side(), {255, 255, 255, 255});
    if (progress) progress("bake detail", 0);
    const Baker baker(input, atlas);
    bakeTiles(baker, baked, progress);
    measure(baker, baked);
    baked.report.side_px = atlas.side();
    cache.keep(baked);
  }
  if (progress) progress("bake detail", 1);
  if (report != nullptr) *report = baked.report;
  return dressed(input, atlas, baked);
}

}  // namespace viscera
