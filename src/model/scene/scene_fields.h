// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "model/scene/body_fields.h"
#include "model/scene/integrators.h"
#include "model/scene/tool_kinds.h"
#include "viscera/layout/limits.h"
#include "viscera/model/scene/camera_config.h"
#include "viscera/model/scene/environment_config.h"
#include "viscera/model/scene/knot_kind.h"
#include "viscera/model/scene/plumb_bob.h"
#include "viscera/model/scene/solver_config.h"
#include "viscera/model/scene/thread_config.h"

namespace viscera {

// The one list of scene keys, with body_fields.h; what a visitor offers is in field_ranges.h.

/// The tool kinds by their names.
inline std::vector<Choice<ToolMode>> toolChoices() {
  std::vector<Choice<ToolMode>> choices;
  for (const ToolKind& kind : kToolKinds) choices.push_back({kind.name, kind.mode});
  return choices;
}

constexpr Range kTipReach{1e-4, 1};     // m: of a tool
constexpr Range kReleaseSpeed{0, 100};  // m/s

template <class V>
void visitFields(V& v, ProbeConfig& c) {
  v.number("radius_m", c.radius_m, kTipReach, "m", "radius of the tip's sphere");
}

template <class V>
void visitFields(V& v, GrabConfig& c) {
  v.number("radius_m", c.radius_m, kTipReach, "m", "nodes within this distance of the tip are held");
  v.number("release_speed_m_per_s", c.release_speed_m_per_s, kReleaseSpeed, "m/s", "largest node speed after release");
}

template <class V>
void visitFields(V& v, CutConfig& c) {
  v.number("blade_length_m", c.blade_length_m, kTipReach, "m", "length of the blade, from the tip");
  v.choice(
      "blade_side", c.blade_side,
      {{"shaft", BladeSide::kShaft}, {"ahead", BladeSide::kAhead}, {"both", BladeSide::kBoth}},
      "where it lies: shaft: from the tip back along the shaft (+z of the stylus), as a knife's; ahead: from the tip "
      "on (-z), as a wire that the hand aims; both: its length on each side");
  v.number(
      "friction_n_per_m", c.friction_n_per_m, {0, 1e4}, "N/m",
      "in tissue that resists blades: of both walls together, per length of blade in it; against the way through it, "
      "in its own wound too");
  v.number(
      "point_width_m", c.point_width_m, {0, 0.1}, "m",
      "in tissue that resists blades: what the tip parts, as the blade or needle is pushed along itself, is so wide; "
      "0: it parts nothing and is not felt");
}

template <class V>
void visitFields(V& v, CutParticlesConfig& c) {
  v.number("eraser_radius_m", c.eraser_radius_m, {1e-5, 1}, "m", "nodes within this distance of the blade are erased");
}

template <class V>
void visitFields(V& v, SuctionConfig& c) {
  v.number("radius_m", c.radius_m, kTipReach, "m", "of the cup: nodes within this distance of the tip are held");
  v.number("max_force_n", c.max_force_n, {0, 1e3}, "N",
           "it lets go after a tick whose reaction force is larger, and holds nothing until it is switched off and on");
  v.number("release_speed_m_per_s", c.release_speed_m_per_s, kReleaseSpeed, "m/s", "largest node speed after release");
}

template <class V>
void visitFields(V& v, ScissorsConfig& c) {
  v.number("blade_length_m", c.blade_length_m, kTipReach, "m", "from the pivot, which is behind the tips, to these");
  v.number("opening_deg", c.opening_deg, {5, 120}, "deg", "from blade to blade, when they begin to close");
  v.number("closing_s", c.closing_s, {0.02, 10}, "s", "time from open to closed, while the button is held");
}

template <class V>
void visitFields(V& v, GrasperConfig& c) {
  v.number("radius_m", c.radius_m, kTipReach, "m", "nodes within this distance of the tip are between the jaws");
  v.number("jaw_length_m", c.jaw_length_m, kTipReach, "m",
           "from the pivot, which is behind the tips, to these; what has slid so far is lost");
  v.number("opening_deg", c.opening_deg, {5, 120}, "deg", "from jaw to jaw, when they are open: along x of the stylus");
  v.number("max_force_n", c.max_force_n, {0, 1e3}, "N",
           "friction of the jaws: above this what they hold slides in them");
  v.number("release_speed_m_per_s", c.release_speed_m_per_s, kReleaseSpeed, "m/s", "largest node speed after release");
}

template <class V>
void visitFields(V& v, CauteryConfig& c) {
  v.number("radius_m", c.radius_m, {1e-4, 0.1}, "m", "of its tip, a sphere");
  v.number("power_w", c.power_w, {0, 400}, "W", "into the tissue that the tip touches while it has this mode");
}

template <class V>
void visitFields(V& v, ClipConfig& c) {
  v.number("jaw_length_m", c.jaw_length_m, kTipReach, "m", "from the pivot, which is behind the tips, to these");
  v.number("opening_m", c.opening_m, kTipReach, "m", "between the jaws: along x of the stylus");
  v.number("width_m", c.width_m, {1e-4, 0.1}, "m",
           "of a clip, along y of the stylus; nodes half a spacing beside it are taken too");
  v.number("gap_m", c.gap_m, {0, 0.1}, "m", "between the legs of a closed clip; solid tissue stays 0.4 of itself");
  v.number("force_n", c.force_n, {0.01, 1e3}, "N", "with which a clip closes and stays closed");
  v.integer("magazine", c.magazine, {1, static_cast<double>(kMostClips)}, "clips that there are until a reset");
}

template <class V>
void visitFields(V& v, StylusConfig& c) {
  const std::vector<Choice<ToolMode>> modes = toolChoices();
  v.text("name", c.name, "name: its topics are `<name>/measured_cp` and so on");
  v.choice("idle", c.idle, modes, "what it does with no button pressed");
  v.choice("button1", c.button1, modes, "what it does while button 1 is pressed");
  v.choice("button2", c.button2, modes, "what it does while button 2 is pressed; goes before button 1");
  v.group("probe", c.probe, "probe: a sphere at the tip pushes nodes out of its way");
  v.group("grab", c.grab, "grab: takes the nodes around the tip when it begins and holds them");
  v.group("cut", c.cut, "cut: a blade cuts the springs that it crosses");
  v.group("cut_particles", c.cut_particles, "cut_particles: the same blade erases the springs of nodes near it");
  v.group("suction", c.suction, "suction: holds the nodes around the tip as grab does, up to a force");
  v.group("scissors", c.scissors, "scissors: two blades that close when they begin and cut what is between them");
  v.group("grasper", c.grasper, "grasper: two jaws hold the nodes around the tip, up to their friction");
  v.group("clip", c.clip, "clip: two jaws that have closed set a clip on what is between them");
  v.group("cautery", c.cautery, "cautery: a probe whose tip burns what it touches (docs/lessons/cautery.md)");
  v.number("shaft_length_m", c.shaft_length_m, {0.001, 1}, "m",
           "length of the drawn shaft from the tip back, with a thickness of a twentieth; tissue does not touch it");
  v.number("jaw_closing_s", c.jaw_closing_s, {0.02, 10}, "s",
           "time from open to closed of jaws that a button closes, but for scissors");
  v.number("max_force_n", c.max_force_n, {0, 1e3}, "N", "reaction force is saturated here");
  v.number("max_force_rate_n_per_s", c.max_force_rate_n_per_s, {1, 1e6}, "N/s", "reaction force changes no faster");
  v.number("max_torque_nm", c.max_torque_nm, {0, 1e2}, "N m", "reaction torque is saturated here");
  v.number("max_torque_rate_nm_per_s", c.max_torque_rate_nm_per_s, {0.01, 1e5}, "N m/s",
           "reaction torque changes no faster");
  v.number("stale_after_s", c.stale_after_s, {0.001, 60}, "s", "a pose older than this is no pose: no tool, no force");
  v.number("workspace_m", c.workspace_m, {0.01, 100}, "m", "a pose farther than this from the tissue frame is refused");
}

template <class V>
void visitFields(V& v, PlumbBob& c) {
  constexpr Range kCoefficient{-10, 10};
  v.number("k1", c.k1, kCoefficient, "1", "radial, with the square of the tangent; below 0: a barrel");
  v.number("k2", c.k2, kCoefficient, "1", "radial, with its fourth power");
  v.number("p1", c.p1, kCoefficient, "1", "tangential, along the image's columns");
  v.number("p2", c.p2, kCoefficient, "1", "tangential, along its rows");
  v.number("k3", c.k3, kCoefficient, "1", "radial, with its sixth power");
}

template <class V>
void visitFields(V& v, CameraConfig& c) {
  v.text("name", c.name, "name: its topics are `<name>/image_raw` and `<name>/camera_info`");
  v.vector("position_m", c.position_m, kCoordinate, "m", "eye, tissue frame");
  v.vector("target_m", c.target_m, kCoordinate, "m", "point looked at, tissue frame");
  v.vector("up", c.up, kDirection, "", "direction that is up in the image");
  v.number("vertical_fov_deg", c.vertical_fov_deg, {1, 150}, "deg", "vertical field of view");
  v.integer("width_px", c.width_px, {16, 4096}, "image width");
  v.integer("height_px", c.height_px, {16, 4096}, "image height");
  v.number("rate_hz", c.rate_hz, {0.1, 240}, "Hz", "images per second of simulated time, at most one per tick");
  v.integer("supersampling", c.supersampling, {0, 2},
            "antialiasing: pixels drawn per image pixel along each axis; 0: 2, and with a software renderer tissue is "
            "drawn so but lit once per pixel, four times at edges only (docs/benchmarks.md#picture)");
  v.names("overlays", c.overlays, "what is drawn over the tissue; changed at run time by the service set_overlays");
  v.number("strain_range", c.strain_range, {0.001, 10}, "1", "overlay strain: what the end of the legend stands for");
  v.boolean("draw_hidden", c.draw_hidden,
            "work out what cannot be seen too, for comparison: pictures are the same (docs/hidden.md)");
  v.text(
      "frame", c.frame,
      "tf frame that carries it, as an endoscope: `position_m`, `target_m` and `up` are then in this frame; one whose "
      "name ends in `_optical` or `_optical_frame` is the optical frame itself (z forward, x right)");
  v.group("distortion", c.distortion,
          "of the lens, plumb_bob as in CameraInfo, whose D it is; all 0: a pinhole (docs/detail.md#looks)");
  v.choice(
      "light", c.light, {{"lamp", CameraLight::kLamp}, {"lens", CameraLight::kLens}},
      "what it sees by: a lamp above the lens, as bright everywhere; or light at the lens, as an endoscope's, that "
      "fades with the square of the distance and is at `target_m` as bright as the lamp");
  v.number("light_cone_deg", c.light_cone_deg, {10, 170}, "deg",
           "light lens: full angle of the cone at whose rim half of the light is left");
  v.number("contact_shadows", c.contact_shadows, {0, 1}, "1",
           "how dark it becomes between tools and tissue that they touch or nearly do; 0: no darker than beside them");
  v.number(
      "stereo_baseline_m", c.stereo_baseline_m, {0, 1}, "m",
      "distance of a right eye from this one, which is the left: topics `<name>/left` and `<name>/right`; 0: none");
}

template <class V>
void visitFields(V& v, WindConfig& c) {
  v.vector("velocity_m_per_s", c.velocity_m_per_s, {-100, 100}, "m/s", "mean velocity of the air, tissue frame");
  v.number("gust_ratio", c.gust_ratio, {0, 10}, "1", "gusts: speed swings by this share of it");
  v.number("gust_period_s", c.gust_period_s, {0.01, 1000}, "s", "gusts: period");
  v.number("air_density_kg_per_m3", c.air_density_kg_per_m3, {0, 2000}, "kg/m3", "density of what blows");
  v.number("drag_coefficient", c.drag_coefficient, {0, 10}, "1", "pressure over that of the stopped air");
}

template <class V>
void visitFields(V& v, EnvironmentConfig& c) {
  v.vector("gravity_m_per_s2", c.gravity_m_per_s2, {-100, 100}, "m/s2", "gravity, tissue frame");
  v.text("world_frame", c.world_frame, "tf frame in which the tissue frame is placed");
  v.text("tissue_frame", c.tissue_frame, "tf frame of bodies, cameras, surface and forces");
  v.vector("tissue_position_m", c.tissue_position_m, {-1e4, 1e4}, "m", "origin of the tissue frame in the world frame");
  v.vector("tissue_rotation_deg", c.tissue_rotation_deg, kAngle, "deg",
           "turns about the world's x, then y, then z axis");
  v.vector("scan_origin_m", c.scan_origin_m, {-10, 10}, "m",
           "origin of the tissue frame in the scan that bodies are from, along the tissue frame's axes: exports in "
           "lps_mm lie over the scan");
  v.group("wind", c.wind, "moving air; it pushes at bodies with structure surface");
}

template <class V>
void visitFields(V& v, CollisionConfig& c) {
  v.boolean("enabled", c.enabled, "bodies collide with themselves, each other and the flaps of cuts");
  v.number("distance_m", c.distance_m, {0, 1}, "m",
           "nodes, or the surfaces of cells that are tissue in part, are kept this far apart; 0: the mean length of "
           "springs");
  v.number("friction", c.friction, {0, 10}, "1", "Coulomb's coefficient");
  v.number("restitution", c.restitution, {0, 1}, "1", "speed after over speed before a collision");
}

template <class V>
void visitFields(V& v, ObstacleConfig& c) {
  v.text("name", c.name, "name, unique");
  v.choice("shape", c.shape,
           {{"plane", ObstacleShape::kPlane},
            {"sphere", ObstacleShape::kSphere},
            {"capsule", ObstacleShape::kCapsule},
            {"box", ObstacleShape::kBox}},
           "what nodes do not enter");
  v.vector("position_m", c.position_m, kCoordinate, "m", "its origin in its frame; of a plane: a point of it");
  v.vector("rotation_deg", c.rotation_deg, kAngle, "deg",
           "turns about fixed x, then y, then z; a plane's tissue is on its +z side, a capsule lies along z");
  v.number("radius_m", c.radius_m, {1e-4, 10}, "m", "sphere, capsule: radius");
  v.number("length_m", c.length_m, kLength, "m", "capsule: between the centres of its ends");
  v.vector("size_m", c.size_m, {1e-4, 10}, "m", "box: edge lengths");
  v.vector("velocity_m_per_s", c.velocity_m_per_s, {-10, 10}, "m/s", "it moves so from the start on");
  v.vector("rotation_deg_per_s", c.rotation_deg_per_s, {-3600, 3600}, "deg/s",
           "and turns so about its origin: a rotation vector, tissue frame");
  v.text("frame", c.frame, "tf frame that carries it; empty: the tissue frame");
  v.number("friction", c.friction, {0, 10}, "1", "Coulomb's coefficient");
  v.number("restitution", c.restitution, {0, 1}, "1", "speed after over speed before a collision");
}

template <class V>
void visitFields(V& v, ThreadPlace& c) {
  v.vector("position_m", c.position_m, kCoordinate, "m", "place, tissue frame");
}

template <class V>
void visitFields(V& v, ThreadChannelConfig& c) {
  v.text("body", c.body, "name of the body; empty: the first");
  v.vector("position_m", c.position_m, kCoordinate, "m",
           "place at rest, tissue frame; the thread passes within a link");
}

template <class V>
void visitFields(V& v, NeedleConfig& c) {
  v.choice("arc", c.arc,
           {{"none", NeedleArc::kNone},
            {"half_circle", NeedleArc::kHalfCircle},
            {"three_eighths", NeedleArc::kThreeEighths}},
           "how much of a circle it is; none: there is no needle");
  v.number("radius_m", c.radius_m, {1e-3, 0.1}, "m", "of this circle");
  v.number("wire_radius_m", c.wire_radius_m, {5e-5, 2e-3}, "m",
           "half its thickness; at most 0.2 times its circle's radius");
  v.number("puncture_n", c.puncture_n, {0, 100}, "N", "force at which skin gives way to its tip; 0: 5 mm2 times E");
  v.number("cutting_n", c.cutting_n, {0, 100}, "N",
           "force before its tip inside; 0: a third of that of puncture; not above that");
  v.number("friction_n_per_m", c.friction_n_per_m, {0, 1e5}, "N/m", "along its shaft in tissue; 0: 0.1 mm times E");
  v.vector("rotation_deg", c.rotation_deg, kAngle, "deg",
           "at first: turns about fixed x, then y, then z of an arc about y whose tip heads for z from its place on x");
}

inline Choices<KnotKind> knotChoices() {
  Choices<KnotKind> out;
  for (size_t k = 1; k < kKnotNames.size(); ++k) out.push_back({kKnotNames[k], static_cast<KnotKind>(k)});
  return out;
}

template <class V>
void visitFields(V& v, ThreadTie& c) {
  v.number("at_s", c.at_s, {0, 1e5}, "s", "when its two tails are brought together, since the start or a reset");
  v.choice("knot", c.knot, knotChoices(), "what is thrown");
  v.number("tension_n", c.tension_n, {1e-3, 100}, "N", "to which the loop is drawn before it is tied");
  v.number("holds_n", c.holds_n, {0, 1000}, "N", "the knot slips at more; 0: by knot and thread (docs/thread.md 4)");
  v.choice("to", c.to, {{"other_tail", TieTo::kOtherTail}, {"strand", TieTo::kStrand}},
           "its tails to each other, or the nearer tail to a strand, as where a running suture ends");
  v.vector("strand_m", c.strand_m, kCoordinate, "m",
           "the strand is the one outside of tissue that is nearest to this place");
}

template <class V>
void visitFields(V& v, ThreadConfig& c) {
  const Choices<ThreadEnd> ends = {{"free", ThreadEnd::kFree}, {"fixed", ThreadEnd::kFixed}};
  v.text("name", c.name, "name, unique");
  v.choice("material", c.material,
           {{"silk", ThreadMaterial::kSilk},
            {"nylon", ThreadMaterial::kNylon},
            {"polypropylene", ThreadMaterial::kPolypropylene}},
           "Young's modulus, density and share of bending of those that are 0 (docs/thread.md)");
  v.choice("usp", c.usp,
           {{"2-0", ThreadSize::kUsp2},
            {"3-0", ThreadSize::kUsp3},
            {"4-0", ThreadSize::kUsp4},
            {"5-0", ThreadSize::kUsp5},
            {"6-0", ThreadSize::kUsp6}},
           "size, where radius_m is 0");
  v.number("radius_m", c.radius_m, {0, 2e-3}, "m", "radius; 0: of its size");
  v.number("young_modulus_pa", c.young_modulus_pa, {0, 1e12}, "Pa", "against bending; 0: of the material");
  v.number("density_kg_per_m3", c.density_kg_per_m3, {0, 2e4}, "kg/m3", "density; 0: of the material");
  v.number("bending_share", c.bending_share, {0, 1}, "1",
           "of the bending stiffness of a solid thread, that of a braid is less; 0: of the material");
  v.number("drag_per_s", c.drag_per_s, {0, 1e4}, "1/s", "speed lost to the air");
  v.number("length_m", c.length_m, kLength, "m", "length; beyond its path it goes on straight; 0: that of its path");
  v.number("spacing_m", c.spacing_m, {1e-4, 0.1}, "m", "length of its links");
  v.vector("position_m", c.position_m, kCoordinate, "m", "where it starts, tissue frame");
  v.list("path", c.path, 1000, "places that it goes through from there at first, in straight lines; one at least");
  v.choice("start", c.start, ends, "the end at position_m: free, or fixed where it is");
  v.choice("end", c.end, ends, "the other end");
  v.list("channels", c.channels, 200,
         "points of tissue that it goes through at first, in the order of its path, a link or more apart "
         "(docs/thread.md 5)");
  v.number("friction", c.friction, {0, 2}, "1", "in channels, as of a rope on a drum");
  v.number("through_n_per_m", c.through_n_per_m, {0, 1e4}, "N/m",
           "friction of the length that is in tissue; 0: 0.1 mm times Young's modulus of the tissue");
  v.number("pull_out_n", c.pull_out_n, {0, 1e3}, "N", "the tissue tears at a channel that pulls more; 0: of tissue");
  v.choice(
      "tissue", c.tissue,
      {{"phantom", StitchedTissue::kPhantom}, {"bowel", StitchedTissue::kBowel}, {"fascia", StitchedTissue::kFascia}},
      "what tears: bowel 4.6 N; fascia 45 N per mm of bite_m; phantom Young's modulus x bite_m x depth_m");
  v.number("bite_m", c.bite_m, {1e-4, 0.1}, "m", "from the wound to where a stitch enters");
  v.number("depth_m", c.depth_m, {1e-4, 0.1}, "m", "of a stitch in the tissue");
  v.group("needle", c.needle, "needle on its start, which is then free, its tail at position_m (docs/thread.md)");
  v.list("ties", c.ties, 16, "knots that no hand throws, in the order of their times (docs/thread.md 4)");
}

/// Those of scenes.
inline Choices<Integrator> namesOfIntegrators() {
  Choices<Integrator> out;
  for (const IntegratorTraits& traits : kIntegrators)
    if (traits.about) out.push_back({traits.name, traits.integrator});
  return out;
}

/// "leapfrog: explicit, order 2; pd: ...", of those of scenes.
inline const char* aboutIntegrators() {
  static const std::string text = [] {
    std::string out;
    for (const IntegratorTraits& traits : kIntegrators)
      if (traits.about) out += (out.empty() ? "" : "; ") + std::string(traits.name) + ": " + traits.about;
    return out;
  }();
  return text.c_str();
}

template <class V>
void visitFields(V& v, SolverConfig& c) {
  v.number("tick_hz", c.tick_hz, {1, 1000}, "Hz", "ticks per second: tools, forces and surface follow at this rate");
  v.choice("integrator", c.integrator, namesOfIntegrators(), aboutIntegrators());
  v.choice(
      "start", c.start, {{"rest", SolverStart::kRest}, {"equilibrium", SolverStart::kEquilibrium}},
      "the state that it begins in: all at rest, or in equilibrium with its weight and the forces on bodies, without "
      "obstacles, wind, contacts and tools; every body has fixed nodes");
  v.number("dt_fraction", c.dt_fraction, {0.01, 1000}, "1",
           "substep over the largest stable one; leapfrog with a dashpot of ratio xi needs less than "
           "sqrt(1 + xi^2) - xi");
  v.number(
      "dt_fraction_strained", c.dt_fraction_strained, {0.01, 1000}, "1",
      "leapfrog under the governor: the same while the tissue is strained or fast; dt_fraction where that is less");
  v.boolean(
      "measured_limit", c.measured_limit,
      "leapfrog under the governor, of lattices: substeps as much longer as the fastest mode, measured at the start, "
      "is slower than dt_fraction must assume; shorter again as tissue strains");
  v.integer("substeps", c.substeps, {0, 100000}, "substeps per tick; above 0 it decides instead of both fractions");
  v.integer("iterations", c.iterations, {1, 10000}, "pd: sweeps over all nodes per substep");
  v.boolean("compensated", c.compensated,
            "leapfrog: sum displacement and velocity with compensation (Kahan); always where substeps are below 50 us");
  v.boolean("governor", c.governor, "watch every tick, roll an explosion back and recover from it");
  v.number("recovery_s", c.recovery_s, {0, 10}, "s",
           "governor: simulated time for which tissue recovers after a roll-back");
  v.number("sleep_distance_m", c.sleep_distance_m, {0.01, 100}, "m",
           "a node is stopped this far from its place at rest: where fragments that fall come to lie");
  v.number("sleep_speed_m_per_s", c.sleep_speed_m_per_s, {0, 0.1}, "m/s",
           "leapfrog: bricks of 4x4x4 nodes that are all slower for 0.1 s are not stepped until something nears or "
           "moves beside them; 0: never");
  v.integer("max_substeps", c.max_substeps, {1, 100000},
            "a scene that needs more substeps per tick at rest, measured ones where they are measured, is refused");
  v.number("real_time_factor", c.real_time_factor, {0.01, 1000}, "1",
           "spacing_m: auto: seconds of tissue per second of clock that it must reach");
  v.choice("backend", c.backend, {{"auto", Backend::kAuto}, {"gpu", Backend::kGpu}, {"cpu", Backend::kCpu}},
           "what steps the tissue: GPU kernels or SIMD threads; auto: the GPU if it is a real one, else the CPU");
  v.integer("threads", c.threads, {0, 256},
            "CPU backend: threads; 0: one per processor that may be used (affinity, cgroup cpu.max)");
  v.integer("device", c.device, {-1, 31}, "EGL device to take, as listed by `viscera check`; -1: the first that works");
}

}  // namespace viscera
