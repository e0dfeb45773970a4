// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/solver/solver.h"

#include <algorithm>

#include "solver/processes/process.h"
#include "viscera/math/error.h"
#include "viscera/math/state_hash.h"

namespace viscera {

namespace {

bool sameNodes(const std::vector<layout::NodeBits>& a, const std::vector<layout::NodeBits>& b) {
  const auto same = [](layout::NodeBits x, layout::NodeBits y) { return x.lo == y.lo && x.hi == y.hi; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

}  // namespace

void copyShown(const float* displacement_m, StateSnapshot& out) {
  out.displacement_m.resize(kBrickFloats * out.bricks.size());
  float* to = out.displacement_m.data();
  for (uint32_t brick : out.bricks) {
    to = std::copy_n(displacement_m + kBrickFloats * brick, kBrickFloats, to);
  }
}

void copyShown(const HostState& state, StateSnapshot& out) {
  out.displacement_m.clear();
  for (uint32_t brick : out.bricks) {
    const layout::vec4* const first = state.displacement_m.data() + size_t{layout::kBrickSlots} * brick;
    for (float layout::vec4::*component : {&layout::vec4::x, &layout::vec4::y, &layout::vec4::z}) {
      for (uint32_t i = 0; i < layout::kBrickSlots; ++i) out.displacement_m.push_back(first[i].*component);
    }
  }
  if (sameNodes(state.nodes, out.nodes)) return;
  static_cast<CutSprings&>(out) = state;
  ++out.cut_revision;
}

void Solver::snapshot(StateSnapshot& out) const {
  copyShown(readState(), out);
}

bool Solver::readCuts(CutState& out) const {
  HostState state = readState();
  if (sameNodes(state.nodes, out.nodes) && state.axial_cut == out.axial_cut && state.spring_cut == out.spring_cut)
    return false;
  static_cast<CutSprings&>(out) = std::move(state);
  ++out.revision;
  return true;
}

const TissueProcesses& Solver::processes() const {
  static const TissueProcesses kNone;
  return kNone;
}

const StylusPull& Solver::pull(uint32_t /*stylus*/) const {
  static const StylusPull kNothing;
  return kNothing;
}

void Solver::persist(Archive& /*archive*/) {
  throw Error(backend() + ": cannot save or restore its state");
}

void Solver::goOnFrom(const HostState& /*state*/) {
  throw Error(backend() + ": cannot continue from a state");
}

uint64_t stateHash(const Model& model, const HostState& state) {
  StateHash hash;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    for (uint32_t local : model.bodies[b].lattice.active_slots) {
      const uint32_t slot = model.slotOffset(b) + local;
      for (const layout::vec4& v : {state.displacement_m[slot], state.velocity_m_per_s[slot]}) {
        hash.add(v.x);
        hash.add(v.y);
        hash.add(v.z);
      }
      hash.add(state.nodes[slot].lo & layout::kAxialMask);
      hash.add(state.nodes[slot].hi & layout::kDiagonalMask);
    }
  }
  for (const float cut : state.spring_cut) hash.add(cut);
  return hash.value();
}

}  // namespace viscera
