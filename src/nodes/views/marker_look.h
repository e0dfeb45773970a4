// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <visualization_msgs/InteractiveMarker.h>

#include <array>
#include <string>

#include "viscera/math/types.h"

namespace viscera::nodes {

/// What the marker of a stylus shows in rviz.
struct MarkerLook {
  std::string stylus, frame;
  double size_m = 0.03;              ///< of its arrows and rings
  double step_m = 0;                 ///< of a click on the arrow heads
  std::array<std::string, 3> modes;  ///< what it does: idle, with button 1, with button 2; empty: not known
  bool shows(size_t button) const { return modes[button] != "none"; }
  /// As in `grab`; `button 1` where none is said.
  std::string nameOf(size_t button) const;
  /// As in `Grab (button 1)`.
  std::string menuNameOf(size_t button) const;
};

/// Names of the controls that feedback comes from.
constexpr const char* kForward = "forward";  ///< a click: a step along the shaft
constexpr const char* kBack = "back";
/// While it is dragged its button is pressed: 1 or 2. 0: of other controls.
int pressOf(const std::string& control);

/// A ball at the tip that the mouse grips, arrows and rings; on the shaft a ball per button, which presses it while it
/// is dragged, and two arrow heads that step along it.
visualization_msgs::InteractiveMarker markerOf(const MarkerLook& look, const Pose& pose);

/// 0.5 mm, 12 mm.
std::string lengthText(double length_m);

}  // namespace viscera::nodes
