// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "model/scene/body_fields.h"
#include "model/scene/integrators.h"
#include "model/scene/suture_fields.h"
#include "model/scene/tool_kinds.h"
#include "viscera/layout/limits.h"
#include "viscera/model/scene/camera_config.h"
#include "viscera/model/scene/environment_config.h"
#include "viscera/model/scene/plumb_bob.h"
#include "viscera/model/scene/solver_config.h"

namespace viscera {

// The one list of scene keys, with body_fields.h and suture_fields.h; field_ranges.h says what a visitor offers.

/// Returns the tool kinds by their names.
inline std::vector<Choice<ToolMode>> toolChoices() {
  std::vector<Choice<ToolMode>> choices;
  for (const ToolKind& kind : kToolKinds) choices.push_back({kind.name, kind.mode});
  return choices;
}

constexpr Range kTipReach{1e-4, 1};     // m: dimensions of a tool at its tip
constexpr Range kReleaseSpeed{0, 100};  // m/s

template <class V>
void visitFields(V& v, ProbeConfig& c) {
  v.number("radius_m", c.radius_m, kTipReach, "m", "radius of the tip's sphere");
}

template <class V>
void visitFields(V& v, GrabConfig& c) {
  v.number("radius_m", c.radius_m, kTipReach, "m", "distance from the tip within which nodes are held");
  v.number("release_speed_m_per_s", c.release_speed_m_per_s, kReleaseSpeed, "m/s", "largest node speed after release");
}

template <class V>
void visitFields(V& v, CutConfig& c) {
  v.number("blade_length_m", c.blade_length_m, kTipReach, "m", "length of the blade, from the tip");
  v.choice("blade_side", c.blade_side,
           {{"shaft", BladeSide::kShaft}, {"ahead", BladeSide::kAhead}, {"both", BladeSide::kBoth}},
           "side of the tip on which the blade is; shaft: from the tip back along the shaft (+z of the stylus), like a "
           "knife; ahead: from the tip forwards (-z), like a wire that the user aims; both: its length on each side");
  v.number("friction_n_per_m", c.friction_n_per_m, {0, 1e4}, "N/m",
           "friction of both walls together, per length of blade in tissue that resists blades; against the motion "
           "through the tissue, also in the blade's own wound");
  v.number("point_width_m", c.point_width_m, {0, 0.1}, "m",
           "width of the cut that the tip makes in tissue that resists blades when blade or needle is pushed along its "
           "axis; 0: the tip does not cut and exerts no force");
}

template <class V>
void visitFields(V& v, CutParticlesConfig& c) {
  v.number("eraser_radius_m", c.eraser_radius_m, {1e-5, 1}, "m",
           "distance from the blade within which nodes are erased");
}

template <class V>
void visitFields(V& v, SuctionConfig& c) {
  v.number("radius_m", c.radius_m, kTipReach, "m",
           "radius of the cup: distance from the tip within which nodes are held");
  v.number("max_force_n", c.max_force_n, {0, 1e3}, "N",
           "largest reaction force; after a tick with a larger one the cup lets go, and holds nothing until it is "
           "switched off and on");
  v.number("release_speed_m_per_s", c.release_speed_m_per_s, kReleaseSpeed, "m/s", "largest node speed after release");
}

template <class V>
void visitFields(V& v, ScissorsConfig& c) {
  v.number("blade_length_m", c.blade_length_m, kTipReach, "m",
           "length of a blade, from the pivot behind the tips to the tips");
  v.number("opening_deg", c.opening_deg, {5, 120}, "deg", "angle between the blades when they begin to close");
  v.number("closing_s", c.closing_s, {0.02, 10}, "s", "time from open to closed, while the button is held");
}

template <class V>
void visitFields(V& v, GrasperConfig& c) {
  v.number("radius_m", c.radius_m, kTipReach, "m", "distance from the tip within which nodes are between the jaws");
  v.number("jaw_length_m", c.jaw_length_m, kTipReach, "m",
           "length of a jaw, from the pivot behind the tips to the tips; tissue that slides so far is lost");
  v.number("opening_deg", c.opening_deg, {5, 120}, "deg", "angle between the open jaws, along x of the stylus");
  v.number("max_force_n", c.max_force_n, {0, 1e3}, "N",
           "friction of the jaws: above this force the tissue slides in them");
  v.number("release_speed_m_per_s", c.release_speed_m_per_s, kReleaseSpeed, "m/s", "largest node speed after release");
}

template <class V>
void visitFields(V& v, CauteryConfig& c) {
  v.number("radius_m", c.radius_m, {1e-4, 0.1}, "m", "radius of the tip, a sphere");
  v.number("power_w", c.power_w, {0, 400}, "W", "power into the tissue that the tip touches in this mode");
}

template <class V>
void visitFields(V& v, ClipConfig& c) {
  v.number("jaw_length_m", c.jaw_length_m, kTipReach, "m",
           "length of a jaw, from the pivot behind the tips to the tips");
  v.number("opening_m", c.opening_m, kTipReach, "m", "distance between the open jaws, along x of the stylus");
  v.number("width_m", c.width_m, {1e-4, 0.1}, "m",
           "width of a clip, along y of the stylus; it takes nodes within half of it, or within half a spacing if that "
           "is more");
  v.number("gap_m", c.gap_m, {0, 0.1}, "m",
           "distance between the legs of a closed clip; solid tissue keeps 0.4 of its thickness");
  v.number("force_n", c.force_n, {0.01, 1e3}, "N", "force with which a clip closes and stays closed");
  v.integer("magazine", c.magazine, {1, static_cast<double>(kMostClips)}, "number of clips until a reset");
}

template <class V>
void visitFields(V& v, TrocarConfig& c) {
  v.choice("follows", c.follows,
           {{"none", TrocarMotion::kNone}, {"handle", TrocarMotion::kHandle}, {"tip", TrocarMotion::kTip}},
           "end of the shaft that follows the pose while the axis of the shaft passes `position_m`: handle, the end of "
           "`shaft_length_m`, so that sideways motion is reversed at the tip and its force has the lever "
           "(docs/lessons/instruments.md#trocars); tip; none: no trocar");
  v.vector("position_m", c.position_m, kCoordinate, "m",
           "point that the axis of the shaft passes, in the tissue frame");
}

template <class V>
void visitFields(V& v, StylusConfig& c) {
  const std::vector<Choice<ToolMode>> modes = toolChoices();
  v.text("name", c.name, "name of the stylus; its topics are `<name>/measured_cp` and so on");
  v.choice("idle", c.idle, modes, "tool while no button is pressed");
  v.choice("button1", c.button1, modes, "tool while button 1 is pressed");
  v.choice("button2", c.button2, modes, "tool while button 2 is pressed; takes precedence over button 1");
  v.group("probe", c.probe, "probe: a sphere at the tip that pushes nodes aside");
  v.group("grab", c.grab, "grab: holds the nodes that are around the tip when it begins");
  v.group("cut", c.cut, "cut: a blade that cuts the springs that it crosses");
  v.group("cut_particles", c.cut_particles, "cut_particles: the same blade, which erases the springs of nodes near it");
  v.group("suction", c.suction, "suction: holds the nodes around the tip as grab does, up to a force");
  v.group("scissors", c.scissors,
          "scissors: two blades that close when the mode begins and cut the tissue between them");
  v.group("grasper", c.grasper, "grasper: two jaws that hold the nodes around the tip, up to their friction");
  v.group("clip", c.clip, "clip: two jaws that set a clip on the tissue between them once they have closed");
  v.group("cautery", c.cautery,
          "cautery: a probe with a tip that burns the tissue that it touches (docs/lessons/instruments.md)");
  v.number("shaft_length_m", c.shaft_length_m, {0.001, 1}, "m", "length of the shaft, from the tip back");
  v.number("shaft_radius_m", c.shaft_radius_m, {0, 0.1}, "m", "radius of the shaft; 0: a fortieth of its length");
  v.boolean(
      "shaft_contact", c.shaft_contact,
      "the shaft pushes tissue, as a probe does (docs/physics.md#5-tools), but for its part that is jaws or a blade");
  v.group("trocar", c.trocar, "trocar: point of the body wall that the shaft passes");
  v.number("jaw_closing_s", c.jaw_closing_s, {0.02, 10}, "s",
           "time from open to closed for jaws that a button closes, except scissors");
  v.number("max_force_n", c.max_force_n, {0, 1e3}, "N", "limit of the reaction force, which saturates there");
  v.number("max_force_rate_n_per_s", c.max_force_rate_n_per_s, {1, 1e6}, "N/s",
           "largest rate of change of the reaction force");
  v.number("max_torque_nm", c.max_torque_nm, {0, 1e2}, "N m", "limit of the reaction torque, which saturates there");
  v.number("max_torque_rate_nm_per_s", c.max_torque_rate_nm_per_s, {0.01, 1e5}, "N m/s",
           "largest rate of change of the reaction torque");
  v.number("stale_after_s", c.stale_after_s, {0.001, 60}, "s", "age above which a pose is ignored: no tool, no force");
  v.number("workspace_m", c.workspace_m, {0.01, 100}, "m",
           "distance from the tissue frame beyond which a pose is refused");
}

template <class V>
void visitFields(V& v, PlumbBob& c) {
  constexpr Range kCoefficient{-10, 10};
  v.number("k1", c.k1, kCoefficient, "1", "radial coefficient of the square of the tangent; below 0: a barrel");
  v.number("k2", c.k2, kCoefficient, "1", "radial coefficient of the fourth power of the tangent");
  v.number("p1", c.p1, kCoefficient, "1", "tangential coefficient along the image's columns");
  v.number("p2", c.p2, kCoefficient, "1", "tangential coefficient along the image's rows");
  v.number("k3", c.k3, kCoefficient, "1", "radial coefficient of the sixth power of the tangent");
}

template <class V>
void visitFields(V& v, CameraConfig& c) {
  v.text("name", c.name, "name of the camera; its topics are `<name>/image_raw` and `<name>/camera_info`");
  v.vector("position_m", c.position_m, kCoordinate, "m", "position of the camera in the tissue frame");
  v.vector("target_m", c.target_m, kCoordinate, "m", "point that the camera looks at, in the tissue frame");
  v.vector("up", c.up, kDirection, "", "direction that is up in the image");
  v.number("vertical_fov_deg", c.vertical_fov_deg, {1, 150}, "deg", "vertical field of view");
  v.integer("width_px", c.width_px, {16, 4096}, "width of the image");
  v.integer("height_px", c.height_px, {16, 4096}, "height of the image");
  v.number("rate_hz", c.rate_hz, {0.1, 240}, "Hz", "images per second of simulated time, at most one per tick");
  v.integer("supersampling", c.supersampling, {0, 2},
            "pixels drawn per image pixel along each axis, for antialiasing; 0: 2, but a software renderer lights "
            "tissue once per pixel, and four times at edges only (docs/benchmarks.md#picture)");
  v.names("overlays", c.overlays, "overlays drawn over the tissue; the service set_overlays changes them at run time");
  v.number("strain_range", c.strain_range, {0.001, 10}, "1", "overlay strain: strain at the end of the legend");
  v.boolean("draw_hidden", c.draw_hidden,
            "compute hidden surfaces too, for comparison: pictures are the same (docs/surface.md)");
  v.text("frame", c.frame,
         "tf frame that carries the camera, as an endoscope: `position_m`, `target_m` and `up` are then in this frame. "
         "A name that ends in `_optical` or `_optical_frame` means the optical frame itself (z forward, x right)");
  v.text("stylus", c.stylus,
         "stylus that is an endoscope with this camera in it: the lens is at its tip, and `up` stays up in the image. "
         "Until the stylus has a pose, the camera is at `position_m`. Not with `frame` "
         "(docs/user_guide.md#pictures-and-cameras)");
  v.number(
      "lens_angle_deg", c.lens_angle_deg, {0, 90}, "deg",
      "angle between the shaft of the endoscope and its line of sight, towards -y of the stylus; laparoscopes have "
      "0 or 30. Needs `stylus`");
  v.group("distortion", c.distortion,
          "distortion of the lens, plumb_bob: the D of CameraInfo; all 0: a pinhole (docs/surface.md#looks)");
  v.choice("light", c.light, {{"lamp", CameraLight::kLamp}, {"lens", CameraLight::kLens}},
           "light source: lamp is above the lens and equally bright everywhere; lens is at the lens, as in an "
           "endoscope, fades with the square of the distance and is as bright as the lamp at `target_m`");
  v.number("light_cone_deg", c.light_cone_deg, {10, 170}, "deg",
           "light lens: full angle of the light cone; at its rim half of the light is left");
  v.number("contact_shadows", c.contact_shadows, {0, 1}, "1",
           "darkness of the shadow between a tool and tissue that it touches or nearly touches; 0: no such shadow");
  v.number("stereo_baseline_m", c.stereo_baseline_m, {0, 1}, "m",
           "distance of a right eye from this camera, which is the left one: topics `<name>/left` and `<name>/right`; "
           "0: no right eye");
}

template <class V>
void visitFields(V& v, WindConfig& c) {
  v.vector("velocity_m_per_s", c.velocity_m_per_s, {-100, 100}, "m/s", "mean velocity of the air in the tissue frame");
  v.number("gust_ratio", c.gust_ratio, {0, 10}, "1", "amplitude of gusts, as a fraction of the wind speed");
  v.number("gust_period_s", c.gust_period_s, {0.01, 1000}, "s", "period of gusts");
  v.number("air_density_kg_per_m3", c.air_density_kg_per_m3, {0, 2000}, "kg/m3", "density of the air");
  v.number("drag_coefficient", c.drag_coefficient, {0, 10}, "1",
           "drag coefficient: pressure over the stagnation pressure of the air");
}

template <class V>
void visitFields(V& v, EnvironmentConfig& c) {
  v.vector("gravity_m_per_s2", c.gravity_m_per_s2, {-100, 100}, "m/s2",
           "gravitational acceleration in the tissue frame");
  v.text("world_frame", c.world_frame, "tf frame in which the tissue frame is placed");
  v.text("tissue_frame", c.tissue_frame, "tf frame of bodies, cameras, surface and forces");
  v.vector("tissue_position_m", c.tissue_position_m, {-1e4, 1e4}, "m",
           "position of the tissue frame's origin in the world frame");
  v.vector("tissue_rotation_deg", c.tissue_rotation_deg, kAngle, "deg",
           "rotation of the tissue frame: turns about the world's x, then y, then z axis");
  v.vector("scan_origin_m", c.scan_origin_m, {-10, 10}, "m",
           "position of the tissue frame's origin in the scan of the bodies, along the tissue frame's axes; exports in "
           "lps_mm then match the scan");
  v.group("wind", c.wind, "moving air, which pushes bodies with structure surface");
}

template <class V>
void visitFields(V& v, CollisionConfig& c) {
  v.boolean("enabled", c.enabled, "collisions of bodies with themselves, each other and the flaps of cuts");
  v.number("distance_m", c.distance_m, {0, 1}, "m",
           "smallest distance between nodes, or between the surfaces of cells that are partly tissue; 0: the mean "
           "length of springs");
  v.number("friction", c.friction, {0, 10}, "1", "Coulomb friction coefficient");
  v.number("restitution", c.restitution, {0, 1}, "1",
           "coefficient of restitution: speed after over speed before a collision");
}

template <class V>
void visitFields(V& v, ObstacleConfig& c) {
  v.text("name", c.name, "name of the obstacle, unique");
  v.choice("shape", c.shape,
           {{"plane", ObstacleShape::kPlane},
            {"sphere", ObstacleShape::kSphere},
            {"capsule", ObstacleShape::kCapsule},
            {"box", ObstacleShape::kBox}},
           "shape of the obstacle, which nodes do not enter");
  v.vector("position_m", c.position_m, kCoordinate, "m",
           "position of the obstacle's origin in its frame; plane: a point on it");
  v.vector("rotation_deg", c.rotation_deg, kAngle, "deg",
           "rotation of the obstacle: turns about the fixed x, then y, then z axis; tissue is on the +z side of a "
           "plane, and z is the axis of a capsule");
  v.number("radius_m", c.radius_m, {1e-4, 10}, "m", "sphere, capsule: radius");
  v.number("length_m", c.length_m, kLength, "m", "capsule: distance between the centres of its ends");
  v.vector("size_m", c.size_m, {1e-4, 10}, "m", "box: edge lengths");
  v.vector("velocity_m_per_s", c.velocity_m_per_s, {-10, 10}, "m/s", "velocity of the obstacle from the start on");
  v.vector("rotation_deg_per_s", c.rotation_deg_per_s, {-3600, 3600}, "deg/s",
           "angular velocity about the obstacle's origin from the start on: a rotation vector in the tissue frame");
  v.text("frame", c.frame, "tf frame that carries the obstacle; empty: the tissue frame");
  v.number("friction", c.friction, {0, 10}, "1", "Coulomb friction coefficient");
  v.number("restitution", c.restitution, {0, 1}, "1",
           "coefficient of restitution: speed after over speed before a collision");
}

/// Returns the integrators that scenes may name.
inline Choices<Integrator> namesOfIntegrators() {
  Choices<Integrator> out;
  for (const IntegratorTraits& traits : kIntegrators)
    if (traits.about) out.push_back({traits.name, traits.integrator});
  return out;
}

/// Returns "time integrator: leapfrog: explicit, order 2; pd: ...", of the integrators that scenes may name.
inline const char* aboutIntegrators() {
  static const std::string text = [] {
    std::string out;
    for (const IntegratorTraits& traits : kIntegrators)
      if (traits.about)
        out += (out.empty() ? "time integrator: " : "; ") + std::string(traits.name) + ": " + traits.about;
    return out;
  }();
  return text.c_str();
}

template <class V>
void visitFields(V& v, SolverConfig& c) {
  v.number("tick_hz", c.tick_hz, {1, 1000}, "Hz", "ticks per second: the rate of tools, forces and surface");
  v.choice("integrator", c.integrator, namesOfIntegrators(), aboutIntegrators());
  v.choice("start", c.start, {{"rest", SolverStart::kRest}, {"equilibrium", SolverStart::kEquilibrium}},
           "initial state: all at rest, or in equilibrium with weight and the forces on bodies, without obstacles, "
           "wind, contacts and tools; equilibrium needs fixed nodes in every body");
  v.number("dt_fraction", c.dt_fraction, {0.01, 1000}, "1",
           "substep over the largest stable one; leapfrog with a stiffness_damping_ratio of xi needs less than sqrt(1 "
           "+ xi^2) - xi");
  v.number("dt_fraction_strained", c.dt_fraction_strained, {0.01, 1000}, "1",
           "leapfrog with the stability monitor: the same fraction while the tissue is strained or fast; dt_fraction "
           "if that is less");
  v.boolean("measured_limit", c.measured_limit,
            "leapfrog with the stability monitor, lattices only: measure the fastest mode at the start and lengthen "
            "substeps by as much as it is slower than dt_fraction must assume; they shorten as tissue strains");
  v.integer("substeps", c.substeps, {0, 100000}, "substeps per tick; above 0 it replaces both fractions");
  v.integer("iterations", c.iterations, {1, 10000}, "pd: sweeps over all nodes per substep");
  v.boolean("compensated", c.compensated,
            "leapfrog: compensated (Kahan) sums of displacement and velocity; always used for substeps below 50 us");
  v.boolean("stability_monitor", c.stability_monitor,
            "stability monitor: checks every tick, rolls an unstable one back and recovers from it");
  v.number("recovery_s", c.recovery_s, {0, 10}, "s",
           "stability monitor: simulated time of the recovery after a roll-back");
  v.number(
      "sleep_distance_m", c.sleep_distance_m, {0.01, 100}, "m",
      "distance from its position at rest at which a node is stopped, so that falling fragments come to rest there");
  v.number("sleep_speed_m_per_s", c.sleep_speed_m_per_s, {0, 0.1}, "m/s",
           "leapfrog: speed below which a brick of 4x4x4 nodes, all slower for 0.1 s, is not stepped until something "
           "approaches or moves next to it; 0: never");
  v.integer("max_substeps", c.max_substeps, {1, 100000},
            "largest number of substeps per tick; a scene that needs more at rest, by the measured limit if there is "
            "one, is refused");
  v.number("real_time_factor", c.real_time_factor, {0.01, 1000}, "1",
           "spacing_m: auto: simulated seconds per second of wall-clock time that must be reached");
  v.choice(
      "backend", c.backend, {{"auto", Backend::kAuto}, {"gpu", Backend::kGpu}, {"cpu", Backend::kCpu}},
      "backend that steps the tissue: GPU kernels or SIMD threads; auto: the GPU if it is real hardware, else the CPU");
  v.integer("threads", c.threads, {0, 256},
            "CPU backend: number of threads; 0: one per processor that may be used (affinity, cgroup cpu.max)");
  v.integer("device", c.device, {-1, 31},
            "index of the EGL device, as listed by `viscera check`; -1: the first that works");
}

}  // namespace viscera
