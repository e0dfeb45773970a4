// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/math/types.h"
#include "viscera/model/scene/body_kinds.h"

namespace viscera {

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
  Walls walls = Walls::kCells;
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

/// What of a wound's wall is seen down to a depth below the skin, and what it takes to part it.
struct LayerConfig {
  double depth_m = 0.001;
  Vector3d color = Vector3d(0.86, 0.66, 0.34);
  double toughness_j_per_m2 = 0;  ///< 0: that of the material or the part
};

}  // namespace viscera
