// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Wounds that tools cut in sessions, on every backend (docs/surface.md).
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "session/block_session.h"
#include "viscera/gpu/context.h"

namespace viscera {
namespace {

using namespace test;

constexpr double kVolume = 1e-3;  // share of a body that the blade has passed and that springs back to rest
constexpr float kAlikeM = 2e-5f;  // between backends after some hundred substeps, of vertices of a block of 4 cm
/// Share of the vertex indices of triangles in which a GPU may differ: it fuses multiplications and additions
/// differently, so it may decide otherwise where the blade's path touches an edge.
constexpr double kTies = 0.05;
constexpr int kRestTicks = 30;  // after which the block is at rest

Scene cutScene(Backend backend, Structure structure) {
  Scene scene = blockScene();
  scene.solver.backend = backend;
  scene.bodies[0].structure = structure;
  scene.bodies[0].spacing_m = 0.005;  // a wound of many walls
  return scene;
}

SurfaceFrame cutOnce(Session& session) {
  play(session, cut, kCutTicks);
  play(
      session, [](int) { return StylusSamples{}; }, kRestTicks);
  return surfaceAfter(session, {});
}

/// Returns the number of edges, welded by position, without exactly one triangle on either side.
size_t openEdges(const VisibleMesh& mesh) {
  using Point = std::array<float, 3>;
  std::map<std::pair<Point, Point>, int> balance;
  const auto at = [&](uint32_t v) {
    return Point{mesh.positions_m[3 * v], mesh.positions_m[3 * v + 1], mesh.positions_m[3 * v + 2]};
  };
  const std::vector<uint32_t>& triangles = mesh.topology->triangles;
  for (size_t t = 0; t < triangles.size(); t += 3) {
    for (size_t i = 0; i < 3; ++i) {
      const Point a = at(triangles[t + i]), b = at(triangles[t + (i + 1) % 3]);
      if (a != b) balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  size_t open = 0;
  for (const auto& [edge, sum] : balance) open += sum != 0 ? 1 : 0;
  return open;
}

double volume(const VisibleMesh& mesh) {
  double sum = 0;
  const std::vector<uint32_t>& triangles = mesh.topology->triangles;
  for (size_t t = 0; t < triangles.size(); t += 3) {
    const Vector3d a = mesh.position_m(triangles[t]).cast<double>(),
                   b = mesh.position_m(triangles[t + 1]).cast<double>(),
                   c = mesh.position_m(triangles[t + 2]).cast<double>();
    sum += a.dot(b.cross(c)) / 6;
  }
  return sum;
}

bool hasWalls(const VisibleTopology& topology) {
  for (const VisiblePatch& patch : topology.patches) {
    if (patch.kind == SurfaceKind::kWound && patch.count > 0) return true;
  }
  return false;
}

class WoundOn : public ::testing::TestWithParam<std::pair<Backend, Structure>> {};
INSTANTIATE_TEST_SUITE_P(Backends, WoundOn,
                         ::testing::Values(std::make_pair(Backend::kCpu, Structure::kLattice),
                                           std::make_pair(Backend::kGpu, Structure::kLattice),
                                           std::make_pair(Backend::kCpu, Structure::kExplicit),
                                           std::make_pair(Backend::kGpu, Structure::kExplicit)));

TEST_P(WoundOn, IsClosedAndKeepsTheVolumeUntilAReset) {
  gpu::Context context;
  Session session(cutScene(GetParam().first, GetParam().second), context);
  const SurfaceFrame before = surfaceAfter(session, {});
  EXPECT_EQ(before.topology, session.wholeSkin());
  const SurfaceFrame wounded = cutOnce(session);
  ASSERT_TRUE(hasWalls(*wounded.topology));
  EXPECT_EQ(openEdges(wounded), 0u);
  EXPECT_NEAR(volume(wounded) / volume(before), 1, kVolume);
  session.reset();
  const SurfaceFrame after = surfaceAfter(session, {});
  EXPECT_EQ(after.topology, session.wholeSkin());
  EXPECT_EQ(after.positions_m, before.positions_m);
}

SurfaceFrame cutWithContext(Backend backend) {
  gpu::Context context;
  Session session(cutScene(backend, Structure::kLattice), context);
  return cutOnce(session);
}

/// Returns the number of differing vertex indices of triangles.
size_t differing(const VisibleMesh& a, const VisibleMesh& b) {
  const std::vector<uint32_t>&of_a = a.topology->triangles, &of_b = b.topology->triangles;
  size_t out = std::max(of_a.size(), of_b.size()) - std::min(of_a.size(), of_b.size());
  for (size_t i = 0; i < std::min(of_a.size(), of_b.size()); ++i) out += of_a[i] != of_b[i] ? 1 : 0;
  return out;
}

TEST(WoundInALattice, IsTheSameOnTheGpuTheCpuAndWithoutAContext) {
  Session without(cutScene(Backend::kCpu, Structure::kLattice));
  const SurfaceFrame a = cutOnce(without), b = cutWithContext(Backend::kCpu), c = cutWithContext(Backend::kGpu);
  EXPECT_EQ(a.topology->triangles, b.topology->triangles);
  ASSERT_EQ(a.vertices(), b.vertices());
  if (!gpu::Context().isSoftware()) {
    EXPECT_LT(static_cast<double>(differing(a, c)), kTies * static_cast<double>(a.topology->triangles.size()));
    return;
  }
  EXPECT_EQ(a.topology->triangles, c.topology->triangles) << differing(a, c) << " differ";
  ASSERT_EQ(a.vertices(), c.vertices());
  for (size_t v = 0; v < a.vertices(); ++v) {
    ASSERT_LT((a.position_m(v) - b.position_m(v)).norm(), kAlikeM) << v;
    ASSERT_LT((a.position_m(v) - c.position_m(v)).norm(), kAlikeM) << v;
  }
}

TEST(WoundInALattice, MakesNoGpuObjectWhileThereIsRoom) {
  gpu::Context context;
  Session session(cutScene(Backend::kGpu, Structure::kLattice), context);
  FrameRequest outputs;
  outputs.surface = true;
  outputs.cameras = {true};
  play(session, cut, kCutTicks, outputs);  // the first cut makes the shaders that draw lips
  session.reset();
  (void)surfaceAfter(session, {});
  const uint64_t made = gpu::objectsCreated();
  play(session, cut, kCutTicks, outputs);
  EXPECT_EQ(gpu::objectsCreated(), made);
}

}  // namespace
}  // namespace viscera
