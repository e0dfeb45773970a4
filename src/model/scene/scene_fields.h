// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <vector>

#include "model/scene/integrators.h"
#include "model/scene/tool_kinds.h"
#include "viscera/layout/limits.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

// The one list of scene keys. A visitor offers, for each kind of key, one of
// * number(key, double&, Range, unit, text)
// * numberOrAuto(key, double&, bool& is_auto, Range, unit, text)
// * integer(key, int&, Range, text)
// * text(key, std::string&, text)
// * boolean(key, bool&, text)
// * vector(key, Vector3d&, Range, unit, text)
// * choice(key, Enum&, {{name, value}...}, text)
// * group(key, Struct&, text)
// * list(key, std::vector<Struct>&, max_count, text, defaults of an item = {})
// * formerNumber(old key, group, key, double&, Range, unit): what `group.key` was called before; after that group

/// Accepted values, both ends included.
struct Range {
  double min, max;
};
template <class E>
struct Choice {
  const char* name;
  E value;
};
template <class E>
using Choices = std::vector<Choice<E>>;

/// The tool kinds by their names.
inline std::vector<Choice<ToolMode>> toolChoices() {
  std::vector<Choice<ToolMode>> choices;
  for (const ToolKind& kind : kToolKinds) choices.push_back({kind.name, kind.mode});
  return choices;
}

constexpr int kMostLayers = 4;
constexpr Range kLength{0, 10};         // m: organs and rooms
constexpr Range kCoordinate{-10, 10};   // m
constexpr Range kDirection{-1e3, 1e3};  // any length but zero
constexpr Range kAngle{-360, 360};      // degrees
constexpr Range kTipReach{1e-4, 1};     // m: of a tool
constexpr Range kEraserReach{1e-5, 1};  // m
constexpr Range kReleaseSpeed{0, 100};  // m/s

template <class V>
void visitFields(V& v, FixedConfig& c) {
  v.choice("shape", c.shape,
           {{"box", FixedShape::kBox},
            {"sphere", FixedShape::kSphere},
            {"plane", FixedShape::kPlane},
            {"part", FixedShape::kPart}},
           "which nodes are held in space; coordinates are the body's own, before its pose. With material.cells: "
           "moments, nodes within half a cell of the region are held too, and nodes lie on a plane that is parallel to "
           "the lattice (docs/fill_rule.md)");
  v.vector("min_m", c.min_m, kCoordinate, "m", "box: lower corner");
  v.vector("max_m", c.max_m, kCoordinate, "m", "box: upper corner");
  v.vector("center_m", c.center_m, kCoordinate, "m", "sphere: centre");
  v.number("radius_m", c.radius_m, kLength, "m", "sphere: radius");
  v.vector("point_m", c.point_m, kCoordinate, "m", "plane: a point of it");
  v.vector("normal", c.normal, kDirection, "", "plane: nodes on the side it points away from are held");
  v.text("part", c.part, "part: name of a part of the mesh or phantom");
}

template <class V>
void visitFields(V& v, MaterialConfig& c) {
  v.number("young_modulus_pa", c.young_modulus_pa, {1, 1e9}, "Pa", "Young's modulus E");
  v.number(
      "poisson_ratio", c.poisson_ratio, {0, 0.49}, "1",
      "Poisson's ratio nu; 1/4 costs least (with cells springs any other adds a pass over them); structure surface and "
      "tetrahedra have that of their springs, 1/3 and 1/4");
  v.number("density_kg_per_m3", c.density_kg_per_m3, {1, 1e5}, "kg/m3", "mass density");
  v.number("drag_per_s", c.drag_per_s, {0, 1e4}, "1/s", "node drag gamma: every velocity decays at this rate");
  v.number("dashpot_ratio", c.dashpot_ratio, {0, 0.5}, "1",
           "axial dashpot: damping ratio at the highest frequency; 0 leaves it out of the kernel");
  v.choice("weights", c.weights, {{"cell", Weights::kCell}, {"paper", Weights::kPaper}},
           "assembly of springs and masses: per solid cell (exact), or VR05's uniform weights");
  v.choice("cells", c.cells, {{"auto", Cells::kAuto}, {"moments", Cells::kMoments}, {"springs", Cells::kSprings}},
           "what cells resist with: springs corrected by the moments of the part of each cell that is tissue (cells at "
           "the surface are filled in part), or springs alone (cells are full or empty); auto is moments in structure "
           "lattice and explicit with weights cell, else springs");
}

template <class V>
void visitFields(V& v, PartConfig& c) {
  v.text("part", c.part, "name of a part of the mesh or phantom");
  v.number("young_modulus_pa", c.young_modulus_pa, {1, 1e9}, "Pa", "Young's modulus E of this part");
  v.number("poisson_ratio", c.poisson_ratio, {0, 0.49}, "1", "Poisson's ratio nu of this part");
  v.number("density_kg_per_m3", c.density_kg_per_m3, {1, 1e5}, "kg/m3", "mass density of this part");
}

template <class V>
void visitFields(V& v, ImportLimits& c) {
  v.number("max_file_mb", c.max_file_mb, {0.001, 1e6}, "MB", "size of the file, and of buffers that it refers to");
  v.integer("max_depth", c.max_depth, {1, 4000}, "glTF: nodes within nodes");
  v.integer("max_instances", c.max_instances, {1, 1e7}, "glTF: nodes, those with several parents once for each");
  v.integer("max_triangles", c.max_triangles, {1, 1e9}, "triangles, of each instance anew");
  v.boolean("other_formats", c.other_formats,
            "try formats that are not listed under `mesh_file` too, whose importers have limits of neither depth nor "
            "instances: for files that you trust");
}

template <class V>
void visitFields(V& v, LayerConfig& c) {
  v.number("depth_m", c.depth_m, kLength, "m", "below the skin, to which it reaches");
  v.vector("color", c.color, {0, 1}, "1", "red, green, blue");
}

template <class V>
void visitFields(V& v, BodyConfig& c) {
  v.text("name", c.name, "name, unique");
  v.choice("source", c.source,
           {{"phantom", TissueSource::kPhantom},
            {"mesh", TissueSource::kMesh},
            {"box", TissueSource::kBox},
            {"sheet", TissueSource::kSheet},
            {"ball", TissueSource::kBall}},
           "where the tissue comes from: the built-in heart, a mesh file, a box, a flat sheet, a ball");
  v.choice("structure", c.structure,
           {{"lattice", Structure::kLattice},
            {"explicit", Structure::kExplicit},
            {"surface", Structure::kSurface},
            {"tetrahedra", Structure::kTetrahedra}},
           "what is made of it: a solid lattice; the same with explicit connections (VR05 2.5.1); springs along the "
           "edges of its surface (cloth, membranes, vessel walls); springs along the edges of a tetrahedral mesh");
  v.text("mesh_file", c.mesh_file,
         "mesh: OBJ, STL, PLY, glTF or GLB file, for tetrahedra a Gmsh .msh file; relative to the scene file");
  v.number("unit_scale_m", c.unit_scale_m, {1e-9, 1e3}, "m", "mesh: metres per unit of the file");
  v.group("import_limits", c.import_limits,
          "mesh: what the file may hold; what holds more is refused before it is read");
  v.choice("up_axis", c.up_axis, {{"z", UpAxis::kZ}, {"y", UpAxis::kY}},
           "mesh: axis of the file that points up and is turned to z; y in glTF");
  v.boolean("centered", c.centered, "mesh: move the middle of its bounding box to the body's origin");
  v.boolean("textures", c.textures,
            "mesh: take the colours, textures, normal maps and roughness that the file gives (docs/detail.md)");
  v.text(
      "detail_mesh", c.detail_mesh,
      "a finer mesh of the same surface, of any number of faces, placed as mesh_file is: its normals and colours are "
      "baked onto the skin once, and kept in the user's cache; structure lattice and explicit");
  v.integer("skin_faces", c.skin_faces, {0, 20e6},
            "above 0: the surface is simplified to about so many faces, and what it was is baked onto them as by "
            "detail_mesh; the lattice is made of all of it");
  v.integer("detail_px", c.detail_px, {64, 16384}, "side of the square of texels that detail is baked to, at most");
  v.number("phantom_length_m", c.phantom_length_m, {0.01, 1}, "m", "phantom: base to apex");
  v.number("phantom_wall_scale", c.phantom_wall_scale, {0.1, 2}, "1", "phantom: multiplies every wall thickness");
  v.vector("box_size_m", c.box_size_m, {1e-4, 10}, "m",
           "box: edge lengths, centred on the body's origin; sheet: x and y");
  v.number("ball_radius_m", c.ball_radius_m, {1e-4, 10}, "m", "ball: radius, centred on the body's origin");
  v.number("thickness_m", c.thickness_m, {1e-6, 1}, "m", "structure surface: of the membrane, for mass and stiffness");
  v.number("bending_ratio", c.bending_ratio, {0, 1}, "1",
           "stiffness of springs against bending over that of the springs around: across the edges of a surface, along "
           "one-node-thick parts of an explicit lattice; 0: none. They shorten the stable substep");
  v.vector("force_n", c.force_n, {-1e3, 1e3}, "N", "constant force on the body, spread over its nodes by mass");
  v.numberOrAuto(
      "spacing_m", c.spacing_m, c.auto_spacing, {1e-5, 10}, "m",
      "lattice spacing h, edge length of a surface (the longest of a mesh); auto: the finest lattice that this "
      "machine steps in real time (solver.real_time_factor)");
  v.integer(
      "target_nodes", c.target_nodes, {0, 20e6},
      "node count to reach within 2 %, of surfaces as near as whole triangles come; above 0 it decides instead of "
      "spacing_m");
  v.choice("skin", c.skin,
           {{"auto", SkinSource::kAuto}, {"input", SkinSource::kInput}, {"volume", SkinSource::kVolume}},
           "detailed surface: the input mesh, or extracted from the volume; auto takes the mesh where there is one");
  v.choice("mapping", c.mapping,
           {{"auto", Mapping::kAuto},
            {"one_to_one", Mapping::kOneToOne},
            {"constant", Mapping::kConstant},
            {"interpolated", Mapping::kInterpolated},
            {"along_normal", Mapping::kAlongNormal}},
           "how the skin follows the lattice (docs/mappings.md): each vertex one node (EGVE 3.2), a triangle of nodes "
           "(eqs 4 to 7), that turned by approximate normals (eq 8), or moved along these alone (3.5); auto: the "
           "corners of the cell where cells are tissue in part, else interpolated");
  v.number("skin_spacing_m", c.skin_spacing_m, kLength, "m",
           "phantom, ball: edge length of the skin where it is to be finer than the lattice; 0: the lattice's");
  v.vector("position_m", c.position_m, kCoordinate, "m", "origin of the body in the tissue frame");
  v.vector("rotation_deg", c.rotation_deg, kAngle, "deg", "turns about the fixed x, then y, then z axis");
  v.vector("color", c.color, {0, 1}, "1", "red, green, blue; of what a mesh file gives no colour");
  v.number("roughness", c.roughness, {0, 1}, "1", "of the wet surface: 0 mirrors lamps, 1 is dull");
  v.number("mottling", c.mottling, {0, 3}, "1", "how much lightness, hue and relief vary from place to place; 0: even");
  v.list("layers", c.layers, kMostLayers,
         "what a wound's wall shows below the skin, from the surface down; beyond the "
         "last one: the flesh of `color`");
  v.group("material", c.material, "elastic material");
  const PartConfig as_material{"", c.material.young_modulus_pa, c.material.poisson_ratio, c.material.density_kg_per_m3};
  v.list("parts", c.parts, 64, "parts whose elasticity differs; what is left out is as in `material`", as_material);
  v.list("fixed", c.fixed, 64, "regions whose nodes are held in space");
}

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
  v.number("blade_length_m", c.blade_length_m, kTipReach, "m", "blade from the tip along -z of the stylus");
}

template <class V>
void visitFields(V& v, CutParticlesConfig& c) {
  v.number("eraser_radius_m", c.eraser_radius_m, kEraserReach, "m",
           "nodes within this distance of the blade are erased");
}

template <class V>
void visitFields(V& v, SuctionConfig& c) {
  v.number("radius_m", c.radius_m, kTipReach, "m", "of the cup: nodes within this distance of the tip are held");
  v.number("max_force_n", c.max_force_n, {0, 1e3}, "N",
           "it lets go after a tick whose reaction force is larger, and holds nothing until it is switched off and on");
  v.number("release_speed_m_per_s", c.release_speed_m_per_s, kReleaseSpeed, "m/s", "largest node speed after release");
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
  v.formerNumber("probe_radius_m", "probe", "radius_m", c.probe.radius_m, kTipReach, "m");
  v.formerNumber("grab_radius_m", "grab", "radius_m", c.grab.radius_m, kTipReach, "m");
  v.formerNumber("blade_length_m", "cut", "blade_length_m", c.cut.blade_length_m, kTipReach, "m");
  v.formerNumber("eraser_radius_m", "cut_particles", "eraser_radius_m", c.cut_particles.eraser_radius_m, kEraserReach,
                 "m");
  v.formerNumber("release_speed_m_per_s", "grab", "release_speed_m_per_s", c.grab.release_speed_m_per_s, kReleaseSpeed,
                 "m/s");
  v.number("max_force_n", c.max_force_n, {0, 1e3}, "N", "reaction force is saturated here");
  v.number("max_force_rate_n_per_s", c.max_force_rate_n_per_s, {0, 1e6}, "N/s", "reaction force changes no faster");
  v.number("max_torque_nm", c.max_torque_nm, {0, 1e2}, "N m", "reaction torque is saturated here");
  v.number("max_torque_rate_nm_per_s", c.max_torque_rate_nm_per_s, {0, 1e5}, "N m/s",
           "reaction torque changes no faster");
  v.number("stale_after_s", c.stale_after_s, {0.001, 60}, "s", "a pose older than this is no pose: no tool, no force");
  v.number("workspace_m", c.workspace_m, {0.01, 100}, "m", "a pose farther than this from the tissue frame is refused");
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
  v.integer("supersampling", c.supersampling, {1, 2}, "antialiasing: pixels drawn per image pixel along each axis");
  v.names("overlays", c.overlays, "what is drawn over the tissue; changed at run time by the service set_overlays");
  v.number("strain_range", c.strain_range, {0.001, 10}, "1", "overlay strain: what the end of the legend stands for");
  v.boolean("draw_hidden", c.draw_hidden,
            "work out what cannot be seen too, for comparison: pictures are the same (docs/hidden.md)");
  v.text(
      "frame", c.frame,
      "tf frame that carries it, as an endoscope: `position_m`, `target_m` and `up` are then in this frame; one whose "
      "name ends in `_optical` or `_optical_frame` is the optical frame itself (z forward, x right)");
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
  v.group("wind", c.wind, "moving air; it pushes at bodies with structure surface");
}

template <class V>
void visitFields(V& v, CollisionConfig& c) {
  v.boolean("enabled", c.enabled, "bodies collide with themselves, each other and the flaps of cuts");
  v.choice(
      "search", c.search, {{"grid", CollisionSearch::kGrid}, {"staggered", CollisionSearch::kStaggered}},
      "how pairs are found: a uniform grid, complete; or GW's staggered partitions with a sort, which misses some");
  v.number("distance_m", c.distance_m, {0, 1}, "m",
           "nodes, or the surfaces of cells that are tissue in part, are kept this far apart; 0: the mean length of "
           "springs");
  v.number("friction", c.friction, {0, 10}, "1", "Coulomb's coefficient");
  v.number("restitution", c.restitution, {0, 1}, "1", "speed after over speed before a collision");
  v.integer("partitions", c.partitions, {1, 8}, "staggered: space partitions, each shifted");
  v.integer("window", c.window, {1, 64}, "staggered: nodes looked at on either side in sorted order");
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

inline Choices<Integrator> namesOfIntegrators() {
  Choices<Integrator> out;
  for (const IntegratorTraits& traits : kIntegrators) out.push_back({traits.name, traits.integrator});
  return out;
}

template <class V>
void visitFields(V& v, SolverConfig& c) {
  v.number("tick_hz", c.tick_hz, {1, 1000}, "Hz", "ticks per second: tools, forces and surface follow at this rate");
  v.choice("integrator", c.integrator, namesOfIntegrators(),
           "leapfrog: explicit, order 2; verlet_paper: as VR05 and GW print it, to compare; vbd, pd: implicit Euler; "
           "multigrid: implicit, a step per tick (TR-BDF2), solved by multigrid, for stiff and nearly incompressible "
           "tissue; CPU "
           "backend, lattices only; auto: leapfrog or multigrid, whichever this machine steps faster, measured at the "
           "start");
  v.choice("start", c.start, {{"rest", SolverStart::kRest}, {"equilibrium", SolverStart::kEquilibrium}},
           "the state that it begins in: all at rest, or as it hangs in its weight and the forces on bodies, without "
           "obstacles, "
           "wind and tools; implicit lattices that are held");
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
  v.integer("iterations", c.iterations, {1, 10000}, "vbd, pd: sweeps over all nodes per substep");
  v.boolean("compensated", c.compensated,
            "leapfrog: sum displacement and velocity with compensation (Kahan); always where substeps are below 50 us");
  v.choice("spring_forces", c.spring_forces, {{"point", SpringForces::kPoint}, {"edge", SpringForces::kEdge}},
           "leapfrog, explicit connections (GW 4): each node sums over its springs; or each spring's force once, then "
           "each node sums them");
  v.boolean("governor", c.governor, "watch every tick, roll an explosion back and recover from it");
  v.number("recovery_s", c.recovery_s, {0, 10}, "s", "governor: simulated time for which pd goes on after a roll-back");
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
  v.integer("threads", c.threads, {0, 256}, "CPU backend: threads; 0: one per processor");
  v.integer("device", c.device, {-1, 31}, "EGL device to take, as listed by `viscera check`; -1: the first that works");
}

template <class V>
void visitFields(V& v, Scene& c) {
  v.text("name", c.name, "name, for reports");
  v.list("bodies", c.bodies, layout::kMaxBodies, "pieces of tissue, at least one");
  v.list("styluses", c.styluses, layout::kMaxStyluses, "tools");
  v.list("cameras", c.cameras, 8, "views");
  v.list("obstacles", c.obstacles, layout::kMaxObstacles, "rigid things that nodes do not enter");
  v.group("collision", c.collision, "bodies against themselves and each other; costs nothing while it is off");
  v.group("environment", c.environment, "gravity and frames");
  v.group("solver", c.solver, "time stepping");
}

}  // namespace viscera
