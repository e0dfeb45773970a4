// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/contact/collision_pass.h"
#include "support/collisions.h"
#include "support/networks.h"
#include "support/random_state.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kCollisionSearchSpacing_m = 0.01;
// Positions are float32 sums of numbers up to 1 m; pairs this close to their contact distance may be found or not.
constexpr double kTolerance_m = 5e-7;

Scene collisionSearchCollidingScene(const Model& model) {
  Scene scene = sceneFor(model, 1);
  scene.collision.enabled = true;
  return scene;
}

/// Returns a state with the nodes of all bodies anywhere in a cube.
HostState cloudState(const Model& model, double cube_m, uint32_t seed) {
  std::mt19937 random(seed);
  HostState state = restState(model);
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    for (const uint32_t slot : model.bodies[b].lattice.active_slots) {
      const Vector3d x = randomVector(random, 0.5 * cube_m);
      state.displacement_m[model.slotOffset(b) + slot] = vec4(x - restPosition(model.bodies[b], slot));
    }
  }
  return state;
}

/// Returns a sheet rolled up along y, in as many layers as needed, `gap_m` apart.
HostState rolledState(const Model& model, double radius_m, double gap_m) {
  HostState state = restState(model);
  const Body& cloth = model.bodies[0];
  for (const uint32_t slot : cloth.lattice.active_slots) {
    const Vector3d rest = restPosition(cloth, slot);
    const double angle = rest.x() / radius_m, r = radius_m + gap_m * angle / 6.28;
    state.displacement_m[slot] = vec4(Vector3d(r * std::sin(angle), rest.y(), r * std::cos(angle)) - rest);
  }
  return state;
}

class Search : public OnBackend {
 protected:
  Recall recall(const Model& model, const Scene& scene, const HostState& state) const {
    return recallOf(pairsOf(GetParam(), model, scene, state), referencePairs(model, scene, state, 2 * kTolerance_m),
                    kTolerance_m);
  }
  void expectComplete(const Model& model, const HostState& state, size_t least_pairs) const {
    const Recall recall = this->recall(model, collisionSearchCollidingScene(model), state);
    EXPECT_GE(recall.there, least_pairs);
    EXPECT_EQ(recall.found, recall.there);
    EXPECT_EQ(recall.wrong, 0u);
  }
};

INSTANTIATE_TEST_SUITE_P(Backends, Search, ::testing::ValuesIn(backendKinds()), backendSuffix);

}  // namespace

TEST_P(Search, FindsEveryPairOfRandomCloudsOfRisingDensity) {
  const Model model =
      modelOf({boxBody({7, 7, 7}, kCollisionSearchSpacing_m), clothBody(20, 15, kCollisionSearchSpacing_m)});
  for (const double cube_m : {1.0, 0.3, 0.1, 0.06, 0.03}) {
    for (const uint32_t seed : {1u, 2u}) {
      SCOPED_TRACE(cube_m);
      expectComplete(model, cloudState(model, cube_m, seed), cube_m < 0.2 ? 100 : 0);
    }
  }
}

TEST_P(Search, FindsEveryPairOfAClothRolledUpTightly) {
  const Model model = modelOf({clothBody(12, 60, kCollisionSearchSpacing_m)});
  for (const double gap_m : {0.9 * kCollisionSearchSpacing_m, 0.3 * kCollisionSearchSpacing_m}) {
    SCOPED_TRACE(gap_m);
    expectComplete(model, rolledState(model, 0.03, gap_m), 400);
  }
}

TEST_P(Search, FindsNothingAtRest) {
  const Model model =
      modelOf({boxBody({5, 5, 5}, kCollisionSearchSpacing_m), clothBody(9, 9, kCollisionSearchSpacing_m)});
  HostState state = restState(model);
  for (const uint32_t slot : model.bodies[1].lattice.active_slots) {
    state.displacement_m[model.slotOffset(1) + slot] = vec4(Vector3d(0, 0, 0.2));
  }
  EXPECT_TRUE(pairsOf(GetParam(), model, collisionSearchCollidingScene(model), state).empty());
}

TEST_P(Search, NodesInsideALatticeJoinInOnceTheyAreCutAndLoneNodesNever) {
  const Model model = modelOf({boxBody({4, 4, 4}, kCollisionSearchSpacing_m), chainBody(2, kCollisionSearchSpacing_m)});
  const uint32_t inside = static_cast<uint32_t>(model.bodies[0].lattice.slotAt({2, 2, 2}));
  const uint32_t far = model.slotOffset(1) + model.bodies[1].lattice.active_slots[0];
  HostState state = restState(model);
  const Vector3d there = restPosition(model.bodies[0], inside);
  for (const uint32_t slot : model.bodies[1].lattice.active_slots) {
    const bool visitor = model.slotOffset(1) + slot == far;
    state.displacement_m[model.slotOffset(1) + slot] = vec4(
        visitor ? Vector3d(there + Vector3d(0.001, 0, 0) - restPosition(model.bodies[1], slot)) : Vector3d(1, 0, 0));
  }
  const Scene scene = collisionSearchCollidingScene(model);
  const CollisionPair pair = {inside, far};
  const auto isFound = [&] {
    const std::vector<CollisionPair> found = pairsOf(GetParam(), model, scene, state);
    return std::find(found.begin(), found.end(), pair) != found.end();
  };
  EXPECT_FALSE(isFound());
  state.nodes[inside].lo |= layout::kSeveredBit;
  EXPECT_TRUE(isFound());
  state.nodes[inside].lo &= ~layout::kAxialMask;
  state.nodes[inside].hi &= ~layout::kDiagonalMask;
  EXPECT_FALSE(isFound());
}

TEST_P(Search, PassesOverNodesThatAreNowhere) {
  const Model model = modelOf({clothBody(8, 8, kCollisionSearchSpacing_m)});
  HostState state = cloudState(model, 0.05, 3);
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  for (const auto& [node, value] : {std::pair{3u, nan}, {4u, inf}, {5u, -inf}, {6u, 1e30f}}) {
    state.displacement_m[model.bodies[0].lattice.active_slots[node]].y = value;
  }
  const Recall recall = this->recall(model, collisionSearchCollidingScene(model), state);
  EXPECT_GT(recall.there, 40u);
  EXPECT_EQ(recall.found, recall.there);
}

TEST(SearchOnBothBackends, GivesTheSamePairsForEverySizeOfWorkGroup) {
  const gpu::Context context;
  const Model model =
      modelOf({boxBody({6, 6, 6}, kCollisionSearchSpacing_m), clothBody(20, 15, kCollisionSearchSpacing_m)});
  const HostState state = cloudState(model, 0.08, 4);
  const Scene scene = collisionSearchCollidingScene(model);
  const std::vector<CollisionPair> pairs = pairsOf("gpu", model, scene, state, 32);
  EXPECT_GT(pairs.size(), 100u);
  EXPECT_EQ(pairsOf("gpu", model, scene, state, 256), pairs);
  EXPECT_EQ(pairsOf("cpu", model, scene, state), pairs);
}

/// A body collapsed into one point, another one at rest, and a sheet next to it.
TEST(SearchOnBothBackends, PassesOverACrowdAndSeesEverybodyElse) {
  const gpu::Context context;
  const int edge = 70;  // 4900 nodes
  ASSERT_GT(static_cast<uint32_t>(edge * edge), kMostInBucket);
  const Model model = modelOf({clothBody(edge, edge, kCollisionSearchSpacing_m),
                               clothBody(9, 9, kCollisionSearchSpacing_m), clothBody(9, 9, kCollisionSearchSpacing_m)});
  const Scene scene = collisionSearchCollidingScene(model);
  const FeatureSet features = featuresOf(model, scene, 1);
  LatticeBuffers buffers(model, bodyParams(model, safeTimeStep(model)), features);
  const EnvironmentPass pass(model, scene, features, buffers);
  CpuLattice lattice(model, bodyParams(model, safeTimeStep(model)), features);
  const Serial serial;
  CpuEnvironment on_cpu(model, scene, lattice, serial);
  size_t compared = 0;
  for (const bool collapsed : {false, true}) {
    HostState state = restState(model);
    for (const uint32_t slot : model.bodies[0].lattice.active_slots) {
      const Vector3d there(5.001, 5.001, 5.001);
      state.displacement_m[slot] = collapsed ? vec4(there - restPosition(model.bodies[0], slot)) : vec4(there);
    }
    for (const uint32_t slot : model.bodies[2].lattice.active_slots)
      state.displacement_m[model.slotOffset(2) + slot] = vec4(Vector3d(0, 0, 0.2 * kCollisionSearchSpacing_m));
    buffers.state.displacement[buffers.state.current].write(state.displacement_m);
    const std::vector<CollisionPair> pairs = pass.findPairs(buffers);
    EXPECT_GE(pairs.size(), 81u) << "the two sheets that lie on each other";
    for (const CollisionPair& pair : pairs) EXPECT_GE(pair[0], model.slotOffset(1));
    pass.recordCrowded(buffers.stats);
    EXPECT_EQ(buffers.stats.read()[0].crowded, collapsed ? model.bodies[0].lattice.active_slots.size() : 0);
    lattice.write(state);
    EXPECT_EQ(on_cpu.findPairs(lattice), pairs);
    EXPECT_EQ(on_cpu.crowded(), buffers.stats.read()[0].crowded);
    if (collapsed) {
      EXPECT_LE(on_cpu.compared(), compared) << "it costs no more than where nodes lie apart";
    }
    compared = on_cpu.compared();
  }
}
