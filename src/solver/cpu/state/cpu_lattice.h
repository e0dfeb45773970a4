// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <type_traits>

#include "solver/cpu/state/cpu_strengths.h"
#include "solver/tissue/cut_record.h"
#include "solver/tissue/joined_network.h"
#include "solver/tissue/state_fields.h"
#include "viscera/math/types.h"
#include "viscera/solver/material.h"
#include "viscera/solver/state.h"

namespace viscera {

class Archive;

/// Motion of all nodes as two states: one is current, the other is the last or the next one.
struct CpuState {
  explicit CpuState(size_t slots);
  /// Makes the output state the current one.
  void swap() { current = 1 - current; }

  AlignedVector<float> displacement[2];  ///< [3 * slots] m (vectorAt)
  AlignedVector<float> velocity[2];      ///< [3 * slots] m/s
  int current = 0;
};

/// State of grips, and impulses of styluses and obstacles. Empty without any.
struct CpuToolState {
  CpuToolState(const CpuStore& store, const FeatureSet& features);

  std::vector<layout::vec4> grab_offsets;       ///< [slots] m, stylus frame
  std::vector<layout::vec4> impulses;           ///< [kMaxStyluses * slots] N s; w counts substeps of contact
  std::vector<uint8_t> touched;                 ///< [bricks] 1: some impulses of the brick are not 0
  std::vector<uint8_t> held;                    ///< [bricks] 1: some nodes of the brick are held
  std::vector<layout::vec4> obstacle_impulses;  ///< [obstacles * slots] N s; w counts substeps; empty without any
  std::vector<uint8_t> met;                     ///< [bricks] 1: some obstacle impulses of the brick are not 0
  uint32_t obstacle_count = 0;
};

/// Explicit connections; all arrays are empty without any.
struct CpuLinks {
  explicit CpuLinks(const Model& model);
  /// Restores all links except those that are cut.
  /// @param cut  [springs] as in CutSprings
  void writeSpringCut(const std::vector<float>& cut);

  JoinedNetwork network;          ///< links, with stiffness 0 where springs are cut; masses are in CpuStrengths
  std::vector<float> spring_cut;  ///< [springs] as in CutSprings

 private:
  std::vector<layout::Link> whole_links_;
};

/// The nodes of all bodies in host memory with all their data. All of the CPU backend works on it.
struct CpuLattice {
  /// @param bodies  [bodies] material constants
  /// @param features  determine which optional arrays exist
  /// @throws SceneError  parts (strengths)
  CpuLattice(const Model& model, const std::vector<layout::BodyParams>& bodies, const FeatureSet& features);

  /// Resets to the rest state with intact springs and no grips.
  void reset();
  /// Calls visit(StateField, array) for the whole state except node bits and cut links, which follow from the springs.
  /// Arrays that a scene does not have are empty.
  template <class Visit>
  void visitState(Visit&& visit) {
    visit(fields::kDisplacement, state.displacement[state.current]);
    visit(fields::kVelocity, state.velocity[state.current]);
    visit(fields::kOtherState, state.displacement[1 - state.current]);
    visit(fields::kOtherState, state.velocity[1 - state.current]);
    visit(fields::kAxialCut, axial_cut);
    visit(fields::kCutSides, cut_sides);
    visit(fields::kLeftByTearing, strengths.left);
    visit(fields::kGrabOffsets, tools.grab_offsets);
    visit(fields::kHeldBricks, tools.held);
    visit(fields::kImpulses, tools.impulses);
    visit(fields::kImpulses, tools.touched);
    visit(fields::kImpulses, tools.obstacle_impulses);
    visit(fields::kImpulses, tools.met);
  }
  void swap() { state.swap(); }
  HostState read() const;
  void readCuts(CutSprings& out) const;
  void write(const HostState& from);
  void persist(Archive& archive);
  void refresh(uint32_t slot) { strengths.refresh(store, slot); }

  layout::uint connections(uint32_t slot) const { return store.connections(slot); }
  size_t slotCount() const { return store.slotCount(); }
  size_t brickCount() const { return store.brickCount(); }

  CpuStore store;
  CpuLinks links;
  CpuStrengths strengths;
  CpuState state;
  CpuToolState tools;
  CutRecord record;
  std::vector<float> axial_cut;         ///< [record.size()] as in CutSprings, for implicit lattices
  std::vector<layout::vec4> cut_sides;  ///< [slots] if there is a record: see shaders/solver/tools/cut_sides.glsl
};

/// Sets an array of the state to its value in intact tissue at rest.
template <class Values>
void setToRest(const StateField& field, Values& values) {
  using Value = typename Values::value_type;
  if constexpr (std::is_arithmetic_v<Value>)
    std::fill(values.begin(), values.end(), static_cast<Value>(field.at_rest));
  else
    std::fill(values.begin(), values.end(), Value{});
}

/// Returns the vector of a slot in displacement or velocity.
inline Vector3f planesAt(const float* planes, uint32_t slot) {
  const float* at = planes + vectorAt(slot);
  return {at[0], at[64], at[128]};
}
inline void setPlanes(float* planes, uint32_t slot, const Vector3f& value) {
  float* at = planes + vectorAt(slot);
  at[0] = value.x();
  at[64] = value.y();
  at[128] = value.z();
}

}  // namespace viscera
