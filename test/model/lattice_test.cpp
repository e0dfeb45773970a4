// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/body/lattice.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <set>

#include "support/text.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

using Filled = std::function<bool(const Vector3i& cell)>;

Solid solidOf(const Vector3i& cells, const Filled& filled) {
  Solid solid;
  solid.spacing_m = 0.5;
  solid.origin_m = Vector3d(1, 2, 3);
  solid.cells = cells;
  solid.part_names = {"tissue"};
  solid.labels.assign(static_cast<size_t>(cells.prod()), 0);
  for (int z = 0; z < cells.z(); ++z)
    for (int y = 0; y < cells.y(); ++y)
      for (int x = 0; x < cells.x(); ++x) solid.labels[solid.index(x, y, z)] = filled({x, y, z}) ? 1 : 0;
  return solid;
}

Solid block(const Vector3i& cells) {
  return solidOf(cells, [](const Vector3i&) { return true; });
}

/// Returns a random half of the cells: hollows, bridges of one node, loose pieces; more than one brick along every
/// axis.
Solid sponge() {
  std::mt19937 random(1);
  return solidOf({9, 10, 11}, [&](const Vector3i&) { return random() % 2 == 0; });
}

/// Returns a box with walls one cell thick.
Solid hollow(int edge) {
  return solidOf(Vector3i::Constant(edge),
                 [edge](const Vector3i& c) { return (c.array() == 0).any() || (c.array() == edge - 1).any(); });
}

/// Sums of counts over all ends of springs.
struct Totals {
  uint32_t axial_quarters = 0, diagonal_halves = 0, mass_eighths = 0;
};
Totals totals(const Lattice& lattice) {
  Totals out;
  for (uint32_t slot : lattice.active_slots) {
    const layout::NodeBits& bits = lattice.nodes[slot];
    for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s)
      (isAxial(s) ? out.axial_quarters : out.diagonal_halves) += springCount(bits, s);
    out.mass_eighths += massEighths(bits);
  }
  return out;
}

Vector3i offset(uint32_t spring) {
  const auto& o = kNeighborOffsets[spring];
  return {o[0], o[1], o[2]};
}

/// Calls visit(slot, spring) for every end of every spring that exists.
template <class Visit>
void forEachEnd(const Lattice& lattice, Visit visit) {
  for (uint32_t slot : lattice.active_slots)
    for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s)
      if (springCount(lattice.nodes[slot], s)) visit(slot, s);
}

TEST(Lattice, OneCellGivesTwelveQuarterEdgesTwelveHalfDiagonalsAndAnEighthOfItsMassToEachNode) {
  const Lattice lattice = buildLattice(block({1, 1, 1}), Weights::kCell);
  EXPECT_EQ(lattice.active_slots.size(), 8u);
  EXPECT_EQ(lattice.springs(), 24u);
  EXPECT_EQ(totals(lattice).axial_quarters, 2u * 12);
  EXPECT_EQ(totals(lattice).diagonal_halves, 2u * 12);
  for (uint32_t slot : lattice.active_slots) EXPECT_EQ(massEighths(lattice.nodes[slot]), 1u);
}

TEST(Lattice, NodeInTheBulkHasFullSpringsAndFullMass) {
  const Lattice lattice = buildLattice(block({2, 2, 2}), Weights::kCell);
  const layout::NodeBits& bits = lattice.nodes.at(static_cast<size_t>(lattice.slotAt({1, 1, 1})));
  for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) EXPECT_EQ(springCount(bits, s), isAxial(s) ? 4u : 2u) << s;
  EXPECT_EQ(massEighths(bits), 8u);
}

TEST(Lattice, BlockHasTheSpringsThatCountingGives) {
  const Vector3i c(3, 5, 6), n = c.array() + 1;
  const int axial = c.x() * n.y() * n.z() + n.x() * c.y() * n.z() + n.x() * n.y() * c.z();
  const int squares = c.x() * c.y() * n.z() + c.x() * n.y() * c.z() + n.x() * c.y() * c.z();
  const Lattice lattice = buildLattice(block(c), Weights::kCell);
  EXPECT_EQ(lattice.active_slots.size(), static_cast<size_t>(n.prod()));
  EXPECT_EQ(lattice.springs(), static_cast<size_t>(axial + 2 * squares));
}

TEST(Lattice, StiffnessAndMassAreThoseOfTheCells) {
  for (const Solid& solid : {block({5, 1, 2}), sponge(), hollow(9)}) {
    const Totals sum = totals(buildLattice(solid, Weights::kCell));
    const size_t cells = solid.filledCells();
    EXPECT_EQ(sum.mass_eighths, 8 * cells);  // times rho h^3 / 8: rho times the volume
    EXPECT_EQ(sum.axial_quarters, 2 * 12 * cells);
    EXPECT_EQ(sum.diagonal_halves, 2 * 12 * cells);
  }
}

TEST(Lattice, BothEndsOfASpringAgree) {
  const Lattice lattice = buildLattice(sponge(), Weights::kCell);
  forEachEnd(lattice, [&](uint32_t slot, uint32_t spring) {
    const int64_t other = lattice.neighborSlot(slot, spring);
    ASSERT_GE(other, 0);
    const layout::NodeBits& bits = lattice.nodes[static_cast<size_t>(other)];
    EXPECT_EQ(springCount(bits, oppositeSpring(spring)), springCount(lattice.nodes[slot], spring));
    EXPECT_EQ(lattice.neighborSlot(static_cast<uint32_t>(other), oppositeSpring(spring)), slot);
  });
}

TEST(Lattice, PaperWeightsCountEverySpringAndNodeInFull) {
  const Lattice cell = buildLattice(sponge(), Weights::kCell), paper = buildLattice(sponge(), Weights::kPaper);
  EXPECT_EQ(paper.active_slots, cell.active_slots);
  EXPECT_EQ(paper.springs(), cell.springs());
  forEachEnd(paper, [&](uint32_t slot, uint32_t spring) {
    EXPECT_EQ(springCount(paper.nodes[slot], spring), isAxial(spring) ? 4u : 2u);
  });
  for (uint32_t slot : paper.active_slots) EXPECT_EQ(massEighths(paper.nodes[slot]), 8u);
}

TEST(Lattice, SlotAndCoordinatesAreInverse) {
  const Lattice lattice = buildLattice(sponge(), Weights::kCell);
  for (uint32_t slot : lattice.active_slots) {
    const Vector3i node = lattice.nodeAt(slot);
    EXPECT_EQ(lattice.slotAt(node), slot);
    EXPECT_EQ(lattice.restPosition(slot), Vector3d(1, 2, 3) + 0.5 * node.cast<double>());
  }
}

TEST(Lattice, HasNoSlotWhereThereIsNoNode) {
  const Lattice lattice = buildLattice(hollow(5), Weights::kCell);  // its cavity has room for 2 x 2 x 2 nodes
  for (const Vector3i& node : {Vector3i(-1, 0, 0), Vector3i(6, 0, 0), Vector3i(0, 0, 6), Vector3i(2, 2, 2)}) {
    EXPECT_EQ(lattice.slotAt(node), -1) << node.transpose();
  }
  EXPECT_GE(lattice.slotAt({1, 1, 1}), 0);
}

TEST(Lattice, ActiveSlotsAreThoseOfTheNodesInOrderAndLabelled) {
  const Lattice lattice = buildLattice(sponge(), Weights::kCell);
  std::vector<uint32_t> expected;
  for (uint32_t slot = 0; slot < lattice.nodes.size(); ++slot) {
    EXPECT_EQ(lattice.labels[slot], massEighths(lattice.nodes[slot]) ? 1 : 0);
    if (massEighths(lattice.nodes[slot])) expected.push_back(slot);
  }
  EXPECT_EQ(lattice.active_slots, expected);
}

TEST(Lattice, NeighboursAreFoundAcrossBricks) {
  const Lattice lattice = buildLattice(block({8, 8, 8}), Weights::kCell);
  for (uint32_t slot : lattice.active_slots) {
    for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
      const Vector3i there = lattice.nodeAt(slot) + offset(s);
      const bool inside = (there.array() >= 0).all() && (there.array() <= 8).all();
      const int64_t neighbor = lattice.neighborSlot(slot, s);
      ASSERT_EQ(neighbor >= 0, inside);
      if (neighbor >= 0) {
        EXPECT_EQ(lattice.nodeAt(static_cast<uint32_t>(neighbor)), there);
      }
    }
  }
}

/// Follows the path of the kernels: from a slot through the table of its brick.
uint32_t slotThroughTable(const Lattice& lattice, uint32_t slot, uint32_t spring) {
  const int edge = static_cast<int>(layout::kBrickEdge), local = static_cast<int>(slot % layout::kBrickSlots);
  const Vector3i at = Vector3i(local % edge, local / edge % edge, local / (edge * edge)) + offset(spring);
  const Vector3i brick = (at.array() + edge) / edge;  // 0, 1, 2: before, in, after this brick
  const Vector3i in = at.array() + edge - edge * brick.array();
  const uint32_t next = lattice.bricks[slot / layout::kBrickSlots].neighbors[brick.x() + 3 * brick.y() + 9 * brick.z()];
  return next * layout::kBrickSlots + static_cast<uint32_t>(in.x() + edge * in.y() + edge * edge * in.z());
}

TEST(Lattice, TableOfBricksLeadsToTheSameNeighbours) {
  for (const Solid& solid : {block({8, 8, 8}), sponge(), hollow(15)}) {
    const Lattice lattice = buildLattice(solid, Weights::kCell);
    forEachEnd(lattice, [&](uint32_t slot, uint32_t spring) {
      ASSERT_EQ(slotThroughTable(lattice, slot, spring), lattice.neighborSlot(slot, spring));
    });
  }
}

TEST(Lattice, BrickWithoutANeighbourNamesItself) {
  const Lattice lattice = buildLattice(block({1, 1, 1}), Weights::kCell);
  ASSERT_EQ(lattice.bricks.size(), 1u);
  for (uint32_t neighbor : lattice.bricks[0].neighbors) EXPECT_EQ(neighbor, 0u);
}

TEST(Lattice, HollowSolidHasOnlyBricksWithNodes) {
  const Lattice lattice = buildLattice(hollow(15), Weights::kCell);  // 4 bricks along each axis, 2 of them inside
  EXPECT_EQ(lattice.bricks.size(), 4u * 4 * 4 - 2 * 2 * 2);
  std::set<uint32_t> used;
  for (uint32_t slot : lattice.active_slots) used.insert(slot / layout::kBrickSlots);
  EXPECT_EQ(used.size(), lattice.bricks.size());
}

TEST(Lattice, SolidWithoutAFilledCellIsRefused) {
  const Solid nothing = solidOf({2, 2, 2}, [](const Vector3i&) { return false; });
  EXPECT_TRUE(
      test::says(test::messageOf<LatticeError>([&] { buildLattice(nothing, Weights::kCell); }), {"no filled cell"}));
}

}  // namespace
}  // namespace viscera
