// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/api.h"
#include "viscera/math/types.h"
#include "viscera/model/scene/body_kinds.h"
#include "viscera/model/scene/mark_config.h"
#include "viscera/model/scene/material_config.h"

namespace VISCERA_PUBLIC viscera {

/// Region of nodes that are fixed in space. Coordinates are in the body's frame, before its pose is applied.
struct FixedConfig {
  FixedShape shape = FixedShape::kBox;
  Vector3d min_m = Vector3d::Zero();
  Vector3d max_m = Vector3d::Zero();
  Vector3d center_m = Vector3d::Zero();
  double radius_m = 0.01;
  Vector3d point_m = Vector3d::Zero();
  Vector3d normal = Vector3d::UnitZ();  ///< normal of the plane; nodes on its negative side are fixed
  std::string part;
};

/// Limits on the content of a mesh file. A small file can expand without bound, as nodes share children, and libraries
/// that read files recurse.
struct ImportLimits {
  double max_file_mb = 2000;
  int max_depth = 256;
  int max_instances = 100000;
  int max_triangles = 20000000;
  bool other_formats = false;
};

/// Label map, and what the file itself does not say (docs/scans.md).
struct ScanConfig {
  std::string file;                 ///< path relative to the scene file
  std::vector<std::string> labels;  ///< numbers or names of labels; none: all
  std::string names_file;  ///< path relative to the scene file; empty: the names file next to the scan, if there is one
  std::string axes;
  std::string transform;
  int volume = -1;  ///< index of the volume; -1: the only one
  std::string series;
};

/// Hollow branch of a tube: its axis and its cross-section.
struct TubeBranch {
  std::string name;             ///< name of the branch, a part of the body
  std::vector<MarkPoint> path;  ///< points of the axis, body frame, at least two
  double radius_m = 0;          ///< outer radius [m]; 0: that of the tube
  double wall_m = 0;            ///< thickness of the wall [m]; 0: that of the tube
};

/// Hollow tube, for source: tube.
struct TubeConfig {
  std::vector<MarkPoint> path;  ///< points of the axis, body frame, at least two
  double radius_m = 0.003;      ///< outer radius [m]
  double wall_m = 0.0008;       ///< thickness of the wall [m]
  std::vector<TubeBranch> branches;
};

/// Pressure of the fluid in the cavities of a body, over that outside.
struct PressureConfig {
  double mean_pa = 0;   ///< mean pressure [Pa]
  double pulse_pa = 0;  ///< amplitude of the pulse [Pa]
  double pulse_hz = 1.2;
};

struct BodyConfig {
  std::string name = "tissue";
  TissueSource source = TissueSource::kPhantom;
  Structure structure = Structure::kLattice;
  std::string mesh_file;  ///< path relative to the scene file
  ScanConfig scan;        ///< scan, for source: labels
  double unit_scale_m = 1;
  ImportLimits import_limits;
  UpAxis up_axis = UpAxis::kZ;
  bool centered = false;
  Fill fill = Fill::kParts;
  double gap_m = 0.004;  ///< width of gaps that are closed [m], for fill: enclosed
  bool textures = true;
  std::string detail_mesh;  ///< path relative to the scene file; empty: none, or the mesh itself if skin_faces is set
  int skin_faces = 0;       ///< number of faces of the surface mesh; 0: all that it has
  int detail_px = 2048;
  double skin_spacing_m = 0;  ///< spacing of the surface mesh [m]; 0: as the lattice
  Anatomy phantom = Anatomy::kHeart;
  int phantom_seed = 0;  ///< variant of the anatomy, for Anatomy::kGallbladder
  double phantom_length_m = 0.1;
  double phantom_wall_scale = 1;
  Vector3d box_size_m = Vector3d::Constant(0.05);
  double ball_radius_m = 0.02;
  TubeConfig tube;
  PressureConfig pressure;
  double thickness_m = 0.001;  ///< thickness [m], for structure surface
  double bending_ratio = 0;    ///< stiffness of springs that resist bending, over that of the springs around them
  Vector3d force_n = Vector3d::Zero();
  double spacing_m = 0.004;   ///< edge of a cell [m]; 0: from target_nodes
  bool auto_spacing = false;  ///< `spacing_m: auto`: as fine as this machine can step; see autoBodies()
  int target_nodes = 0;       ///< number of nodes; 0: from spacing_m
  SkinSource skin = SkinSource::kAuto;
  Mapping mapping = Mapping::kAuto;
  Vector3d position_m = Vector3d::Zero();
  Vector3d rotation_deg = Vector3d::Zero();  ///< rotation about fixed x, then y, then z [deg]
  Vector3d color = Vector3d(0.72, 0.25, 0.22);
  double roughness = 0.25;
  double color_variation = 1;
  double specular_wetness = 0;
  double cut_wall_texture = 0;
  double blanching = 0;
  std::vector<LayerConfig> layers = {{0.0004, Vector3d(0.80, 0.50, 0.42)}, {0.0016, Vector3d(0.86, 0.66, 0.34)}};
  MaterialConfig material;
  std::vector<PartConfig> parts;  ///< parts with elasticities of their own; cells of other parts have `material`
  std::vector<FixedConfig> fixed;
  std::string spacing_note;  ///< no key: reason for spacing_m, where it was chosen
};

}  // namespace viscera
