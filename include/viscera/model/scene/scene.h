// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "viscera/math/types.h"
#include "viscera/model/scene/knot_kind.h"
#include "viscera/model/scene/organ_fit.h"
#include "viscera/model/scene/overlays.h"
#include "viscera/model/scene/plumb_bob.h"

namespace viscera {

// Every field of these structs has one entry in src/model/scene/scene_fields.h, which gives its key, unit, range and
// sentence of documentation; the default is the initialiser here. `viscera keys` prints the table.

enum class TissueSource { kPhantom, kMesh, kBox, kSheet, kBall, kLabels };
enum class Structure { kLattice, kExplicit, kSurface, kTetrahedra };
enum class SpringForces { kPoint, kEdge };
enum class CollisionSearch { kGrid, kStaggered };
enum class ObstacleShape { kPlane, kSphere, kCapsule, kBox };
enum class SkinSource { kAuto, kInput, kVolume };
enum class Mapping { kAuto, kOneToOne, kConstant, kInterpolated, kAlongNormal };  ///< see docs/mappings.md
enum class UpAxis { kZ, kY };
enum class FixedShape { kBox, kSphere, kPlane, kPart };
/// What of a mesh is tissue.
enum class Fill {
  kParts,    ///< the inside of each of its parts
  kEnclosed  ///< what all of them enclose together, gaps closed
};
enum class Integrator { kLeapfrog, kVerletPaper, kPd };
/// What a simulation begins with: everything at rest, or hanging in its weight.
enum class SolverStart { kRest, kEquilibrium };
enum class Backend { kAuto, kGpu, kCpu };
enum class ToolMode {
  kNone = 0,
  kProbe = 1,
  kGrab = 2,
  kCut = 3,
  kCutParticles = 4,
  kSuction = 5,
  kNeedle = 6,
  kScissors = 7,
  kGrasper = 8,
  kClip = 9,
  kCautery = 10
};

/// What a cell of a lattice resists its deformation with (physics.md 1).
enum class Cells {
  kAuto,     ///< what hasMoments() (structure_rules.h) says
  kSprings,  ///< springs, and the energy of its volume: VR05's system; cells are filled or empty
  kMoments   ///< springs corrected by the moments of the part that is filled: bends and twists as the solid does
};

/// How spring and mass weights are assembled (physics.md 1).
enum class Weights {
  kCell,  ///< each solid cell adds k/4 to its edges, k/2 to its face diagonals, m/8 to its nodes
  kPaper  ///< every spring and every node counts in full (VR05)
};

/// Nodes that are held in space. Coordinates are in the body's frame, before its pose is applied.
struct FixedConfig {
  FixedShape shape = FixedShape::kBox;
  Vector3d min_m = Vector3d::Zero();
  Vector3d max_m = Vector3d::Zero();
  Vector3d center_m = Vector3d::Zero();
  double radius_m = 0.01;
  Vector3d point_m = Vector3d::Zero();
  Vector3d normal = Vector3d::UnitZ();  ///< nodes on its negative side are fixed
  std::string part;
};

/// What it takes to part tissue (docs/cutting.md).
struct FractureConfig {
  double toughness_j_per_m2 = 0;  ///< work per area of cut; 0: a blade parts what it crosses, and no one feels it
  bool of_tissue = false;         ///< `toughness_j_per_m2: auto`: it is that of the tissue
};

/// How much shorter tissue would be than it lies there, if nothing held it (docs/cutting.md 6).
struct PrestressConfig {
  double strain = 0;                     ///< along every axis
  Vector3d strains = Vector3d::Zero();   ///< besides, along three axes of its own
  Vector3d axes_deg = Vector3d::Zero();  ///< these: the tissue frame's, turned about fixed x, then y, then z
};

/// What it takes to pull tissue apart (docs/cutting.md 8).
struct TearConfig {
  double toughness_j_per_m2 = 0;  ///< work per area; 0: springs stretch without end
};

/// What runs out of tissue that is cut, as out of a vessel (docs/lessons/bleeding.md).
struct BleedingConfig {
  double flow_ml_per_min = 0;  ///< out of a stump; 0: nothing
  double calibre_m = 0;        ///< of the vessel that is cut through then; 0: of its volume over its length
};

struct MaterialConfig {
  double young_modulus_pa = 20e3;
  double poisson_ratio = 0.25;  ///< 1/4 is what springs give alone; else cells have an energy of volume
  double density_kg_per_m3 = 1060;
  double drag_per_s = 4;
  double dashpot_ratio = 0.2;
  Weights weights = Weights::kCell;
  Cells cells = Cells::kAuto;
  bool thin_walls = false;  ///< walls of few cells bend as the tissue around each cell lets them
  std::string tissue;       ///< preset (docs/tissues.md) of those of the first three that the scene does not give
  FractureConfig cut;
  PrestressConfig prestress;
  TearConfig tear;
  BleedingConfig bleeding;
};

/// Elasticity, toughness, prestress and bleeding of one part of a body, such as a valve. In a scene file, what is left
/// out is as in the body's material.
struct PartConfig {
  std::string part;
  double young_modulus_pa = 20e3;
  double poisson_ratio = 0.25;
  double density_kg_per_m3 = 1060;
  std::string tissue = {};  ///< as in MaterialConfig
  FractureConfig cut = {};
  PrestressConfig prestress = {};
  BleedingConfig bleeding = {};
};

/// What a mesh file may hold. Files are small and what they stand for need not be: nodes that share children grow
/// without end, and libraries that read files recurse.
struct ImportLimits {
  double max_file_mb = 2000;
  int max_depth = 256;
  int max_instances = 100000;
  int max_triangles = 20000000;
  bool other_formats = false;
};

/// A label map, and what it cannot say of itself (docs/scans.md).
struct ScanConfig {
  std::string file;                 ///< relative to the scene file
  std::vector<std::string> labels;  ///< numbers or names; none: all
  std::string names_file;           ///< relative to the scene file; empty: one beside the scan, if any
  std::string axes;
  std::string transform;
  int volume = -1;  ///< -1: the only one
  std::string series;
};

/// What of a wound's wall is seen down to a depth below the skin, and what it takes to part it.
struct LayerConfig {
  double depth_m = 0.001;
  Vector3d color = Vector3d(0.86, 0.66, 0.34);
  double toughness_j_per_m2 = 0;  ///< 0: that of the material or the part
};

struct BodyConfig {
  std::string name = "tissue";
  TissueSource source = TissueSource::kPhantom;
  Structure structure = Structure::kLattice;
  std::string mesh_file;  ///< relative to the scene file
  ScanConfig scan;        ///< of source: labels
  double unit_scale_m = 1;
  ImportLimits import_limits;
  UpAxis up_axis = UpAxis::kZ;
  bool centered = false;
  Fill fill = Fill::kParts;
  double gap_m = 0.004;  ///< of fill: enclosed
  bool textures = true;
  std::string detail_mesh;  ///< relative to the scene file; empty: none, or with skin_faces the mesh itself
  int skin_faces = 0;       ///< 0: as many as there are
  int detail_px = 2048;
  double skin_spacing_m = 0;  ///< 0: as the lattice
  double phantom_length_m = 0.1;
  double phantom_wall_scale = 1;
  Vector3d box_size_m = Vector3d::Constant(0.05);
  double ball_radius_m = 0.02;
  double thickness_m = 0.001;  ///< of structure surface
  double bending_ratio = 0;    ///< stiffness of springs that resist bending, over that of the others around
  Vector3d force_n = Vector3d::Zero();
  double spacing_m = 0.004;   ///< 0: from target_nodes
  bool auto_spacing = false;  ///< `spacing_m: auto`: as fine as this machine can step; see autoBodies()
  int target_nodes = 0;       ///< 0: from spacing_m
  SkinSource skin = SkinSource::kAuto;
  Mapping mapping = Mapping::kAuto;
  Vector3d position_m = Vector3d::Zero();
  Vector3d rotation_deg = Vector3d::Zero();  ///< about fixed x, then y, then z
  Vector3d color = Vector3d(0.72, 0.25, 0.22);
  double roughness = 0.25;
  double mottling = 1;
  double wetness = 0;
  double wall_grain = 0;
  double blanching = 0;
  std::vector<LayerConfig> layers = {{0.0004, Vector3d(0.80, 0.50, 0.42)}, {0.0016, Vector3d(0.86, 0.66, 0.34)}};
  MaterialConfig material;
  std::vector<PartConfig> parts;  ///< cells of other parts have `material`
  std::vector<FixedConfig> fixed;
  std::string spacing_note;  ///< no key: why spacing_m is what it is, where it was chosen
};

// What the kinds of tools are told, each in a group of its own.
struct ProbeConfig {
  double radius_m = 0.006;
};
struct GrabConfig {
  double radius_m = 0.008;
  double release_speed_m_per_s = 0.5;
};
/// Where a blade lies on the axis of its stylus.
enum class BladeSide {
  kShaft,  ///< from the tip back along the shaft, +z
  kAhead,  ///< from the tip on, -z
  kBoth,   ///< on both sides of the tip, its length on each
};

struct CutConfig {
  double blade_length_m = 0.02;
  BladeSide blade_side = BladeSide::kShaft;
  double friction_n_per_m = 0;  ///< of both walls together, per length of blade in tissue
  double point_width_m = 0;     ///< of what the tip parts as the blade is pushed along itself; 0: it parts nothing
};
struct CutParticlesConfig {
  double eraser_radius_m = 0.002;
};

/// Two blades on a pivot, which is behind their tips, on the shaft; they open across it, along x of the stylus.
struct ScissorsConfig {
  double blade_length_m = 0.012;  ///< from the pivot to the tips
  double opening_deg = 40;        ///< from blade to blade, when they begin to close
  double closing_s = 0.3;
};

struct SuctionConfig {
  double radius_m = 0.006;
  double max_force_n = 1;
  double release_speed_m_per_s = 0.5;
};

/// Two jaws, which hold what is between them by friction.
struct GrasperConfig {
  double radius_m = 0.005;      ///< of what is between them, around the tip
  double jaw_length_m = 0.014;  ///< from the pivot to the tips; what has slid so far is lost
  double opening_deg = 40;      ///< from jaw to jaw, when they are open
  double max_force_n = 5;       ///< at more what they hold slides in them
  double release_speed_m_per_s = 0.5;
};

constexpr size_t kMostClips = 32;  ///< of all hands together, until a reset

/// Two jaws on a pivot, which open as scissors do and set a clip.
struct ClipConfig {
  double jaw_length_m = 0.012;  ///< from the pivot to the tips
  double opening_m = 0.012;     ///< between them
  double width_m = 0.002;       ///< of a clip, along y of the stylus
  double gap_m = 0.0005;        ///< between the legs of a clip that is closed
  double force_n = 10;          ///< with which it closes, and stays closed
  int magazine = 20;            ///< clips that there are
};

/// A heated tip, which pushes as a probe does while it burns (docs/lessons/cautery.md).
struct CauteryConfig {
  double radius_m = 0.003;  ///< of the tip
  double power_w = 30;      ///< into the tissue that it touches
};

struct StylusConfig {
  std::string name = "stylus";
  ToolMode idle = ToolMode::kProbe;
  ToolMode button1 = ToolMode::kGrab;
  ToolMode button2 = ToolMode::kCut;
  ProbeConfig probe;
  GrabConfig grab;
  CutConfig cut;  ///< its blade is that of cut_particles too
  CutParticlesConfig cut_particles;
  SuctionConfig suction;
  ScissorsConfig scissors;
  GrasperConfig grasper;
  ClipConfig clip;
  CauteryConfig cautery;
  double jaw_closing_s = 0.2;  ///< from open to closed, of jaws that a button closes
  double max_force_n = 5;
  double max_force_rate_n_per_s = 100;
  double max_torque_nm = 0.2;
  double max_torque_rate_nm_per_s = 4;
  double stale_after_s = 0.2;
  double workspace_m = 1;
};

/// Where the light comes from that a camera sees by.
enum class CameraLight {
  kLamp,  ///< above the lens, as bright at any distance
  kLens,  ///< at the lens, as an endoscope's: a cone that fades with the square of the distance
};

struct CameraConfig {
  std::string name = "camera";
  Vector3d position_m = Vector3d(0, -0.3, 0.1);
  Vector3d target_m = Vector3d::Zero();
  Vector3d up = Vector3d::UnitZ();
  double vertical_fov_deg = 35;
  int width_px = 640;
  int height_px = 480;
  double rate_hz = 30;
  int supersampling = 0;  ///< 0: as the renderer bears, see Renderer
  Overlays overlays;
  double strain_range = 0.3;
  bool draw_hidden = false;
  std::string frame;             ///< tf frame that carries it; empty: the tissue frame
  double stereo_baseline_m = 0;  ///< 0: one eye
  PlumbBob distortion;           ///< one line of sight per pixel, at most kFarthestSight times as far out
  CameraLight light = CameraLight::kLamp;
  double light_cone_deg = 90;
  double contact_shadows = 0;
};

/// How far from the middle of the image a line of sight may be of what a lens shows there, over a pinhole's.
constexpr double kFarthestSight = 2.5;

/// Moving air. Speed at time t: velocity (1 + gust_ratio sin(2 pi t / gust_period)).
struct WindConfig {
  Vector3d velocity_m_per_s = Vector3d::Zero();
  double gust_ratio = 0;
  double gust_period_s = 1;
  double air_density_kg_per_m3 = 1.2;
  double drag_coefficient = 1;
};

struct EnvironmentConfig {
  Vector3d gravity_m_per_s2 = Vector3d(0, 0, -9.81);
  std::string world_frame = "world";
  std::string tissue_frame = "tissue";
  Vector3d tissue_position_m = Vector3d::Zero();
  Vector3d tissue_rotation_deg = Vector3d::Zero();
  Vector3d scan_origin_m = Vector3d::Zero();  ///< of the tissue frame, in the frame of the scan that bodies are from
  WindConfig wind;
};

/// Bodies against themselves and each other.
struct CollisionConfig {
  bool enabled = false;
  CollisionSearch search = CollisionSearch::kGrid;
  double distance_m = 0;  ///< 0: from the springs
  double friction = 0.3;
  double restitution = 0;
  int partitions = 4;  ///< of the staggered search
  int window = 8;      ///< of the staggered search: neighbours in sorted order that are looked at on either side
};

/// A rigid thing that nodes do not enter.
struct ObstacleConfig {
  std::string name = "obstacle";
  ObstacleShape shape = ObstacleShape::kPlane;
  Vector3d position_m = Vector3d::Zero();
  Vector3d rotation_deg = Vector3d::Zero();  ///< about fixed x, then y, then z
  double radius_m = 0.02;
  double length_m = 0.1;                           ///< capsule: between the centres of its ends, along its z
  Vector3d size_m = Vector3d::Constant(0.05);      ///< box
  Vector3d velocity_m_per_s = Vector3d::Zero();    ///< of its position, from the start on
  Vector3d rotation_deg_per_s = Vector3d::Zero();  ///< rotation vector, tissue frame
  std::string frame;                               ///< tf frame that carries it; empty: the tissue frame
  double friction = 0.3;
  double restitution = 0;
};

/// What threads are made of (docs/thread.md 3), and which sizes of the United States Pharmacopeia they have.
enum class ThreadMaterial { kSilk, kNylon, kPolypropylene };
enum class ThreadSize { kUsp2, kUsp3, kUsp4, kUsp5, kUsp6 };
enum class ThreadEnd { kFree, kFixed };

/// A place that a thread goes through at first.
struct ThreadPlace {
  Vector3d position_m = Vector3d::Zero();
};

/// Tissue at rest that a thread goes through at first.
struct ThreadChannelConfig {
  std::string body;  ///< empty: the first
  Vector3d position_m = Vector3d::Zero();
};
enum class StitchedTissue { kPhantom, kBowel, kFascia };

enum class NeedleArc { kNone, kHalfCircle, kThreeEighths };

/// A needle on the start of a thread (docs/thread.md 6). What is 0 follows from the tissue's Young's modulus.
struct NeedleConfig {
  NeedleArc arc = NeedleArc::kNone;
  double radius_m = 0.008;  ///< of the arc
  double wire_radius_m = 0.00025;
  double puncture_n = 0;
  double cutting_n = 0;
  double friction_n_per_m = 0;
  Vector3d rotation_deg = Vector3d::Zero();  ///< at first
};

/// Pieces of all threads of a session beyond those of its scene, at most: they are not parted any more then.
constexpr size_t kMostParted = 16;

/// A thread that does not stretch.
struct ThreadConfig {
  std::string name = "thread";
  ThreadMaterial material = ThreadMaterial::kNylon;
  ThreadSize usp = ThreadSize::kUsp3;
  double radius_m = 0;          ///< 0: of usp
  double young_modulus_pa = 0;  ///< 0: of the material, as the next two
  double density_kg_per_m3 = 0;
  double bending_share = 0;  ///< of the bending of a solid thread
  double drag_per_s = 4;
  double length_m = 0;  ///< 0: of its path
  double spacing_m = 0.00075;
  Vector3d position_m = Vector3d::Zero();
  std::vector<ThreadPlace> path;  ///< from there through these: one place at least
  ThreadEnd start = ThreadEnd::kFree, end = ThreadEnd::kFree;
  std::vector<ThreadChannelConfig> channels;  ///< in the order of the path
  double friction = 0.1;                      ///< in channels
  double through_n_per_m = 0;                 ///< 0: by Young's modulus of the tissue
  double pull_out_n = 0;                      ///< 0: of `tissue`, with the next two
  StitchedTissue tissue = StitchedTissue::kPhantom;
  double bite_m = 0.0045, depth_m = 0.006;
  NeedleConfig needle;          ///< on its start
  std::vector<ThreadTie> ties;  ///< in the order of their times
  bool feelsTissue() const { return !channels.empty() || needle.arc != NeedleArc::kNone; }
};

struct SolverConfig {
  double tick_hz = 60;
  Integrator integrator = Integrator::kLeapfrog;
  SolverStart start = SolverStart::kRest;
  double dt_fraction = 0.75;
  double dt_fraction_strained = 0.5;
  bool measured_limit = true;
  int substeps = 0;     ///< 0: from dt_fraction
  int iterations = 20;  ///< of pd
  SpringForces spring_forces = SpringForces::kPoint;
  bool governor = true;
  double recovery_s = 0.25;
  double sleep_distance_m = 1;
  double sleep_speed_m_per_s = 1e-5;  ///< 0: tissue never sleeps
  bool compensated = false;
  int max_substeps = 2000;
  double real_time_factor = 1.2;  ///< of bodies with auto_spacing
  int device = -1;
  Backend backend = Backend::kAuto;
  int threads = 0;  ///< of the CPU backend; 0: usableProcessors()
};

/// WHAT is simulated: bodies, tools, cameras and an environment.
struct Scene {
  std::string name = "scene";
  std::vector<BodyConfig> bodies;
  std::vector<StylusConfig> styluses;
  std::vector<CameraConfig> cameras;
  std::vector<ObstacleConfig> obstacles;
  CollisionConfig collision;
  EnvironmentConfig environment;
  SolverConfig solver;
  std::vector<ThreadConfig> threads;
  std::string folder;           ///< of the scene file: relative mesh files are looked up here
  std::string file;             ///< the scene file, for errors; empty for a scene that was not loaded from one
  std::optional<OrganFit> fit;  ///< no key: to an organ that the file was not made for, see fitted_scene.h
};

/// "key=value" as given on the command line or in a launch file; the key is a path such as bodies[0].spacing_m.
using Overrides = std::vector<std::string>;

/// Overrides that make a mesh file, relative to the working directory, the tissue of the first body: centred on the
/// body's origin, upright (glTF's y up is turned to z). None for an empty name. Later overrides go before them.
Overrides meshOverrides(const std::string& mesh_file);

/// Reads and checks a scene file, or the shipped scene of a name such as "heart".
/// @throws SceneError  file, line, key and accepted range, for an unknown key, a wrong type, a value out of range, NaN
Scene loadScene(const std::string& path, const Overrides& overrides = {});

/// The same from text, for tests; `name` stands for the file in messages.
Scene parseScene(const std::string& yaml, const std::string& name, const Overrides& overrides = {});

/// Indices of the bodies whose spacing is to be chosen: `spacing_m: auto` and no target_nodes.
std::vector<size_t> autoBodies(const Scene& scene);

/// Markdown table of every scene key: key, type and unit, default, range, meaning.
std::string sceneKeysTable();

}  // namespace viscera
