// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "viscera/model/scene/stylus_config.h"

namespace viscera {

/// A key of a stylus that says how large one of its tools is, and its value [m].
struct ToolSize {
  const char* key;
  double& (*of)(StylusConfig&);
  bool meets_nodes = false;   ///< a reach within which it finds nodes, or meets those around
  bool only_shrinks = false;  ///< of what is drawn alone: small organs are not hidden, large ones need nothing larger
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

/// Returns a stylus whose tools are `scale` times as large, but no smaller or larger than their keys accept.
/// Shafts are never longer than they were.
/// @param cells  how many times as large the cells are: reaches that meet nodes grow as much, if that is more
StylusConfig scaledTools(StylusConfig stylus, double scale, double cells = 0);

}  // namespace viscera
