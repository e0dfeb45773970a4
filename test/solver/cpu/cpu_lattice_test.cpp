// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/state/cpu_lattice.h"

#include "solver/tissue/joined_lattice.h"
#include "support/features.h"
#include "support/implicit.h"
#include "support/random_state.h"

using namespace viscera;
using namespace viscera::test;

namespace {

CpuLattice latticeOf(const Model& model, bool tools = false) {
  return CpuLattice(model, bodyParams(model, safeTimeStep(model)), featuresFor(model, tools));
}

Model twoBodies() {
  Body box = boxBody({5, 4, 3}, 0.01), blob = blobBody(63, 0.02, 3);
  box.lattice.nodes[box.lattice.active_slots[7]].lo |= layout::kFixedBit;
  return modelOf({box, blob});
}

/// Returns the stiffness of any spring as the kernels find it: odd ones at their far end.
float stiffness(const CpuLattice& lattice, const ReferenceLattice& reference, uint32_t slot, uint32_t spring) {
  const uint32_t owner = spring % 2 ? reference.farEnd(slot, spring) : slot;
  return lattice.strengths.stiffness[stiffnessAt(owner, spring / 2)];
}

void expectSameStrengths(const Model& model, const CpuLattice& lattice, const ReferenceLattice& reference) {
  ASSERT_EQ(lattice.store.active, reference.active);
  std::vector<float> whole_bulk_j(model.slots());
  if (!lattice.strengths.bulk.empty()) whole_bulk_j = allStrengths(model).bulk_j;
  for (uint32_t slot : reference.active) {
    ASSERT_FLOAT_EQ(lattice.strengths.mass[slot], static_cast<float>(reference.mass(slot)));
    const float bulk_j = lattice.strengths.bulk.empty() ? 0 : lattice.strengths.bulk[slot];
    ASSERT_FLOAT_EQ(bulk_j, reference.nodes[slot].lo & layout::kCellBit ? whole_bulk_j[slot] : 0);
    for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
      const float expected = static_cast<float>(reference.stiffness(slot, s));
      if (expected == 0 && s % 2) continue;  // never read
      ASSERT_FLOAT_EQ(stiffness(lattice, reference, slot, s), expected) << slot << " " << s;
    }
  }
}

bool sameBits(const layout::vec4& a, const layout::vec4& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w;
}

}  // namespace

TEST(CpuLattice, GivesBackTheStateThatWasWritten) {
  const Model model = twoBodies();
  CpuLattice lattice = latticeOf(model);
  const HostState written = randomState(model, 1e-3, 0.5, 3);
  lattice.write(written);
  const HostState read = lattice.read();
  ASSERT_EQ(read.nodes.size(), model.slots());
  for (size_t slot = 0; slot < model.slots(); ++slot) {
    EXPECT_TRUE(sameBits(read.displacement_m[slot], written.displacement_m[slot])) << slot;
    EXPECT_TRUE(sameBits(read.velocity_m_per_s[slot], written.velocity_m_per_s[slot])) << slot;
    EXPECT_EQ(read.nodes[slot].lo, written.nodes[slot].lo);
    EXPECT_EQ(read.nodes[slot].hi, written.nodes[slot].hi);
  }
}

TEST(CpuLattice, HasVectorsOneComponentAfterTheOtherBrickByBrick) {
  const Model model = twoBodies();
  CpuLattice lattice = latticeOf(model);
  const HostState state = randomState(model, 1e-3, 0.5, 3);
  lattice.write(state);
  for (uint32_t slot : lattice.store.active) {
    const size_t first = slot / 64 * 192 + slot % 64;
    EXPECT_EQ(lattice.state.displacement[0][first], state.displacement_m[slot].x);
    EXPECT_EQ(lattice.state.displacement[0][first + 64], state.displacement_m[slot].y);
    EXPECT_EQ(lattice.state.velocity[0][first + 128], state.velocity_m_per_s[slot].z);
  }
}

TEST(CpuLattice, HasTheStrengthsOfCellsOfPartsAndOfOtherBodies) {
  const Body rubber = ofLaw(boxBody({3, 4, 5}, 0.01), 0.45);
  for (const Model& model : {twoBodies(), modelOf({rubber, twoPartBody()})}) {
    expectSameStrengths(model, latticeOf(model), ReferenceLattice(model));
  }
}

TEST(CpuLattice, HasNoBulkWithoutALawAndNoRoomForStylusesThatAreNot) {
  CpuLattice lattice = latticeOf(twoBodies());
  EXPECT_TRUE(lattice.strengths.bulk.empty());
  EXPECT_TRUE(lattice.tools.grab_offsets.empty() && lattice.tools.impulses.empty() && lattice.tools.touched.empty());
  EXPECT_EQ(latticeOf(twoBodies(), true).tools.impulses.size(), 2 * lattice.slotCount());
}

TEST(CpuLattice, KnowsTheNodesOfEveryBrick) {
  const CpuLattice lattice = latticeOf(twoBodies());
  ASSERT_EQ(lattice.store.first_active.size(), lattice.brickCount() + 1);
  EXPECT_EQ(lattice.store.first_active.back(), lattice.store.active.size());
  for (uint32_t b = 0; b < lattice.brickCount(); ++b) {
    for (uint32_t i = lattice.store.first_active[b]; i < lattice.store.first_active[b + 1]; ++i)
      EXPECT_EQ(lattice.store.active[i] / layout::kBrickSlots, b);
  }
}

TEST(CpuLattice, GivesACutSpringNoStiffnessFromBothEnds) {
  for (const bool parts : {false, true}) {
    const Model model = modelOf({parts ? twoPartBody() : boxBody({5, 4, 4}, 0.01)});
    CpuLattice lattice = latticeOf(model);
    ReferenceLattice reference(model);
    const uint32_t slot = static_cast<uint32_t>(model.bodies[0].lattice.slotAt({2, 2, 2}));  // a free node inside
    uint32_t cut = 0;
    for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
      if (reference.stiffness(slot, s) == 0) continue;
      ++cut;
      const uint32_t other = reference.farEnd(slot, s);
      EXPECT_GT(stiffness(lattice, reference, slot, s), 0);
      reference.eraseSpring(slot, s);
      for (uint32_t end : {slot, other}) {
        lattice.store.nodes[end] = reference.nodes[end];
        lattice.refresh(end);
      }
      EXPECT_EQ(stiffness(lattice, reference, slot, s), 0);
      EXPECT_EQ(stiffness(lattice, reference, other, oppositeSpring(s)), 0);
    }
    EXPECT_GT(cut, 0u);
    for (uint32_t other : lattice.store.active) {  // the cells that were torn
      lattice.store.nodes[other] = reference.nodes[other];
      lattice.refresh(other);
    }
    expectSameStrengths(model, lattice, reference);
    EXPECT_EQ(lattice.strengths.mobility[slot], 0);  // isolated now
    lattice.reset();
    expectSameStrengths(model, lattice, ReferenceLattice(model));
    EXPECT_FLOAT_EQ(lattice.strengths.mobility[slot], 1 / lattice.strengths.mass[slot]);
  }
}

TEST(CpuLattice, LetsAllButFixedNodesMove) {
  const Model model = twoBodies();
  CpuLattice lattice = latticeOf(model, true);
  const uint32_t fixed = lattice.store.active[7], held = lattice.store.active[8];
  lattice.store.nodes[held].lo |= 1u << layout::kGrabShift;
  lattice.refresh(held);
  size_t mobile = 0;
  for (uint32_t slot = 0; slot < lattice.slotCount(); ++slot) mobile += lattice.strengths.mobility[slot] > 0;
  EXPECT_EQ(mobile, lattice.store.active.size() - 1);
  EXPECT_EQ(lattice.strengths.mobility[fixed], 0);
  EXPECT_GT(lattice.strengths.mobility[held], 0);  // its stylus prescribes its motion, but forces on it count
}

TEST(CpuLattice, IsAtRestAfterReset) {
  const Model model = twoBodies();
  CpuLattice lattice = latticeOf(model, true);
  lattice.write(randomState(model, 1e-3, 0.5, 3));
  lattice.swap();
  lattice.tools.impulses[5] = {1, 2, 3, 4};
  lattice.tools.touched[0] = 1;
  lattice.reset();
  const HostState rest = restState(model), state = lattice.read();
  for (size_t slot = 0; slot < model.slots(); ++slot) {
    EXPECT_TRUE(sameBits(state.displacement_m[slot], {}) && sameBits(state.velocity_m_per_s[slot], {}));
    EXPECT_EQ(state.nodes[slot].lo, rest.nodes[slot].lo);
  }
  EXPECT_EQ(lattice.tools.impulses[5].w, 0);
  EXPECT_EQ(lattice.tools.touched[0], 0);
}

TEST(CpuLattice, StoreAndStrengthsStandWithoutAState) {
  const Model model = twoBodies();
  const CpuLattice lattice = latticeOf(model);
  CpuStore store(model, bodyParams(model, safeTimeStep(model)));
  CpuStrengths strengths(model, store, featuresFor(model, false), {});
  EXPECT_EQ(strengths.stiffness, lattice.strengths.stiffness);
  EXPECT_EQ(strengths.mobility, lattice.strengths.mobility);
  const uint32_t slot = store.active[20];
  store.nodes[slot].lo |= layout::kFixedBit;
  strengths.refresh(store, slot);
  EXPECT_GT(lattice.strengths.mobility[slot], 0);
  EXPECT_EQ(strengths.mobility[slot], 0);
}
