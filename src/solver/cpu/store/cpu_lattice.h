// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <type_traits>

#include "solver/cpu/store/cpu_strengths.h"
#include "solver/tissue/cut_record.h"
#include "solver/tissue/joined_network.h"
#include "solver/tissue/state_fields.h"
#include "viscera/math/types.h"
#include "viscera/solver/material.h"
#include "viscera/solver/state.h"

namespace viscera {

class Archive;

/// How all nodes move: two states, of which one is current and the other the last or the next one.
struct CpuState {
  explicit CpuState(size_t slots);
  /// What was output becomes the current state.
  void swap() { current = 1 - current; }

  AlignedVector<float> displacement[2];  ///< [3 * slots] m (vectorAt)
  AlignedVector<float> velocity[2];      ///< [3 * slots] m/s
  int current = 0;
};

/// What styluses hold and give, empty without any; and what obstacles give.
struct CpuHands {
  CpuHands(const CpuStore& store, const FeatureSet& features);

  std::vector<layout::vec4> grab_offsets;       ///< [slots] m, stylus frame
  std::vector<layout::vec4> impulses;           ///< [kMaxStyluses * slots] N s, w substeps of contact
  std::vector<uint8_t> touched;                 ///< [bricks] some of its impulses are not 0
  std::vector<uint8_t> held;                    ///< [bricks] nodes of it are held
  std::vector<layout::vec4> obstacle_impulses;  ///< [obstacles * slots] N s, w substeps of contact; empty without any
  std::vector<uint8_t> met;                     ///< [bricks] some of these are not 0
  uint32_t obstacle_count = 0;
};

/// Explicit connections; all empty without any.
struct CpuLinks {
  explicit CpuLinks(const Model& model);
  /// Whole but for those that are cut. @param cut  [springs] as in CutSprings
  void writeSpringCut(const std::vector<float>& cut);

  JoinedNetwork network;          ///< without stiffness where springs are cut; masses are in CpuStrengths
  std::vector<float> spring_cut;  ///< [springs] as in CutSprings

 private:
  std::vector<layout::Link> whole_links_;
};

/// The nodes of all bodies in host memory, with all that is known of them: what every part of the CPU backend works on.
struct CpuLattice {
  /// @param bodies  [bodies] material constants   @param features  what has arrays beyond the state itself
  /// @throws SceneError  parts (strengths)
  CpuLattice(const Model& model, const std::vector<layout::BodyParams>& bodies, const FeatureSet& features);

  /// Rest state, whole springs, nothing held.
  void reset();
  /// Calls visit(StateField, array) with all of the state but node bits and cut links, which springs follow from. What
  /// a scene does not have is empty.
  template <class Visit>
  void visitState(Visit&& visit) {
    visit(fields::kDisplacement, state.displacement[state.current]);
    visit(fields::kVelocity, state.velocity[state.current]);
    visit(fields::kOtherState, state.displacement[1 - state.current]);
    visit(fields::kOtherState, state.velocity[1 - state.current]);
    visit(fields::kAxialCut, axial_cut);
    visit(fields::kCutSides, cut_sides);
    visit(fields::kLeftByTearing, strengths.left);
    visit(fields::kGrabOffsets, hands.grab_offsets);
    visit(fields::kHeldBricks, hands.held);
    visit(fields::kImpulses, hands.impulses);
    visit(fields::kImpulses, hands.touched);
    visit(fields::kImpulses, hands.obstacle_impulses);
    visit(fields::kImpulses, hands.met);
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
  CpuHands hands;
  CutRecord record;
  std::vector<float> axial_cut;         ///< [record.size()] as in CutSprings, of implicit lattices
  std::vector<layout::vec4> cut_sides;  ///< [slots] where there is a record: see shaders/solver/tools/cut_sides.glsl
};

/// Sets an array of the state to what it is in whole tissue at rest.
template <class Values>
void setToRest(const StateField& field, Values& values) {
  using Value = typename Values::value_type;
  if constexpr (std::is_arithmetic_v<Value>)
    std::fill(values.begin(), values.end(), static_cast<Value>(field.at_rest));
  else
    std::fill(values.begin(), values.end(), Value{});
}

/// The vector of a slot in displacement or velocity.
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
