// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "model/scene/mark_fields.h"
#include "viscera/model/scene/body_config.h"

namespace viscera {

// Scene keys of hollow tubes and of the pressure in cavities (body_fields.h).

constexpr double kMostTubeBranches = 32, kMostTubePoints = 200;
constexpr Range kTubeRadius{1e-4, 1};        // m
constexpr Range kOwnTubeRadius{0, 1};        // m
constexpr Range kCavityPressure{0, 200000};  // Pa

template <class V>
void visitFields(V& v, TubeBranch& c) {
  v.text("name", c.name, "name of the branch, a part of the body");
  v.list("path", c.path, kMostTubePoints,
         "points of the axis of the branch, at least two; the first lies in the lumen of the tube or of an earlier "
         "branch");
  v.number("radius_m", c.radius_m, kOwnTubeRadius, "m", "outer radius of the branch; 0: that of the tube");
  v.number("wall_m", c.wall_m, kOwnTubeRadius, "m", "thickness of its wall; 0: that of the tube");
}

template <class V>
void visitFields(V& v, TubeConfig& c) {
  v.list("path", c.path, kMostTubePoints,
         "points of the axis, at least two, in the body's own coordinates; a smooth curve goes through them, which may "
         "not bend tighter than the radius. The tube is open at both ends");
  v.number("radius_m", c.radius_m, kTubeRadius, "m", "outer radius");
  v.number("wall_m", c.wall_m, kTubeRadius, "m",
           "thickness of the wall, at least half a cell; the lumen must be two cells wide");
  v.list("branches", c.branches, kMostTubeBranches, "hollow branches, with lumens that join that of the tube");
}

template <class V>
void visitFields(V& v, PressureConfig& c) {
  v.number("mean_pa", c.mean_pa, kCavityPressure, "Pa",
           "mean pressure of the fluid in the cavities of the body over that outside, reached 0.2 s after the start; "
           "the open ends of a tube are closed by caps that load their rims (docs/physics.md#18-pressure); 0: none. "
           "Above 0: needs structure lattice, solver.integrator leapfrog, solver.backend cpu or auto, solver.start "
           "rest");
  v.number("pulse_pa", c.pulse_pa, kCavityPressure, "Pa", "amplitude of the pulse, added as a sine");
  v.number("pulse_hz", c.pulse_hz, {0, 20}, "Hz", "frequency of the pulse");
}

}  // namespace viscera
