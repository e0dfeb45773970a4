// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "viscera/api.h"
#include "viscera/layout/limits.h"
#include "viscera/layout/tool_motion.h"
#include "viscera/math/types.h"
#include "viscera/model/scene/tool_mode.h"

namespace VISCERA_PUBLIC viscera {

/// Value of StylusSample::jaw_rad where no device reports the opening of the jaws and buttons close them.
constexpr float kNoJaw = -1;
/// Largest opening of jaws: half a turn [rad].
constexpr double kWidestJaw_rad = 3.1416;

/// Latest state of one stylus: tip pose in the tissue frame, buttons, jaws. The shaft extends from the tip along
/// +z of the stylus frame; ahead of the tip is -z. `cut.blade_side` gives the position of a blade on this axis.
struct StylusSample {
  bool valid = false;  ///< false until a first pose has arrived, and again when the pose is stale
  Pose pose;
  bool button1 = false;
  bool button2 = false;
  float jaw_rad = kNoJaw;  ///< opening of the two jaws of a device [rad], 0 .. kWidestJaw_rad
  SteadyTime received{};   ///< time at which the pose was received, for the measurement of delays; 0 where not measured
};
using StylusSamples = std::array<StylusSample, layout::kMaxStyluses>;

/// Condition of a stylus's mode: no button pressed, or the button that is.
enum class ToolSwitch { kIdle, kButton1, kButton2 };

/// Motion and mode of one stylus over one tick.
struct StylusMotion {
  ToolMode mode = ToolMode::kNone;
  bool present = false;  ///< a valid pose is known, whatever the mode
  float mouth_rad = 0;   ///< opening of closing jaws when this closing began [rad]
  Pose from, to;
  bool hold_begins = false;               ///< this tick is the first of a mode that holds
  ToolMode hold_ended = ToolMode::kNone;  ///< holding mode that ended at the start of this tick
  /// > 0: the stylus appeared and has not been outside tissue since. It pushes nothing, and looks for tissue within
  /// this radius of its tip, and of the axis of its shaft [m].
  double feels_m = 0;
  /// Opening of a tool's jaws at the start and the end of the tick [rad].
  double opens_from_rad = 0, opens_to_rad = 0;
  /// Distance from the tip to the near end of the shaft's axis at the start and the end of the tick [m]; below 0:
  /// tissue does not meet the shaft.
  double shaft_from_m = -1, shaft_to_m = -1;
  /// Part of the positions of `from` and `to` by which held tissue has slid in the jaws, stylus frame [m].
  Vector3d slid_from_m = Vector3d::Zero(), slid_to_m = Vector3d::Zero();
  bool speed_limited = false;  ///< the tip was faster than tissue can follow: `to` lags behind the pose, and catches up
};
using ToolMotions = std::array<StylusMotion, layout::kMaxStyluses>;

}  // namespace viscera
