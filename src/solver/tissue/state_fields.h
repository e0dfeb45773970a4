// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace viscera {

/// What a roll-back by the stability monitor (stability monitor) does to a field of the state.
enum class FieldRollBack {
  kUndo,   ///< restores the field that was saved with the good state
  kKeep,   ///< keeps the current field: springs stay cut, tools keep their grip
  kClear,  ///< sets the field to its value at rest
};

/// How an array of the state is kept, on any backend. A backend visits its arrays with these (CpuLattice::visitState,
/// LatticeBuffers::visitState) to reset, save, restore and roll back. A new array of a backend's state needs a member,
/// a row here and a line there.
struct StateField {
  const char* section;  ///< name of its section in saved states
  float at_rest;        ///< value of each number in whole tissue at rest
  FieldRollBack roll_back;
};

namespace fields {
inline constexpr StateField kDisplacement{"state", 0, FieldRollBack::kUndo};
inline constexpr StateField kVelocity{"state", 0, FieldRollBack::kUndo};
inline constexpr StateField kOtherState{"state", 0,
                                        FieldRollBack::kKeep};  ///< previous or next state, written before it is read
inline constexpr StateField kRoundingErrors{"state", 0, FieldRollBack::kClear};
inline constexpr StateField kAxialCut{"cuts", 0, FieldRollBack::kKeep};
inline constexpr StateField kCutSides{"cuts", 0, FieldRollBack::kKeep};
inline constexpr StateField kLeftByTearing{"cuts", 1, FieldRollBack::kKeep};
inline constexpr StateField kGrabOffsets{"hands", 0, FieldRollBack::kKeep};
inline constexpr StateField kHeldBricks{"hands", 0, FieldRollBack::kKeep};
inline constexpr StateField kImpulses{"hands", 0,
                                      FieldRollBack::kClear};  ///< impulses of styluses and obstacles, with positions
}  // namespace fields

}  // namespace viscera
