// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "viscera/layout/limits.h"
#include "viscera/layout/tool_motion.h"
#include "viscera/math/types.h"
#include "viscera/model/scene/tool_mode.h"

namespace viscera {

/// Of StylusSample::jaw_rad: no device tells how far the jaws are open, buttons close them.
constexpr float kNoJaw = -1;
/// They open no farther than half a turn [rad].
constexpr double kWidestJaw_rad = 3.1416;

/// The latest that is known of one stylus: tip pose in the tissue frame, buttons, jaws. The shaft points along -z of
/// the stylus frame (away from the tip is +z); a blade lies on this axis, where `cut.blade_side` says.
struct StylusSample {
  bool valid = false;  ///< false until a first pose has come, and again when the pose is stale
  Pose pose;
  bool button1 = false;
  bool button2 = false;
  float jaw_rad = kNoJaw;  ///< opening between two fingers that a device has, 0 .. kWidestJaw_rad
  SteadyTime received{};   ///< when the pose came, for the measurement of delays; 0 where not looked at
};
using StylusSamples = std::array<StylusSample, layout::kMaxStyluses>;

/// When a stylus is in one of its modes: with no button pressed, or while one is.
enum class ToolSwitch { kIdle, kButton1, kButton2 };

/// One stylus over one tick: where it was, where it is, what it does.
struct StylusMotion {
  ToolMode mode = ToolMode::kNone;
  bool present = false;  ///< a valid pose is known, whatever the mode
  float mouth_rad = 0;   ///< of jaws that close: their opening when this closing began
  Pose from, to;
  bool hold_begins = false;  ///< this tick is the first of a mode that holds
  ToolMode hold_ended =
      ToolMode::kNone;  ///< a mode that held was left, or the stylus was lost, at the start of this tick
  /// > 0: the stylus appeared and has not been outside of tissue since. It pushes nothing, and feels for tissue within
  /// this radius [m].
  double feels_m = 0;
  /// Of tools with jaws: their opening [rad] at the start and the end of the tick.
  double opens_from_rad = 0, opens_to_rad = 0;
  bool held_back = false;  ///< the tip was faster than tissue can follow: `to` lags behind the pose, and catches up
};
using ToolMotions = std::array<StylusMotion, layout::kMaxStyluses>;

}  // namespace viscera
