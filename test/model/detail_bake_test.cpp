// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Baking of normals and colours of a fine mesh onto a coarse surface (docs/surface.md).
#include "model/shape/detail/detail_bake.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <random>

#include "model/mesh_samples.h"
#include "model/shape/mesh/fewer_faces.h"
#include "model/shape/mesh/plain_meshes.h"
#include "model/shape/mesh/triangle_tree.h"
#include "support/temporary_folder.h"

namespace viscera {
namespace {

namespace fs = std::filesystem;

constexpr double kRadius_m = 0.05;
constexpr double kBumps = 80;         // per unit of direction: a wave of 4 mm, 1.5 edges of the coarse surface
constexpr double kHeight_m = 1.5e-4;  // slopes of up to 14 degrees
constexpr double kDegrees = 180 / M_PI;
constexpr double kMostMedian_deg = 3;  // limit of issue 14 for a surface of 10,000 faces

double bump(const Vector3d& d) {
  return std::sin(kBumps * d.x()) * std::sin(kBumps * d.y()) * std::sin(kBumps * d.z() + 1);
}

Vector3d surfaceOf(const Vector3d& d) {
  return (kRadius_m + kHeight_m * bump(d)) * d;
}

/// Returns the normal of the surface itself, by differences.
Vector3d trueNormal(const Vector3d& position) {
  const Vector3d d = position.normalized(), s = d.unitOrthogonal(), t = d.cross(s);
  constexpr double kStep = 1e-5;
  const auto at = [&](const Vector3d& offset) { return surfaceOf((d + kStep * offset).normalized()); };
  return (at(s) - at(-s)).cross(at(t) - at(-t)).normalized();
}

TriangleMesh bumpyBall(double edge_m) {
  TriangleMesh mesh = ballMesh(kRadius_m, edge_m);
  for (Vector3f& p : mesh.positions_m) p = surfaceOf(p.cast<double>().normalized()).cast<float>();
  return mesh;
}

/// Fixture with a cache folder of its own.
class DetailBake : public ::testing::Test {
 protected:
  DetailBake() { setenv("XDG_CACHE_HOME", cache_.path().c_str(), 1); }
  ~DetailBake() override { unsetenv("XDG_CACHE_HOME"); }
  test::TemporaryFolder cache_;
};

struct Shown {
  std::vector<double> angles_deg, bare_deg;
  double median() { return medianOf(angles_deg); }
  double bareMedian() { return medianOf(bare_deg); }
  static double medianOf(std::vector<double>& v) {
    std::nth_element(v.begin(), v.begin() + v.size() / 2, v.end());
    return v[v.size() / 2];
  }
};

/// Returns shading normals computed from the mesh as the shader does: charts, texels and vertex normals.
Shown shownBy(const TriangleMesh& mesh) {
  const std::vector<Vector3f> normals = vertexNormals(mesh);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> any(0, 1);
  Shown out;
  for (int i = 0; i < 20000; ++i) {
    const size_t t = static_cast<size_t>(random() % mesh.triangles.size());
    float v = any(random), w = any(random);
    if (v + w > 1) {
      v = 1 - v;
      w = 1 - w;
    }
    const auto& c = mesh.triangles[t];
    const Vector3f position =
        (1 - v - w) * mesh.positions_m[c[0]] + v * mesh.positions_m[c[1]] + w * mesh.positions_m[c[2]];
    const Vector3f n = ((1 - v - w) * normals[c[0]] + v * normals[c[1]] + w * normals[c[2]]).normalized();
    const TextureChart& chart = mesh.detail->charts[mesh.charts[t]];
    const SurfaceMaterial& material = mesh.detail->materials[chart.material];
    const TextureImage& image = mesh.detail->images[static_cast<size_t>(material.normal_texture.image)];
    const int x = static_cast<int>((chart.u.head<3>().dot(position) + chart.u[3]) * image.width_px);
    const int y = static_cast<int>((chart.v.head<3>().dot(position) + chart.v[3]) * image.height_px);
    const uint8_t* texel = &image.rgba[4 * (static_cast<size_t>(y) * image.width_px + x)];
    const Vector3f bent = Vector3f(texel[0] - 128.F, texel[1] - 128.F, texel[2] - 128.F) / 127.5F;
    // V is constant along it.
    const Vector3f along_u = chart.v.head<3>().cross(chart.u.head<3>().cross(chart.v.head<3>()));
    const Vector3f tangent = (along_u - n * n.dot(along_u)).normalized();
    const Vector3f shown = (bent.x() * tangent + bent.y() * n.cross(tangent) + bent.z() * n).normalized();
    const Vector3d truth = trueNormal(position.cast<double>());
    const auto angle = [&](const Vector3f& of) {
      return kDegrees * std::acos(std::min(1.0, of.cast<double>().dot(truth)));
    };
    out.angles_deg.push_back(angle(shown));
    out.bare_deg.push_back(angle(n));
  }
  return out;
}

TEST_F(DetailBake, SkinOfTenThousandFacesHasTheNormalsOfTheBumpyBall) {
  const TriangleMesh fine = bumpyBall(5e-4);
  ASSERT_GT(fine.triangles.size(), 250000u);
  const TriangleMesh skin = withFewerFaces(fine, 10000);
  EXPECT_NEAR(static_cast<double>(skin.triangles.size()), 10000, 200);
  BakeReport report;
  const TriangleMesh baked = bakeDetail({skin, fine, false, 2048}, &report);
  Shown shown = shownBy(baked);
  EXPECT_LT(shown.median(), kMostMedian_deg);
  EXPECT_GT(shown.bareMedian(), kMostMedian_deg);  // else there is nothing to bake
  EXPECT_LT(report.median_deg, kMostMedian_deg);
  EXPECT_EQ(report.uncovered_share, 0);
}

TEST_F(DetailBake, FewerFacesLeaveAClosedMesh) {
  const TriangleMesh skin = withFewerFaces(bumpyBall(1e-3), 3000);
  EXPECT_NEAR(static_cast<double>(skin.triangles.size()), 3000, 60);
  std::map<std::pair<uint32_t, uint32_t>, int> balance;
  for (const auto& t : skin.triangles) {
    for (size_t i = 0; i < 3; ++i) ++balance[{t[i], t[(i + 1) % 3]}];
  }
  size_t open = 0;  // where two folds of the surface meet, an edge may have two triangles on either side
  for (const auto& [edge, count] : balance) {
    const auto other = balance.find({edge.second, edge.first});
    open += other == balance.end() || other->second != count ? 1 : 0;
  }
  EXPECT_EQ(open, 0u);
  constexpr double kVolume = 0.01;  // chords of 3000 faces cut off half of it
  EXPECT_NEAR(signedVolume(skin) / (4.0 / 3 * M_PI * std::pow(kRadius_m, 3)), 1, kVolume);
}

TEST_F(DetailBake, SmallPartsKeepTheirFacesBesideLargeOnes) {
  TriangleMesh mesh = bumpyBall(1e-3);  // the box has fewer faces than parts are simplified to
  const TriangleMesh box = test::boxMesh({0.1F, 0, 0}, {0.11F, 0.01F, 0.01F});
  const auto first = static_cast<uint32_t>(mesh.positions_m.size());
  mesh.positions_m.insert(mesh.positions_m.end(), box.positions_m.begin(), box.positions_m.end());
  for (const auto& t : box.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  mesh.parts.resize(mesh.triangles.size(), static_cast<uint16_t>(mesh.part_names.size()));
  mesh.part_names.push_back("box");
  const TriangleMesh skin = withFewerFaces(mesh, 3000);
  EXPECT_EQ(std::count(skin.parts.begin(), skin.parts.end(), skin.part_names.size() - 1),
            static_cast<std::ptrdiff_t>(box.triangles.size()));
}

TEST_F(DetailBake, IsFoundInTheCacheByItsContents) {
  const TriangleMesh fine = bumpyBall(1e-3), skin = withFewerFaces(fine, 1000);
  BakeReport first, second, other;
  const TriangleMesh a = bakeDetail({skin, fine, false, 1024}, &first),
                     b = bakeDetail({skin, fine, false, 1024}, &second);
  EXPECT_FALSE(first.from_cache);
  EXPECT_TRUE(second.from_cache);
  EXPECT_EQ(a.detail->images[0].rgba, b.detail->images[0].rgba);
  EXPECT_EQ(first.median_deg, second.median_deg);
  TriangleMesh moved = fine;
  moved.positions_m[0].x() += 1e-5F;
  bakeDetail({skin, moved, false, 1024}, &other);
  EXPECT_FALSE(other.from_cache);
  for (const auto& entry : fs::directory_iterator(cache_.path() + "/viscera")) fs::resize_file(entry.path(), 500);
  const TriangleMesh c = bakeDetail({skin, fine, false, 1024}, &second);
  EXPECT_FALSE(second.from_cache) << "a file that was cut short is no bake";
  EXPECT_EQ(a.detail->images[0].rgba, c.detail->images[0].rgba);
}

TEST_F(DetailBake, WhatTheDetailedMeshDoesNotCoverIsSaid) {
  const TriangleMesh skin = ballMesh(kRadius_m, 4e-3);
  TriangleMesh upper = bumpyBall(1e-3);
  TriangleMesh half = upper;
  half.triangles.clear();
  half.parts.clear();
  for (const auto& t : upper.triangles) {
    if (upper.positions_m[t[0]].z() > 0) half.triangles.push_back(t);
  }
  half.parts.assign(half.triangles.size(), 0);
  BakeReport report;
  bakeDetail({skin, half, false, 1024}, &report);
  constexpr double kShare = 0.01, kBeside = 0.05;  // within 3 % of the box's diagonal from the border it is near enough
  EXPECT_NEAR(report.uncovered_share, 0.5 - kBeside, kShare);
  EXPECT_NE(report.text().find("is not near the detailed mesh"), std::string::npos) << report.text();
}

TEST_F(DetailBake, ColorsOfTheDetailedMeshComeAlong) {
  const TriangleMesh skin = ballMesh(kRadius_m, 4e-3);
  TriangleMesh fine = ballMesh(kRadius_m, 2e-3);
  fine.part_names = {"north", "south"};
  for (size_t t = 0; t < fine.triangles.size(); ++t)
    fine.parts[t] = fine.positions_m[fine.triangles[t][0]].z() > 0 ? 0 : 1;
  SurfaceDetail detail;
  detail.materials.resize(2);
  detail.materials[0].has_color = detail.materials[1].has_color = true;
  detail.materials[0].color = {1, 0, 0};
  detail.materials[1].color = {0, 0, 1};
  detail.part_materials = {0, 1};
  fine.detail = std::make_shared<const SurfaceDetail>(detail);
  const TriangleMesh baked = bakeDetail({skin, fine, true, 1024});
  for (size_t t = 0; t < baked.triangles.size(); ++t) {
    Vector3f middle = Vector3f::Zero();
    for (const uint32_t v : baked.triangles[t]) middle += baked.positions_m[v] / 3;
    if (std::abs(middle.z()) < 0.005F) continue;
    const TextureChart& chart = baked.detail->charts[baked.charts[t]];
    const TextureImage& image =
        baked.detail->images[static_cast<size_t>(baked.detail->materials[chart.material].color_texture.image)];
    const int x = static_cast<int>((chart.u.head<3>().dot(middle) + chart.u[3]) * image.width_px);
    const int y = static_cast<int>((chart.v.head<3>().dot(middle) + chart.v[3]) * image.height_px);
    const uint8_t* texel = &image.rgba[4 * (static_cast<size_t>(y) * image.width_px + x)];
    EXPECT_EQ(texel[middle.z() > 0 ? 0 : 2], 255);
    EXPECT_EQ(texel[middle.z() > 0 ? 2 : 0], 0);
  }
}

TEST(TriangleTree, FindsTheSameAsASearchOfEveryTriangle) {
  constexpr float kSame_m = 1e-6F;  // rounding in float32 at 0.05 m
  const TriangleMesh mesh = bumpyBall(8e-3);
  const TriangleTree tree(mesh);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> any(-0.06F, 0.06F);
  for (int i = 0; i < 300; ++i) {
    const Vector3f p(any(random), any(random), any(random)),
        offset = Vector3f(any(random), any(random), any(random)).normalized();
    float nearest = 1e9F, ahead = 1e9F;
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
      TriangleMesh one;
      one.positions_m = mesh.positions_m;
      one.triangles = {mesh.triangles[t]};
      const TriangleTree alone(one);
      nearest = std::min(nearest, alone.nearest(p).distance_m);
      ahead = std::min(ahead, alone.along(p, offset, 1).distance_m);
    }
    const MeshPoint found = tree.nearest(p), line = tree.along(p, offset, 1);
    EXPECT_NEAR(found.distance_m, nearest, kSame_m);
    const auto at = [&](const MeshPoint& position) -> Vector3f {
      const auto& c = mesh.triangles[position.triangle];
      return position.weights[0] * mesh.positions_m[c[0]] + position.weights[1] * mesh.positions_m[c[1]] +
             position.weights[2] * mesh.positions_m[c[2]];
    };
    EXPECT_NEAR((at(found) - p).norm(), found.distance_m, kSame_m);
    if (!line.found()) {
      EXPECT_GT(ahead, 1);
      continue;
    }
    EXPECT_NEAR(line.distance_m, ahead, kSame_m);
    EXPECT_NEAR((at(line) - p).cross(offset).norm(), 0, kSame_m) << "on the line";
    EXPECT_NEAR((at(line) - p).norm(), line.distance_m, kSame_m);
  }
}

}  // namespace
}  // namespace viscera
