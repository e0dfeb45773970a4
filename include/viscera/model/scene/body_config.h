// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/math/types.h"
#include "viscera/model/scene/body_kinds.h"
#include "viscera/model/scene/material_config.h"

namespace viscera {

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

}  // namespace viscera
