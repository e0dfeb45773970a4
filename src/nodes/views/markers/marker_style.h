// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <visualization_msgs/InteractiveMarker.h>

#include <array>
#include <string>

#include "viscera/math/types.h"

namespace viscera::nodes {

/// Contents of a stylus's marker in rviz.
struct MarkerStyle {
  std::string stylus, frame;
  double size_m = 0.03;              ///< size of its arrows and rings [m]
  double step_m = 0;                 ///< step of a click on the arrow heads [m]
  std::array<std::string, 3> modes;  ///< tool modes: idle, with button 1, with button 2; empty: not known
  bool shows(size_t button) const { return modes[button] != "none"; }
  /// Returns a name such as `grab`; `button 1` if the mode is not known.
  std::string nameOf(size_t button) const;
  /// Returns a name such as `Grab (button 1)`.
  std::string menuNameOf(size_t button) const;
};

/// Names of the controls that send feedback.
constexpr const char* kForward = "forward";  ///< a click is a step along the shaft
constexpr const char* kBack = "back";
/// Returns the button, 1 or 2, that is pressed while the control is dragged; 0 for other controls.
int pressOf(const std::string& control);

/// Returns the marker: a ball at the tip for the mouse, arrows and rings. On the shaft it has a ball per button, which
/// presses the button while dragged, and two arrow heads that step along the shaft.
visualization_msgs::InteractiveMarker markerOf(const MarkerStyle& style, const Pose& pose);

/// Returns a text such as 0.5 mm or 12 mm.
std::string lengthText(double length_m);

}  // namespace viscera::nodes
