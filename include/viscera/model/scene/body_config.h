// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/math/types.h"

namespace viscera {

enum class TissueSource { kPhantom, kMesh, kBox, kSheet, kBall, kLabels };
enum class Structure { kLattice, kExplicit, kSurface };
enum class SkinSource { kAuto, kInput, kVolume };
enum class Mapping { kAuto, kOneToOne, kConstant, kInterpolated, kAlongNormal };  ///< see docs/mappings.md
enum class UpAxis { kZ, kY };
enum class FixedShape { kBox, kSphere, kPlane, kPart };
/// What of a mesh is tissue.
enum class Fill {
  kParts,    ///< the inside of each of its parts
  kEnclosed  ///< what all of them enclose together, gaps closed
};

/// What the cells of a lattice are made of (docs/physics.md 1).
enum class Law {
  kAuto,       ///< what lawOf() (structure_rules.h) says
  kSprings,    ///< springs, as in VR05: Poisson's ratio is 1/4, cells are full or empty
  kNeoHookean  ///< a hyperelastic energy per cell, of its deformation gradient; cells are tissue in part
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
  double poisson_ratio = 0.25;  ///< that of springs, which have no other
  double density_kg_per_m3 = 1060;
  double drag_per_s = 4;
  double dashpot_ratio = 0.2;
  Weights weights = Weights::kCell;
  Law law = Law::kAuto;
  double stiffening = 0;            ///< b of mu/(2 b) (exp(b (I1 - 3)) - 1), the neo-Hookean law's shear energy
  bool stiffens_as_tissue = false;  ///< `stiffening: auto`: it is that of the tissue
  std::string tissue;  ///< preset (docs/tissues.md) of those of the first three that the scene does not give
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

}  // namespace viscera
