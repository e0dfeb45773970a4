// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/body/network_skin.h"

#include <gtest/gtest.h>

#include <set>

#include "support/networks.h"

namespace viscera {
namespace {

using test::clothBody;

constexpr double kSpacing_m = 0.01;

/// Returns two triangles 0 1 2 and 1 3 2 with all five edges; node 4 is apart.
SpringNetwork twoTriangles() {
  SpringNetwork network;
  network.positions_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {9, 9, 9}};
  network.masses_kg.assign(5, 1);
  network.triangles = {{0, 1, 2}, {1, 3, 2}};
  for (const auto& [a, b] : std::set<std::pair<uint32_t, uint32_t>>{{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}}) {
    network.springs.push_back({a, b, 1, 1});
  }
  return network;
}

TEST(NetworkSkin, HasAVertexPerNodeOfTheSurfaceInTheOrderOfSlots) {
  const Body cloth = clothBody(9, 12, kSpacing_m);
  const Skin skin = bindNetworkSkin(*cloth.network, false);
  ASSERT_EQ(skin.bindings.size(), 9u * 12);
  ASSERT_EQ(skin.mesh.triangles.size(), cloth.network->triangles.size());
  EXPECT_EQ(skin.bound_slots, cloth.lattice.active_slots);
  for (size_t v = 0; v < skin.bindings.size(); ++v) {
    const layout::SkinBinding& binding = skin.bindings[v];
    EXPECT_EQ(binding.slot0, skin.bound_slots[v]);
    EXPECT_EQ(binding.springs, layout::kOneToOneBit);
    EXPECT_EQ(binding.weights.x, 1);
    EXPECT_EQ(binding.normal_constant.z, 1);
    EXPECT_EQ(skin.mesh.positions_m[v], cloth.network->positions_m[binding.slot0].cast<float>());
  }
  for (size_t t = 0; t < skin.mesh.triangles.size(); ++t) {
    for (size_t i = 0; i < 3; ++i)
      EXPECT_EQ(skin.bound_slots[skin.mesh.triangles[t][i]], cloth.network->triangles[t][i]);
  }
}

TEST(NetworkSkin, LeavesOutNodesBeneathTheSurface) {
  const Skin skin = bindNetworkSkin(twoTriangles(), true);
  EXPECT_EQ(skin.bound_slots, (std::vector<uint32_t>{0, 1, 2, 3}));
}

TEST(NetworkSkin, IsEmptyWhereTheNetworkHasNoSurface) {
  const Body graph = test::graphBody(100, 200, 3);
  const Skin skin = bindNetworkSkin(*graph.network, true);
  EXPECT_TRUE(skin.bindings.empty());
  EXPECT_TRUE(skin.split_edges.empty());
  EXPECT_FALSE(skin.two_sided);
}

TEST(NetworkSkin, OfASheetHasTwoSidesOfABallOne) {
  EXPECT_TRUE(bindNetworkSkin(*clothBody(4, 4, kSpacing_m).network, false).two_sided);
  const SpringNetwork ball = membraneNetwork(ballMesh(0.02, 0.005), MaterialConfig{}, 1e-3);
  EXPECT_FALSE(bindNetworkSkin(renumbered(ball), false).two_sided);
}

TEST(NetworkSkin, SplitsNothingThatCannotBeCut) {
  const Skin skin = bindNetworkSkin(twoTriangles(), false);
  EXPECT_TRUE(skin.split_edges.empty());
  EXPECT_TRUE(skin.triangle_edges.empty());
}

TEST(NetworkSkin, EveryEdgeOfAClothIsASpringThatSplitsOnce) {
  const SpringNetwork network = *clothBody(9, 12, kSpacing_m, 0.1).network;  // bending springs are no edges
  const Skin skin = bindNetworkSkin(network, true);
  std::set<uint32_t> springs;
  for (const SplitEdge& edge : skin.split_edges) {
    EXPECT_EQ(network.springs[edge.spring].a, skin.bound_slots[edge.a]);
    EXPECT_EQ(network.springs[edge.spring].b, skin.bound_slots[edge.b]);
    EXPECT_TRUE(springs.insert(edge.spring).second);
  }
  const size_t faces = network.triangles.size(), vertices = 9 * 12;
  EXPECT_EQ(skin.split_edges.size(), vertices + faces - 1);  // Euler's formula
  ASSERT_EQ(skin.triangle_edges.size(), faces);
  for (size_t t = 0; t < faces; ++t) {
    for (size_t i = 0; i < 3; ++i) {
      const uint32_t from = skin.mesh.triangles[t][i], to = skin.mesh.triangles[t][(i + 1) % 3];
      const SplitEdge& edge = skin.split_edges.at(skin.triangle_edges[t][i]);
      EXPECT_EQ(edge.a, std::min(from, to));
      EXPECT_EQ(edge.b, std::max(from, to));
    }
  }
}

TEST(NetworkSkin, EdgeWithoutASpringNeverSplits) {
  SpringNetwork network = twoTriangles();
  network.springs.erase(network.springs.begin() + 2);  // 1-2, an edge of both triangles
  const Skin skin = bindNetworkSkin(network, true);
  EXPECT_EQ(skin.split_edges.size(), 4u);
  EXPECT_EQ(skin.triangle_edges[0][1], kNoSplitEdge);
  EXPECT_EQ(skin.triangle_edges[1][2], kNoSplitEdge);
}

TEST(NetworkSkin, FirstOfTwoSpringsStandsForTheirEdge) {
  SpringNetwork network = twoTriangles();
  network.springs.insert(network.springs.begin() + 1, network.springs[0]);
  const Skin skin = bindNetworkSkin(network, true);
  EXPECT_EQ(skin.split_edges.size(), 5u);
  EXPECT_EQ(skin.split_edges[skin.triangle_edges[0][0]].spring, 0u);
}

}  // namespace
}  // namespace viscera
