// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "support/networks.h"
#include "surface/follow/state_mirror.h"
#include "surface/surface_rig.h"
#include "viscera/gpu/context.h"

namespace viscera {
namespace {

using namespace viscera::testing;
using test::clothBody;

constexpr double kSpacing_m = 0.01;
// A step of a packed normal is 1/511 per axis and rounding errs by half of it; plus float noise.
constexpr double kNormalError = 1.0 / 511;

class NetworkMapping : public ::testing::Test {
 protected:
  gpu::Context context_;
  std::mt19937 random_{11};

  void scatter(SurfaceRig& rig, float size_m) {
    std::uniform_real_distribution<float> step(-size_m, size_m);
    for (layout::vec4& u : rig.displacement_m) u = {step(random_), step(random_), step(random_), 0};
  }
};

Body cloth(int rows = 20, int columns = 17) {
  return withNetworkSkin(clothBody(rows, columns, kSpacing_m));
}

Body ball() {
  Body body;
  TriangleMesh mesh = ballMesh(0.03, 0.006);
  for (Vector3f& x : mesh.positions_m) x += Vector3f(0.4f, -0.2f, 0.1f);
  adoptNetwork(membraneNetwork(mesh, body.material, 1e-3), body);
  return withNetworkSkin(body);
}

/// Returns the area-weighted mean of the normals of the triangles around each vertex, in float64.
std::vector<Vector3d> ringNormals(const TriangleMesh& mesh, const std::vector<Vector3d>& at) {
  std::vector<Vector3d> out(mesh.positions_m.size(), Vector3d::Zero());
  for (const auto& t : mesh.triangles) {
    const Vector3d normal = (at[t[1]] - at[t[0]]).cross(at[t[2]] - at[t[0]]);
    for (uint32_t v : t) out[v] += normal;
  }
  for (Vector3d& normal : out) normal.normalize();
  return out;
}

TEST_F(NetworkMapping, VertexIsWhereItsNodeIs) {
  SurfaceRig rig({cloth(), ball()});
  scatter(rig, 0.3f);
  rig.follow();
  const std::vector<float> positions = rig.surface.positions().read();
  size_t vertex = 0;
  for (size_t b = 0; b < 2; ++b) {
    const Body& body = rig.model.bodies[b];
    for (size_t v = 0; v < body.skin.bindings.size(); ++v, ++vertex) {
      const uint32_t slot = body.skin.bindings[v].slot0;
      const layout::vec4& u = rig.displacement_m[rig.model.slotOffset(b) + slot];
      const Vector3f rest = body.network->positions_m[slot].cast<float>();
      ASSERT_EQ(positions[3 * vertex], rest.x() + u.x);
      ASSERT_EQ(positions[3 * vertex + 1], rest.y() + u.y);
      ASSERT_EQ(positions[3 * vertex + 2], rest.z() + u.z);
    }
    vertex += 2 * body.skin.split_edges.size();
  }
  EXPECT_EQ(vertex, rig.surface.vertices());
}

TEST_F(NetworkMapping, NormalIsTheMeanOfTheTrianglesAroundByArea) {
  for (float size_m : {0.0f, 0.002f, 0.3f}) {
    SurfaceRig rig(ball());
    scatter(rig, size_m);
    rig.follow();
    const Skin& skin = rig.model.bodies[0].skin;
    const std::vector<Vector3d> normals = rig.normals(), expected = ringNormals(skin.mesh, rig.positions());
    for (size_t v = 0; v < skin.bindings.size(); ++v) {
      ASSERT_LT((normals[v] - expected[v]).norm(), kNormalError) << "vertex " << v << ", scattered by " << size_m;
    }
  }
}

TEST_F(NetworkMapping, NormalsAreUnitForAnyInput) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const std::vector<Vector3f> sizes = {{0, 0, 0},      {1, 0, 0},   {1e-20f, 1e-20f, 1e-20f}, {1e18f, 1e18f, 1e18f},
                                       {0, nan, 0},    {inf, 0, 0}, {inf, -inf, inf},         {1e38f, 1e38f, 1e38f},
                                       {nan, nan, nan}};
  for (const Vector3f& size : sizes) {
    SurfaceRig rig(cloth(7, 7));
    scatter(rig, 1);
    for (layout::vec4& u : rig.displacement_m) u = {u.x * size.x(), u.y * size.y(), u.z * size.z(), 0};
    rig.follow();
    for (const Vector3d& normal : rig.normals()) ASSERT_NEAR(normal.norm(), 1, kNormalError) << size.transpose();
  }
}

TEST_F(NetworkMapping, NodesInOnePointKeepTheNormalAtRest) {
  SurfaceRig rig(cloth(7, 7));
  rig.moveNodes([](const Vector3d&) { return Vector3d::Zero(); });
  rig.follow();
  for (const Vector3d& normal : rig.normals()) ASSERT_LT((normal - Vector3d::UnitZ()).norm(), kNormalError);
}

TEST_F(NetworkMapping, LatticeBesideAClothKeepsItsBits) {
  const auto block = [] {
    return makeBody(blockSolid({4, 3, 5}, kSpacing_m), boxMesh({0, 0, 0}, {0.04, 0.03, 0.05}, 9));
  };
  const auto bend = [](const Vector3d& x) { return Vector3d(x.x() + 3 * x.z() * x.z(), 1.1 * x.y(), x.z() - x.x()); };
  SurfaceRig alone(block()), beside({cloth(), block(), ball()});
  for (SurfaceRig* rig : {&alone, &beside}) {
    rig->moveNodes(bend);
    rig->follow();
  }
  const size_t before =
      beside.model.bodies[0].skin.bindings.size() + 2 * beside.model.bodies[0].skin.split_edges.size();
  const auto part = [](const auto& all, size_t first, size_t count) {
    return std::vector<typename std::decay_t<decltype(all)>::value_type>(
        all.begin() + static_cast<long>(first), all.begin() + static_cast<long>(first + count));
  };
  const size_t own = alone.surface.vertices();
  EXPECT_EQ(part(beside.surface.positions().read(), 3 * before, 3 * own), alone.surface.positions().read());
  EXPECT_EQ(part(beside.surface.normals().read(), before, own), alone.surface.normals().read());
}

TEST_F(NetworkMapping, ExplicitLatticeIsShownAsTheImplicitOne) {
  Body block = makeBody(blockSolid({4, 3, 5}, kSpacing_m), boxMesh({0, 0, 0}, {0.04, 0.03, 0.05}, 9));
  Body linked = block;
  linked.network = latticeNetwork(linked);
  SurfaceRig implicit_rig(block), explicit_rig(linked);
  for (SurfaceRig* rig : {&implicit_rig, &explicit_rig}) {
    rig->moveNodes([](const Vector3d& x) { return Vector3d(x.x() + x.z() * x.y(), 1.1 * x.y(), x.z() - x.x()); });
    cutBetween(
        block.lattice, [](const Vector3d& x) { return x.x() > 0.015; }, rig->nodes);
    rig->follow();
  }
  EXPECT_EQ(explicit_rig.surface.positions().read(), implicit_rig.surface.positions().read());
  EXPECT_EQ(explicit_rig.surface.normals().read(), implicit_rig.surface.normals().read());
}

}  // namespace
}  // namespace viscera
