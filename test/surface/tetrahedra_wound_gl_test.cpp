// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Wounds of tetrahedra on the GPU: where shaders/surface/wound_skin.comp puts what cuts have added.
#include <gtest/gtest.h>

#include <set>

#include "support/networks.h"
#include "surface/cloth_cuts.h"
#include "surface/surface_rig.h"
#include "surface/tetrahedra_rig.h"
#include "viscera/gpu/context.h"

namespace viscera {
namespace {

using namespace viscera::testing;

constexpr double kTetrahedraWoundSpacing_m = 0.01;
constexpr double kTetrahedraWoundPlace_m = 2e-6;  // float rounding of a vertex that is turned and carried 0.2 m away
constexpr double kTetrahedraWoundNormalError = 1.5 / 511;  // a step of a packed normal, and rounding of what is turned
const Vector3d kMiddle(0.0403, 0.0352, 0.0304), kNormal = Vector3d(1, 0.4, -0.2).normalized();
const Eigen::Isometry3d kMotion =
    Eigen::Translation3d(0.1, 0.05, -0.1) * Eigen::AngleAxisd(2.1, Vector3d(1, -2, 0.5).normalized());

class TetrahedraWoundOnGpu : public ::testing::Test {
 protected:
  /// A cloth before the box, so that slots, vertices and springs of the two are not numbered alike.
  TetrahedraWoundOnGpu() : box_(tetrahedraBox({8, 7, 6}, kTetrahedraWoundSpacing_m)), rig_(bodies(box_.body)) {}
  static std::vector<Body> bodies(const Body& box) {
    return {withNetworkSkin(test::clothBody(8, 9, kTetrahedraWoundSpacing_m)), box};
  }
  void show() {
    box_.update();
    std::copy(box_.nodes.begin(), box_.nodes.end(), rig_.nodes.begin() + rig_.model.slotOffset(1));
    std::copy(box_.spring_cut.begin(), box_.spring_cut.end(),
              rig_.spring_cut.begin() + static_cast<long>(firstSpring(rig_.model, 1)));
    rig_.split();
    rig_.surface.wound({rig_.nodes, rig_.spring_cut, {}}, rig_.revision);
    rig_.follow();
  }
  void move(const WoundedTetrahedra::Moves& u) {
    for (size_t slot = 0; slot < u.size(); ++slot) {
      const Vector3f d = u[slot].cast<float>();
      rig_.displacement_m[rig_.model.slotOffset(1) + slot] = {d.x(), d.y(), d.z(), 0};
    }
    rig_.follow();
  }
  /// Vertices of the box, its own ones and then those that the cut has added, as the rig numbers them.
  std::vector<size_t> vertices() const {
    std::vector<size_t> out;
    const Skin& cloth = rig_.model.bodies[0].skin;
    const size_t first = cloth.bindings.size() + 2 * cloth.split_edges.size();
    for (size_t v = 0; v < box_.wound.ownVertices(); ++v) out.push_back(first + v);
    const size_t added = first + box_.wound.ownVertices();
    for (size_t v = 0; v < box_.wound.added().size(); ++v) out.push_back(added + v);
    return out;
  }

  gpu::Context context_;
  WoundedTetrahedra box_;
  SurfaceRig rig_;
};

TEST_F(TetrahedraWoundOnGpu, VerticesAreWhereTheReferenceHasThem) {
  box_.cut(kMiddle, kNormal);
  show();
  for (const auto& u :
       {box_.still(), box_.movedBeyond(kMiddle, kNormal, kMotion), box_.shaken(0.1 * kTetrahedraWoundSpacing_m)}) {
    move(u);
    const std::vector<Vector3d> wanted = box_.positions(u), at = rig_.positions();
    const std::vector<size_t> of_box = vertices();
    ASSERT_EQ(of_box.size(), wanted.size());
    ASSERT_EQ(at.size(), of_box.back() + 1);
    for (size_t v = 0; v < wanted.size(); ++v)
      ASSERT_LT((at[of_box[v]] - wanted[v]).norm(), kTetrahedraWoundPlace_m) << v;
  }
}

TEST_F(TetrahedraWoundOnGpu, NormalsTurnWithTheirPiece) {
  box_.cut(kMiddle, kNormal);
  show();
  const std::vector<Vector3d> before = rig_.normals();
  move(box_.movedBeyond(kMiddle, kNormal, kMotion));
  const std::vector<Vector3d> after = rig_.normals();
  const std::vector<size_t> of_box = vertices();
  size_t turned = 0;
  for (size_t v = box_.wound.ownVertices(); v < of_box.size(); ++v) {
    const uint32_t slot = box_.wound.added()[v - box_.wound.ownVertices()].binding.slot0;
    const bool beyond = kNormal.dot(box_.body.network->positions_m[slot] - kMiddle) >= 0;
    const Vector3d n = before[of_box[v]].normalized();
    ASSERT_LT((after[of_box[v]].normalized() - (beyond ? kMotion.linear() * n : n)).norm(),
              2 * kTetrahedraWoundNormalError)
        << v;
    turned += beyond ? 1 : 0;
  }
  EXPECT_GT(turned, 50u);
}

TEST_F(TetrahedraWoundOnGpu, WhatIsDrawnIsWhatIsTold) {
  box_.cut(kMiddle, kNormal);
  box_.cut({0.0381, 0.0333, 0.0299}, Vector3d(0.1, 1, 0.3).normalized());
  show();
  const auto topology = rig_.surface.skin().shown(rig_.surface.alive().read().data(), rig_.surface.wounds().get());
  const std::vector<Corners> drawn = drawnTriangles(rig_.surface);
  std::multiset<Corners> told, seen(drawn.begin(), drawn.end());
  for (size_t i = 0; i < topology->triangles.size(); i += 3)
    told.insert({topology->triangles[i], topology->triangles[i + 1], topology->triangles[i + 2]});
  EXPECT_EQ(seen, told);
  ASSERT_EQ(topology->patches.size(), 3u);
  EXPECT_EQ(topology->patches[2].kind, ShownKind::kWound);
  EXPECT_EQ(topology->patches[2].count, box_.wound.wallTriangles().size() / 3);
}

TEST_F(TetrahedraWoundOnGpu, ResetShowsTheFirstSkinBitByBit) {
  rig_.follow();
  const std::vector<float> rest = rig_.surface.positions().read();
  const std::vector<uint32_t> normals = rig_.surface.normals().read();
  const auto first = drawnTriangles(rig_.surface);
  const size_t vertices = rig_.surface.vertices();
  box_.cut(kMiddle, kNormal);
  show();
  move(box_.movedBeyond(kMiddle, kNormal, kMotion));
  EXPECT_NE(drawnTriangles(rig_.surface), first);
  rig_.surface.reset();
  move(box_.still());
  EXPECT_EQ(rig_.surface.vertices(), vertices);
  EXPECT_EQ(drawnTriangles(rig_.surface), first);
  std::vector<float> again = rig_.surface.positions().read();
  std::vector<uint32_t> normals_again = rig_.surface.normals().read();
  again.resize(3 * vertices);
  normals_again.resize(vertices);
  EXPECT_TRUE(std::equal(again.begin(), again.end(), rest.begin()));
  EXPECT_TRUE(std::equal(normals_again.begin(), normals_again.end(), normals.begin()));
}

}  // namespace
}  // namespace viscera
