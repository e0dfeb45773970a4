// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Rendering of textures and normal maps (docs/surface.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "model/shape/detail/detail_bake.h"
#include "model/shape/mesh/plain_meshes.h"
#include "render/detail_textures.h"
#include "render/drawing.h"
#include "support/temporary_folder.h"
#include "support/text.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

constexpr int kSameShade = 3;  // of 255: rounding of normals to 10 bits and of texels to 8 bits

TextureImage picture(int side, std::array<uint8_t, 3> (*at)(double u, double v)) {
  TextureImage image{side, side, {}};
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const auto texel = at((x + 0.5) / side, (y + 0.5) / side);
      image.rgba.insert(image.rgba.end(), {texel[0], texel[1], texel[2], 255});
    }
  }
  return image;
}

/// Returns the colour of four quarters: red, green, blue, yellow, from the lower left to the upper right.
std::array<uint8_t, 3> quarters(double u, double v) {
  if (v < 0.5) return u < 0.5 ? std::array<uint8_t, 3>{255, 0, 0} : std::array<uint8_t, 3>{0, 255, 0};
  return u < 0.5 ? std::array<uint8_t, 3>{0, 0, 255} : std::array<uint8_t, 3>{255, 255, 0};
}

/// A mesh of a model with one body, with the outputs of a surface besides its vertices.
struct Detailed {
  Model model;
  GpuMesh gpu;
  gpu::Buffer<layout::vec4> rests;
  gpu::Buffer<uint32_t> charts;
  gpu::TexelView charts_view;

  /// @param pose  current pose of the vertices; at rest they are those of the mesh
  explicit Detailed(const TriangleMesh& mesh, const Pose& pose = {})
      : gpu(positions(mesh, pose), normals(mesh, pose), indices(mesh), 0x00808080u) {
    model.bodies.emplace_back();
    model.bodies[0].skin.mesh = mesh;
    model.bodies[0].skin.two_sided = true;  // no grain
    std::vector<layout::vec4> at_rest;
    for (const Vector3f& p : mesh.positions_m) at_rest.push_back({p.x(), p.y(), p.z(), 0});
    rests = gpu::Buffer<layout::vec4>(at_rest);
    if (mesh.charts.empty()) return;
    charts = gpu::Buffer<uint32_t>(mesh.charts);
    charts_view = gpu::TexelView(charts.raw(), gpu::TexelFormat::kR32ui);
  }
  MeshView view() const {
    MeshView view = gpu.view();
    view.rests = rests.id();
    view.charts = charts_view.id();
    return view;
  }

  static std::vector<Vector3f> positions(const TriangleMesh& mesh, const Pose& pose) {
    std::vector<Vector3f> out;
    for (const Vector3f& p : mesh.positions_m) out.push_back((pose * p.cast<double>()).cast<float>());
    return out;
  }
  static std::vector<Vector3f> normals(const TriangleMesh& mesh, const Pose& pose) {
    std::vector<Vector3f> out = vertexNormals(mesh);
    for (Vector3f& n : out) n = (pose.orientation * n.cast<double>()).cast<float>();
    return out;
  }
  static std::vector<uint32_t> indices(const TriangleMesh& mesh) {
    std::vector<uint32_t> out;
    for (const auto& t : mesh.triangles) out.insert(out.end(), t.begin(), t.end());
    return out;
  }
};

/// Returns a square of 10 cm in the plane y = 0, seen from -y, with x to the right and z up, and u and v along these.
TriangleMesh square(const SurfaceMaterial& material, std::vector<TextureImage> images, double repeats = 1) {
  TriangleMesh mesh;
  mesh.positions_m = {{-0.05F, 0, -0.05F}, {0.05F, 0, -0.05F}, {0.05F, 0, 0.05F}, {-0.05F, 0, 0.05F}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.parts = {0, 0};
  mesh.part_names = {"square"};
  mesh.charts = {0, 1};
  const std::array<Eigen::Vector2d, 4> uv = {Eigen::Vector2d(0, 0), {repeats, 0}, {repeats, repeats}, {0, repeats}};
  auto detail = std::make_shared<SurfaceDetail>();
  detail->images = std::move(images);
  detail->materials = {material};
  detail->part_materials = {0};
  for (const auto& t : mesh.triangles) {
    std::array<Eigen::Vector3d, 3> corners;
    for (size_t i = 0; i < 3; ++i) corners[i] = mesh.positions_m[t[i]].cast<double>();
    detail->charts.push_back(textureChart(corners, {uv[t[0]], uv[t[1]], uv[t[2]]}, 0));
  }
  mesh.detail = detail;
  return mesh;
}

SurfaceMaterial colored() {
  SurfaceMaterial material;
  material.has_color = true;
  material.color_texture.image = 0;
  return material;
}

class DetailGl : public Drawing {
 protected:
  DetailGl() { setenv("XDG_CACHE_HOME", cache_.path().c_str(), 1); }
  test::TemporaryFolder cache_;
  Image drawn(const Detailed& of) {
    Renderer renderer({camera_}, styluses_, {}, &of.model);
    return draw(renderer, of.view());
  }
  /// Returns which of red, green, blue, yellow ('r', 'g', 'b', 'y') a pixel is.
  static char hueAt(const Image& image, int column, int row) {
    const uint8_t* rgb = image.at(column, row);
    const bool r = rgb[0] > 100, g = rgb[1] > 100, b = rgb[2] > 100;
    return r && g ? 'y' : r ? 'r' : g ? 'g' : b ? 'b' : '?';
  }
  int middle_x() const { return camera_.width_px / 2; }
  int middle_y() const { return camera_.height_px / 2; }
};

TEST_F(DetailGl, TexturesThatTheDriverRefusesNameTheirSize) {
  const std::string said = test::messageOf<GpuError>([] { TextureArray(1 << 20, 1 << 20, 3, false); });
  EXPECT_TRUE(test::says(said, {"3 images of 1048576 x 1048576 pixels", "bodies[].textures: false"}));
  EXPECT_NO_THROW(gpu::checkErrors("what came after"));
}

TEST_F(DetailGl, PicturesAreUpright) {
  const Image image = drawn(Detailed(square(colored(), {picture(64, quarters)})));
  EXPECT_EQ(hueAt(image, middle_x() - 20, middle_y() + 20), 'r');
  EXPECT_EQ(hueAt(image, middle_x() + 20, middle_y() + 20), 'g');
  EXPECT_EQ(hueAt(image, middle_x() - 20, middle_y() - 20), 'b');
  EXPECT_EQ(hueAt(image, middle_x() + 20, middle_y() - 20), 'y');
}

TEST_F(DetailGl, PicturesGoWithTheTissue) {
  Pose turned;
  turned.orientation = rotationFromDegrees({0, 180, 0});  // in its plane: the lower left is now the upper right
  turned.position_m = {0.004, 0, 0};
  const Image image = drawn(Detailed(square(colored(), {picture(64, quarters)}), turned));
  EXPECT_EQ(hueAt(image, middle_x() - 20, middle_y() + 20), 'y');
  EXPECT_EQ(hueAt(image, middle_x() + 24, middle_y() - 20), 'r');
}

TEST_F(DetailGl, CoordinatesBeyondOneRepeatMirrorOrStay) {
  SurfaceMaterial material = colored();
  const auto at = [&](TextureWrap wrap) {
    material.color_texture.wrap_u = material.color_texture.wrap_v = wrap;
    const Image image = drawn(Detailed(square(material, {picture(64, quarters)}, 2)));
    return std::string{hueAt(image, middle_x() + 10, middle_y() - 10), hueAt(image, middle_x() + 35, middle_y() - 35)};
  };
  EXPECT_EQ(at(TextureWrap::kRepeat), "ry");
  EXPECT_EQ(at(TextureWrap::kMirror), "yr");
  EXPECT_EQ(at(TextureWrap::kClamp), "yy");
}

TEST_F(DetailGl, FinePicturesSeenSmallAreTheirMean) {
  const auto stripes = [](double u, double) {
    return static_cast<int>(u * 64) % 2 ? std::array<uint8_t, 3>{255, 255, 255} : std::array<uint8_t, 3>{0, 0, 0};
  };
  const Image image = drawn(Detailed(square(colored(), {picture(64, stripes)}, 40)));
  int least = 255, most = 0;
  for (int x = -30; x < 30; ++x) {
    const int green = image.at(middle_x() + x, middle_y() + 10)[1];
    least = std::min(least, green);
    most = std::max(most, green);
  }
  constexpr int kShading = 12;  // of 255: shading differs between the ends of the row
  EXPECT_LT(most - least, kShading) << "stripes finer than pixels shimmer";
}

/// A flat map looks like the bare square; one that tilts by 20 degrees looks like a square with such normals.
TEST_F(DetailGl, NormalMapIsShadedLikeItsNormals) {
  SurfaceMaterial material;
  material.normal_texture.image = 0;
  const double lean = 20 * M_PI / 180;
  const auto flat = [](double, double) { return std::array<uint8_t, 3>{128, 128, 255}; };
  const auto leaning = [](double, double) {
    const double a = 20 * M_PI / 180;
    return std::array<uint8_t, 3>{static_cast<uint8_t>(std::lround(128 - 127.5 * 0.6 * std::sin(a))),
                                  static_cast<uint8_t>(std::lround(128 + 127.5 * 0.8 * std::sin(a))),
                                  static_cast<uint8_t>(std::lround(128 + 127.5 * std::cos(a)) - 1)};
  };
  const std::vector<uint32_t> faces = {0, 1, 2, 0, 2, 3};
  const TriangleMesh shape = square(material, {picture(8, flat)});
  const auto bare = [&](const Vector3f& normal) {
    const GpuMesh mesh(shape.positions_m, std::vector<Vector3f>(4, normal), faces, 0x00808080u);
    return draw(mesh.view());
  };
  const auto expect_same = [&](const Image& a, const Image& b) {
    for (int y = -30; y <= 30; y += 10) {
      for (int x = -30; x <= 30; x += 10) {
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(a.at(middle_x() + x, middle_y() + y)[c], b.at(middle_x() + x, middle_y() + y)[c], kSameShade);
      }
    }
  };
  const Image upright = bare({0, -1, 0});
  const Vector3d leant(-0.6 * std::sin(lean), -std::cos(lean), 0.8 * std::sin(lean));
  const Image truth = bare(leant.cast<float>());
  expect_same(drawn(Detailed(shape)), upright);
  expect_same(drawn(Detailed(square(material, {picture(8, leaning)}))), truth);
  EXPECT_GT(std::abs(truth.sum(middle_x(), middle_y()) - upright.sum(middle_x(), middle_y())), 30);
}

/// A coarse ball with the normals of a bumpy one looks like the bumpy one, also when turned.
TEST_F(DetailGl, BakedBallMatchesTheDetailedOne) {
  const auto bumpy = [](double edge_m) {
    TriangleMesh mesh = ballMesh(0.05, edge_m);
    for (Vector3f& p : mesh.positions_m) {
      const Vector3f d = p.normalized();
      p *= 1 + 0.004F * std::sin(50 * d.x()) * std::sin(50 * d.y()) * std::sin(50 * d.z() + 1);
    }
    return mesh;
  };
  const TriangleMesh fine = bumpy(1e-3), coarse = ballMesh(0.05, 4e-3);
  const TriangleMesh baked = bakeDetail({coarse, fine, false, 2048});
  for (const Vector3d& turn : {Vector3d(0, 0, 0), Vector3d(30, 70, -20)}) {
    SCOPED_TRACE(::testing::Message() << turn.transpose());
    Pose pose;
    pose.orientation = rotationFromDegrees(turn);
    const Image truth = drawn(Detailed(fine, pose)), smooth = drawn(Detailed(coarse, pose)),
                shown = drawn(Detailed(baked, pose));
    double off = 0, off_smooth = 0;
    for (int y = -45; y <= 45; ++y) {
      for (int x = -45; x <= 45; ++x) {
        const int of_truth = truth.sum(middle_x() + x, middle_y() + y);
        off += std::abs(shown.sum(middle_x() + x, middle_y() + y) - of_truth);
        off_smooth += std::abs(smooth.sum(middle_x() + x, middle_y() + y) - of_truth);
      }
    }
    constexpr double kShare = 0.25;  // of the difference that the map removes; the rest is the parallax of the bumps
    EXPECT_LT(off, kShare * off_smooth) << off << " of " << off_smooth;
  }
}

}  // namespace
}  // namespace viscera
