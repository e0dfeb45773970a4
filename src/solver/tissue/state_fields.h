// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace viscera {

/// What a roll-back by the stability monitor (governor) does to a field of the state.
enum class FieldRollBack {
  kUndo,   ///< puts back what was saved with the good state
  kKeep,   ///< leaves it as it is: springs stay cut, hands keep their hold
  kClear,  ///< sets it to what it is at rest
};

/// How an array of the state is kept, on any backend. A backend visits its arrays with these (CpuLattice::visitState,
/// LatticeBuffers::visitState), and resetting, saving, restoring and rolling back go through them. A new array of a
/// backend's state is a member, a row here and a line there.
struct StateField {
  const char* section;  ///< of saved states
  float at_rest;        ///< every number of it, in whole tissue at rest
  FieldRollBack roll_back;
};

namespace fields {
inline constexpr StateField kDisplacement{"state", 0, FieldRollBack::kUndo};
inline constexpr StateField kVelocity{"state", 0, FieldRollBack::kUndo};
inline constexpr StateField kOtherState{"state", 0,
                                        FieldRollBack::kKeep};  ///< the last or the next one, which is written first
inline constexpr StateField kRoundingErrors{"state", 0, FieldRollBack::kClear};
inline constexpr StateField kAxialCut{"cuts", 0, FieldRollBack::kKeep};
inline constexpr StateField kCutSides{"cuts", 0, FieldRollBack::kKeep};
inline constexpr StateField kLeftByTearing{"cuts", 1, FieldRollBack::kKeep};
inline constexpr StateField kGrabOffsets{"hands", 0, FieldRollBack::kKeep};
inline constexpr StateField kHeldBricks{"hands", 0, FieldRollBack::kKeep};
inline constexpr StateField kImpulses{"hands", 0,
                                      FieldRollBack::kClear};  ///< of styluses and obstacles, and where they are
}  // namespace fields

}  // namespace viscera
