// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Who owns which spring, and where its forces lie (GW 4.2).
#include "layout/edge_forces.h"
#include "solver/tissue/edge_forces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <set>

#include "solver/network_rig.h"

using namespace viscera;
using namespace viscera::test;

namespace {

using Springs = std::vector<layout::SpringEnds>;

std::vector<size_t> ownedBy(const Springs& springs, size_t slots) {
  const std::vector<uint8_t> by_b = ownedByB(springs, slots);
  std::vector<size_t> out(slots, 0);
  for (size_t s = 0; s < springs.size(); ++s) ++out[by_b[s] ? springs[s].b : springs[s].a];
  return out;
}

size_t mostOwned(const Springs& springs, size_t slots) {
  const std::vector<size_t> owned = ownedBy(springs, slots);
  return *std::max_element(owned.begin(), owned.end());
}

void addChain(uint32_t first, uint32_t last, Springs& out) {
  for (uint32_t slot = first; slot < last; ++slot) out.push_back({slot, slot + 1, 0, 0});
}

/// Every node with every other one.
void addClique(uint32_t first, uint32_t last, Springs& out) {
  for (uint32_t a = first; a <= last; ++a) {
    for (uint32_t b = a + 1; b <= last; ++b) out.push_back({a, b, 0, 0});
  }
}

std::vector<Model> models() {
  return {modelOf({clothBody(12, 9, 0.01, 0.1)}), modelOf({graphBody(300, 1500, 4)}), modelOf({graphBody(1, 0, 1)}),
          mixedModel()};
}

/// Slots of both ends of all springs, and what their links say but for places.
std::vector<layout::Link> linksInOrderOfSprings(const JoinedNetwork& network) {
  std::vector<layout::Link> out;
  for (const layout::SpringEnds& ends : network.springs) {
    for (const uint32_t link : {ends.link_a, ends.link_b}) {
      out.push_back(network.links[link]);
      out.back().lattice_spring &= layout::kLatticeSpringMask;
    }
  }
  return out;
}

}  // namespace

TEST(SpringOwnership, SharesSpringsOutEvenly) {
  const JoinedNetwork sheet = joinNetworks(modelOf({clothBody(30, 30, 0.01)}));
  EXPECT_EQ(mostOwned(sheet.springs, sheet.rest_m.size()), 3u);  // 2.9 springs per node
}

TEST(SpringOwnership, LeavesTheSpringsOfAStarToItsRays) {
  Springs star;
  for (uint32_t ray = 1; ray < 12; ++ray) star.push_back({0, ray, 0, 0});
  EXPECT_EQ(mostOwned(star, 12), 1u);
}

/// Taken in order the last ones would own nothing and the first ones more than their share.
TEST(SpringOwnership, IsHandedOnAlongAChain) {
  Springs chain;
  for (uint32_t slot = 0; slot < 50; ++slot) chain.push_back({slot, slot + 1, 0, 0});
  chain.push_back({0, 1, 0, 0});
  EXPECT_EQ(mostOwned(chain, 51), 1u);
}

TEST(SpringOwnership, IsEvenWithinAPartThatIsDenserThanTheRest) {
  Springs springs;
  addClique(0, 20, springs);  // 10 springs per node
  addChain(20, 3000, springs);
  EXPECT_EQ(mostOwned(springs, 3001), 10u);
}

TEST(SpringOwnership, OfNothingIsNothing) {
  EXPECT_TRUE(ownedByB({}, 64).empty());
  JoinedNetwork none;
  EXPECT_EQ(orderByOwner(none).places(), 0u);
}

TEST(SpringOwnership, OrdersLinksButLeavesSpringsAndLinksAsTheyAre) {
  for (const Model& model : models()) {
    const JoinedNetwork before = joinNetworks(model);
    JoinedNetwork after = before;
    const EdgeForces forces = orderByOwner(after);
    const auto expectAt = [&](uint32_t link, uint32_t slot) {
      const layout::uvec4& runs = forces.links[slot];
      EXPECT_TRUE((link >= runs.x && link < runs.y) || (link >= runs.z && link < runs.w));
    };
    const auto links = linksInOrderOfSprings(after), whole = linksInOrderOfSprings(before);
    ASSERT_EQ(links.size(), whole.size());
    EXPECT_TRUE(links.empty() || std::memcmp(links.data(), whole.data(), links.size() * sizeof links[0]) == 0);
    for (size_t s = 0; s < after.springs.size(); ++s) {
      const layout::SpringEnds &now = after.springs[s], &then = before.springs[s];
      EXPECT_EQ(now.a, then.a);
      EXPECT_EQ(now.b, then.b);
      expectAt(now.link_a, now.a);
      expectAt(now.link_b, now.b);
    }
  }
}

TEST(SpringOwnership, HasEverySpringOnceAndGivesEveryForceAPlaceOfItsOwnAtItsNode) {
  for (const Model& model : models()) {
    JoinedNetwork network = joinNetworks(model);
    const EdgeForces forces = orderByOwner(network);
    std::set<uint32_t> places, links;
    const auto expectPlaceAt = [&](uint32_t place, uint32_t slot) {
      EXPECT_GE(place, forces.starts[slot]);
      EXPECT_LT(place, forces.starts[slot + 1]);
      EXPECT_TRUE(places.insert(place).second);
    };
    for (const layout::SpringOwner& owner : forces.owners) {
      EXPECT_LT(owner.first, owner.end);
      EXPECT_EQ(owner.first, forces.links[owner.slot].x);
      EXPECT_EQ(owner.end, forces.links[owner.slot].y);
      expectPlaceAt(owner.place, owner.slot);
      for (uint32_t link = owner.first; link < owner.end; ++link) {
        links.insert(link);
        expectPlaceAt(network.links[link].lattice_spring >> layout::kForcePlaceShift, network.links[link].far);
      }
    }
    EXPECT_EQ(places.size(), forces.starts.back());  // none is left over
    EXPECT_EQ(links.size(), network.springs.size());
    for (const layout::SpringEnds& ends : network.springs) {
      EXPECT_NE(links.count(ends.link_a), links.count(ends.link_b));
    }
  }
}
