// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "viscera/model/scene/stylus_config.h"

namespace viscera {

/// Key of a stylus that sets the size of one of its tools, and its value [m].
struct ToolSize {
  const char* key;
  double& (*of)(StylusConfig&);
  bool meets_nodes = false;   ///< a reach within which it finds or meets nodes
  bool only_shrinks = false;  ///< drawn only: it shrinks so as not to hide small organs, and never grows
};

inline constexpr std::array<ToolSize, 12> kToolSizes = {{
    {"probe.radius_m", [](StylusConfig& c) -> double& { return c.probe.radius_m; }, true},
    {"grab.radius_m", [](StylusConfig& c) -> double& { return c.grab.radius_m; }, true},
    {"cut.blade_length_m", [](StylusConfig& c) -> double& { return c.cut.blade_length_m; }},
    {"cut_particles.eraser_radius_m", [](StylusConfig& c) -> double& { return c.cut_particles.eraser_radius_m; }},
    {"suction.radius_m", [](StylusConfig& c) -> double& { return c.suction.radius_m; }, true},
    {"scissors.blade_length_m", [](StylusConfig& c) -> double& { return c.scissors.blade_length_m; }},
    {"grasper.radius_m", [](StylusConfig& c) -> double& { return c.grasper.radius_m; }, true},
    {"grasper.jaw_length_m", [](StylusConfig& c) -> double& { return c.grasper.jaw_length_m; }},
    {"clip.jaw_length_m", [](StylusConfig& c) -> double& { return c.clip.jaw_length_m; }},
    {"clip.opening_m", [](StylusConfig& c) -> double& { return c.clip.opening_m; }},
    {"cautery.radius_m", [](StylusConfig& c) -> double& { return c.cautery.radius_m; }},
    {"shaft_length_m", [](StylusConfig& c) -> double& { return c.shaft_length_m; }, false, true},
}};

/// Returns a stylus with tools `scale` times as large, within the ranges of their keys. Shafts never become longer.
/// @param cells  factor by which the cells are larger: reaches that meet nodes grow by it if it exceeds `scale`
StylusConfig scaledTools(StylusConfig stylus, double scale, double cells = 0);

}  // namespace viscera
