// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/follow/state_mirror.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "gpu/gl.h"

#include "surface/cloth_cuts.h"
#include "surface/surface_rig.h"
#include "viscera/gpu/context.h"
#include "viscera/model/body/neighbors.h"

namespace viscera {
namespace {

using namespace viscera::testing;

constexpr double kStateMirrorSpacing_m = 0.01;
constexpr double kRadius_m = 0.06;

/// A surface that follows the state itself, and one that follows the mirror's copy.
class StateMirrorTest : public ::testing::Test {
 protected:
  StateMirrorTest() : StateMirrorTest(balls()) {}
  explicit StateMirrorTest(std::vector<Body> bodies)
      : rig_(std::move(bodies)), mirror_(rig_.model), mirrored_(rig_.model) {
    snapshot_.bricks = mirror_.shownBricks();
  }

  /// Returns two balls of several bricks, with springs and surface meshes across the borders of bricks.
  static std::vector<Body> balls() {
    std::vector<Body> out;
    for (const Vector3d& center : {Vector3d(0, 0, 0), Vector3d(0.3, 0.01, 0)}) {
      out.push_back(makeBody(ballSolid(center, kRadius_m, kStateMirrorSpacing_m), sphereMesh(center, kRadius_m, 12)));
    }
    return out;
  }

  void takeSnapshot() {
    std::vector<float> all;
    for (size_t brick = 0; brick < rig_.displacement_m.size() / layout::kBrickSlots; ++brick) {
      for (float layout::vec4::*component : {&layout::vec4::x, &layout::vec4::y, &layout::vec4::z}) {
        for (size_t i = 0; i < layout::kBrickSlots; ++i) {
          all.push_back(rig_.displacement_m[brick * layout::kBrickSlots + i].*component);
        }
      }
    }
    copyShown(all.data(), snapshot_);
    snapshot_.nodes = rig_.nodes;
    snapshot_.spring_cut = rig_.spring_cut;
    snapshot_.cut_revision = rig_.revision;
  }
  void followBoth() {
    rig_.upload();
    rig_.surface.split(rig_.state());
    rig_.follow();
    takeSnapshot();
    mirror_.upload(snapshot_);
    mirrored_.split(mirror_.view());
    mirrored_.follow(mirror_.view());
  }
  void expectSameSkin() {
    EXPECT_EQ(mirrored_.positions().read(), rig_.surface.positions().read());
    EXPECT_EQ(mirrored_.normals().read(), rig_.surface.normals().read());
    EXPECT_EQ(mirrored_.alive().read(), rig_.surface.alive().read());
  }
  uint32_t someNode(size_t body) {
    const std::vector<uint32_t>& slots = rig_.model.bodies[body].lattice.active_slots;
    return rig_.model.slotOffset(body) + slots[random_() % slots.size()];
  }
  void moveNode(uint32_t slot) {
    std::uniform_real_distribution<float> step_m(-0.002f, 0.002f);
    layout::vec4& u = rig_.displacement_m[slot];
    u = {u.x + step_m(random_), u.y + step_m(random_), u.z + step_m(random_), 0};
  }
  /// Cuts a spring from both ends, as a blade does.
  void cutASpringOf(size_t body) {
    const uint32_t first = rig_.model.slotOffset(body), slot = someNode(body);
    for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
      const int64_t other = rig_.model.bodies[body].lattice.neighborSlot(slot - first, s);
      if (other < 0) continue;
      for (auto [node, spring] : {std::pair{slot, s}, {first + static_cast<uint32_t>(other), oppositeSpring(s)}}) {
        setSpringCount(rig_.nodes[node], spring, 0);
        rig_.nodes[node].lo |= layout::kSeveredBit;
      }
    }
    ++rig_.revision;
  }

  gpu::Context context_;
  SurfaceRig rig_;
  StateMirror mirror_;
  Surface mirrored_;
  StateSnapshot snapshot_;
  std::mt19937 random_{7};
};

TEST_F(StateMirrorTest, ShowsTheSkinOfTheStateToTheBitWhereverNodesMoveAndSpringsAreCut) {
  followBoth();
  expectSameSkin();
  rig_.moveNodes([](const Vector3d& x) { return Vector3d(1.1 * x.x() + 0.2 * x.y() * x.y(), x.y() - x.z(), x.z()); });
  followBoth();
  expectSameSkin();
  for (int round = 0; round < 200; ++round) {
    for (int n = 0; n < 2; ++n) moveNode(someNode(random_() % 2));
    if (round % 40 == 0) cutASpringOf(random_() % 2);
    followBoth();
    expectSameSkin();
    ASSERT_FALSE(HasFailure()) << "round " << round;
  }
}

TEST_F(StateMirrorTest, StateThatStandsStillIsNeitherUploadedNorMappedAgain) {
  rig_.moveNodes([](const Vector3d& x) { return Vector3d(1.1 * x); });
  followBoth();
  const uint64_t moved = mirror_.movedBricks(), mappings = mirrored_.mappings();
  EXPECT_EQ(moved, mirror_.shownBricks().size());
  followBoth();
  EXPECT_EQ(mirror_.movedBricks(), moved);
  EXPECT_EQ(mirrored_.mappings(), mappings);
  moveNode(rig_.model.bodies[0].skin.bound_slots[0]);
  followBoth();
  EXPECT_EQ(mirror_.movedBricks(), moved + 1);
  EXPECT_EQ(mirrored_.mappings(), mappings + 1);
}

TEST_F(StateMirrorTest, OnlyVerticesNearAMovedBrickAreMappedAgain) {
  followBoth();
  const float nothing = std::numeric_limits<float>::quiet_NaN();
  glClearNamedBufferData(mirrored_.positions().id(), GL_R32F, GL_RED, GL_FLOAT, &nothing);
  moveNode(rig_.model.bodies[0].skin.bound_slots[0]);
  followBoth();
  const std::vector<float> positions = mirrored_.positions().read();
  const size_t first_of_other = rig_.model.bodies[0].skin.bindings.size();
  size_t mapped = 0, mapped_of_other = 0;
  for (size_t v = 0; v < mirrored_.vertices(); ++v) {
    if (std::isnan(positions[3 * v])) continue;
    ++mapped;
    mapped_of_other += v >= first_of_other;
  }
  EXPECT_GT(mapped, 0u);
  EXPECT_LT(mapped, first_of_other);  // the node is on the ball's lowest side: nothing depends on it two bricks up
  EXPECT_EQ(mapped_of_other, 0u);
}

/// Networks of many bricks, in the order of a space-filling curve: triangles connect nodes of any two of them.
class NetworkMirrorTest : public StateMirrorTest {
 protected:
  NetworkMirrorTest() : StateMirrorTest(mixed()) {}

  static std::vector<Body> mixed() {
    std::vector<Body> out = balls();
    out[1] = withNetworkSkin(test::clothBody(30, 31, kStateMirrorSpacing_m));
    out.push_back(withNetworkSkin(test::clothBody(12, 9, kStateMirrorSpacing_m)));
    return out;
  }
  size_t firstVertex(size_t body) const {
    size_t first = 0;
    for (size_t b = 0; b < body; ++b) {
      const Skin& skin = rig_.model.bodies[b].skin;
      first += skin.bindings.size() + 2 * skin.split_edges.size();
    }
    return first;
  }
};

TEST_F(NetworkMirrorTest, ShowsTheSkinOfTheStateToTheBitWhereverNodesMoveAndSpringsAreCut) {
  followBoth();
  expectSameSkin();
  for (int round = 0; round < 120; ++round) {
    for (size_t body = 0; body < 3; ++body) moveNode(someNode(body));
    if (round % 10 == 5) {
      const size_t body = 1 + random_() % 2;
      cutThrough(rig_, body, [&](const Vector3d& x) { return x.y() - 0.1 + 0.002 * round + 0.001 * x.x(); });
      ++rig_.revision;
    }
    followBoth();
    expectSameSkin();
    ASSERT_FALSE(HasFailure()) << "round " << round;
  }
}

TEST_F(NetworkMirrorTest, NormalFollowsANeighborInABrickThatIsNotBesideItsOwn) {
  followBoth();
  const Body& cloth = rig_.model.bodies[1];
  size_t followed = 0;
  for (const Corners& t : cloth.skin.mesh.triangles) {
    const uint32_t near = cloth.skin.bound_slots[t[0]], far = cloth.skin.bound_slots[t[1]];
    if (near / layout::kBrickSlots == far / layout::kBrickSlots) continue;
    const uint32_t before = mirrored_.normals().read()[firstVertex(1) + t[0]];
    rig_.displacement_m[rig_.model.slotOffset(1) + far].z += 0.004f;
    followBoth();
    ASSERT_NE(mirrored_.normals().read()[firstVertex(1) + t[0]], before);
    if (++followed == 20) break;
  }
  EXPECT_EQ(followed, 20u);
}

TEST_F(NetworkMirrorTest, OnlyVerticesNearAMovedNodeAreMappedAgain) {
  followBoth();
  const float nothing = std::numeric_limits<float>::quiet_NaN();
  glClearNamedBufferData(mirrored_.positions().id(), GL_R32F, GL_RED, GL_FLOAT, &nothing);
  moveNode(rig_.model.slotOffset(1));
  followBoth();
  const std::vector<float> positions = mirrored_.positions().read();
  size_t mapped = 0, mapped_of_others = 0;
  for (size_t v = 0; v < mirrored_.vertices(); ++v) {
    if (std::isnan(positions[3 * v])) continue;
    ++mapped;
    mapped_of_others += v < firstVertex(1) || v >= firstVertex(2);
  }
  EXPECT_GT(mapped, 0u);
  EXPECT_LT(mapped, 3 * layout::kBrickSlots);  // its brick, and the adjacent nodes
  EXPECT_EQ(mapped_of_others, 0u);
}

TEST_F(StateMirrorTest, BricksDeepInsideAreNotAskedFor) {
  const auto block = [](int cells) {
    const double size_m = cells * kStateMirrorSpacing_m;
    return makeBody(blockSolid(Vector3i::Constant(cells), kStateMirrorSpacing_m),
                    boxMesh({0, 0, 0}, Vector3d::Constant(size_m), cells));
  };
  std::vector<Body> bodies;
  bodies.push_back(block(31));  // 8 bricks per edge; the surface mesh, and adjacent nodes, are in the outermost
  const StateMirror mirror(Model{std::move(bodies)});
  EXPECT_EQ(mirror.shownBricks().size(), 8u * 8 * 8 - 6 * 6 * 6);
}

}  // namespace
}  // namespace viscera
