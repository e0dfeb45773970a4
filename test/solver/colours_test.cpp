// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/colours.h"

#include <gtest/gtest.h>

#include "solver/joined_lattice.h"
#include "support/lattices.h"
#include "support/networks.h"

using namespace viscera;
using namespace viscera::test;

TEST(VbdColours, NoSpringAndNoCellJoinsTwoNodesOfOne) {
  const Body body = boxBody({5, 6, 7}, 0.01);
  const Lattice& lattice = body.lattice;
  for (uint32_t slot : lattice.active_slots) {
    EXPECT_LT(colourOf(slot, false), colourCount(false));
    EXPECT_LT(colourOf(slot, true), colourCount(true));
    for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
      const int64_t other = lattice.neighborSlot(slot, s);
      if (other < 0) continue;
      EXPECT_NE(colourOf(slot, false), colourOf(static_cast<uint32_t>(other), false));
    }
    for (int corner = 0; corner < 27; ++corner) {
      const Vector3i offset(corner % 3 - 1, corner / 3 % 3 - 1, corner / 9 - 1);
      const int64_t other = lattice.slotAt(lattice.nodeAt(slot) + offset);
      if (other < 0 || other == slot) continue;
      EXPECT_NE(colourOf(slot, true), colourOf(static_cast<uint32_t>(other), true));
    }
  }
}

TEST(VbdColours, NoLinkJoinsTwoNodesOfOneAndEveryNodeHasOne) {
  for (const bool volume : {false, true}) {
    const Model model = modelOf({graphBody(300, 2000, 5), boxBody({3, 4, 5}, 0.01)});
    const JoinedNetwork network = joinNetworks(model);
    const std::vector<uint32_t> active = activeSlots(model);
    const Coloured coloured = byColour(active, volume, network);
    std::vector<uint32_t> colour(model.slots(), UINT32_MAX);
    uint32_t next = 0;
    for (uint32_t c = 0; c < coloured.colours.size(); ++c) {
      EXPECT_EQ(coloured.colours[c].first, next);
      for (uint32_t i = 0; i < coloured.colours[c].count; ++i) colour[coloured.slots[next++]] = c;
    }
    ASSERT_EQ(next, active.size());
    for (uint32_t slot : active) EXPECT_NE(colour[slot], UINT32_MAX);
    for (const layout::SpringEnds& ends : network.springs) EXPECT_NE(colour[ends.a], colour[ends.b]);
  }
}
