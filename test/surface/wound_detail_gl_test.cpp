// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Detail of a surface mesh stays on the pieces that a cut makes of it, and walls store their depth (docs/surface.md).
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "model/shape/mesh/box_surface.h"
#include "model/skin_shapes.h"
#include "surface/skins/part_colors.h"
#include "surface/surface.h"
#include "surface/wounds/wound_depths.h"
#include "viscera/gpu/context.h"

namespace viscera::testing {
namespace {

constexpr double kWoundDetailSpacing_m = 0.01;
const Vector3d kSize_m(0.08, 0.07, 0.06);

BoundSkin box() {
  const TriangleMesh mesh = boxSurface(Vector3d::Zero(), kSize_m, {19, 17, 15});
  return bindTo(blockSolid({8, 7, 6}, kWoundDetailSpacing_m), mesh);
}

/// Returns a box in which each triangle has a chart of its own.
Model chartedBox() {
  BoundSkin bound = box();
  Model model;
  Body& body = model.bodies.emplace_back();
  body.lattice = bound.lattice;
  body.skin = bound.skin;
  body.skin.can_be_cut = true;
  auto detail = std::make_shared<SurfaceDetail>();
  detail->materials.resize(1);
  detail->charts.resize(body.skin.mesh.triangles.size());
  for (uint32_t t = 0; t < detail->charts.size(); ++t) body.skin.mesh.charts.push_back(t);
  body.skin.mesh.detail = detail;
  return model;
}

TEST(WoundDetail, PiecesKeepTheChartsOfTheirTriangles) {
  const gpu::Context context;
  const Model model = chartedBox();
  const TriangleMesh& mesh = model.bodies[0].skin.mesh;
  Surface surface(model);
  std::vector<uint32_t> charts = surface.liveCharts().read();
  ASSERT_GE(charts.size(), mesh.triangles.size());
  EXPECT_TRUE(std::equal(mesh.charts.begin(), mesh.charts.end(), charts.begin()));

  std::vector<layout::NodeBits> nodes = model.bodies[0].lattice.nodes;
  const Lattice& lattice = model.bodies[0].lattice;
  const double plane_m = 0.0333;
  cutBetween(
      lattice, [&](const Vector3d& at) { return at.x() < plane_m; }, nodes);
  std::vector<float> axial_cut(3 * nodes.size());
  for (const uint32_t slot : lattice.active_slots) {
    const double x = lattice.restPosition(slot).x();
    if (x < plane_m && x + kWoundDetailSpacing_m > plane_m)
      axial_cut[3 * slot] = static_cast<float>((plane_m - x) / kWoundDetailSpacing_m);
  }
  surface.wound({nodes, {}, axial_cut}, 1);
  charts = surface.liveCharts().read();
  const std::vector<uint32_t> live = surface.liveIndices().read();
  const std::vector<layout::vec4> rests = surface.rests().read();
  size_t skin = 0, walls = 0;
  constexpr double kOff_m = 1e-5;    // crossings are found to a ten-thousandth of a cell
  constexpr double kLip_m = 2.5e-4;  // a lip keeps a twentieth of an edge from its ends (wound_skin.cpp), off the plane
  for (size_t t = 0; 3 * t < surface.liveCount(); ++t) {
    const uint32_t* const v = &live[3 * t];
    if (v[0] == 0 && v[1] == 0 && v[2] == 0) continue;
    if (charts[t] == kNoChart) {
      ++walls;
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(rests[v[i]].x, plane_m, 0.1 * kWoundDetailSpacing_m);
      continue;
    }
    ++skin;
    const auto& corners = mesh.triangles[charts[t]];
    const Vector3d a = mesh.positions_m[corners[0]].cast<double>(), b = mesh.positions_m[corners[1]].cast<double>(),
                   c = mesh.positions_m[corners[2]].cast<double>(), front = (b - a).cross(c - a).normalized();
    for (int i = 0; i < 3; ++i) {
      const Vector3d p(rests[v[i]].x, rests[v[i]].y, rests[v[i]].z);
      EXPECT_NEAR(front.dot(p - a), 0, kOff_m);
      EXPECT_GT(front.dot((b - a).normalized().cross(p - a)), -kOff_m);
      EXPECT_GT(front.dot((c - b).normalized().cross(p - b)), -kOff_m);
      EXPECT_GT(front.dot((a - c).normalized().cross(p - c)), -kOff_m);
      const bool on_lip = std::abs(p.x() - plane_m) < kLip_m;
      EXPECT_EQ(rests[v[i]].w, on_lip ? kOnLip : 0) << "at x " << p.x();
    }
  }
  EXPECT_GT(skin, mesh.triangles.size());
  EXPECT_GT(walls, 50u);
  surface.reset();
  charts = surface.liveCharts().read();
  EXPECT_TRUE(std::equal(mesh.charts.begin(), mesh.charts.end(), charts.begin()));
}

TEST(WoundDetail, DepthIsThatBelowTheNearestFace) {
  const BoundSkin bound = box();
  const WoundDepths depths(bound.skin, bound.lattice);
  constexpr double kOff_m = 0.35 * kWoundDetailSpacing_m;  // the edge between two equally near faces is rounded
  for (const Vector3d& at : {Vector3d(0.04, 0.035, 0.004), Vector3d(0.012, 0.03, 0.03), Vector3d(0.04, 0.035, 0.03),
                             Vector3d(0.06, 0.061, 0.03), Vector3d(0.0, 0.02, 0.03)}) {
    const double truth_m = std::min(at.minCoeff(), (kSize_m - at).minCoeff());
    EXPECT_NEAR(depths.at(at / kWoundDetailSpacing_m), truth_m, kOff_m) << at.transpose();
  }
  constexpr double kRounding_m = 1e-8;  // of positions of 0.1 m in float32
  EXPECT_NEAR(depths.at(Vector3d(4, 3.5, 1)), 0.01, kRounding_m) << "exact at nodes";
  EXPECT_NEAR(depths.at(Vector3d(4, 3.5, 0)), 0, kRounding_m);
}

}  // namespace
}  // namespace viscera::testing
