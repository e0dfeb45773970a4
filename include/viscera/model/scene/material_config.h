// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "viscera/api.h"
#include "viscera/math/types.h"
#include "viscera/model/scene/body_kinds.h"

namespace VISCERA_PUBLIC viscera {

/// Resistance of tissue to cutting (docs/cutting.md).
struct FractureConfig {
  double toughness_j_per_m2 = 0;  ///< work per area of cut [J/m2]; 0: a blade cuts what it crosses without a force
  bool of_tissue = false;         ///< `toughness_j_per_m2: auto`: the value of the tissue
};

/// Strain by which tissue would shorten from its given shape if nothing held it (docs/physics.md 11).
struct PrestressConfig {
  double strain = 0;                    ///< strain along every axis
  Vector3d strains = Vector3d::Zero();  ///< additional strains along three axes of its own
  /// Rotation of these axes from the tissue frame, about fixed x, then y, then z [deg].
  Vector3d axes_deg = Vector3d::Zero();
};

/// Resistance of tissue to tearing (docs/physics.md 12).
struct TearConfig {
  double toughness_j_per_m2 = 0;  ///< work per area [J/m2]; 0: springs stretch without limit
};

/// Bleeding of tissue that is cut, for example of a vessel (docs/lessons/instruments.md).
struct BleedingConfig {
  double flow_ml_per_min = 0;  ///< flow out of a stump [ml/min]; 0: none
  double calibre_m = 0;        ///< calibre of the vessel that is cut through [m]; 0: from its volume over its length
  Fluid fluid = Fluid::kBlood;
  double volume_ml = 0;  ///< fluid that can leave until a reset [ml]; 0: any amount
};

struct MaterialConfig {
  double young_modulus_pa = 20e3;
  double poisson_ratio = 0.25;  ///< Poisson's ratio; the default is that of springs, which have no other
  double density_kg_per_m3 = 1060;
  double mass_damping_per_s = 4;
  double stiffness_damping_ratio = 0.2;
  Weights weights = Weights::kCell;
  Law law = Law::kAuto;
  Walls walls = Walls::kCells;
  double stiffening = 0;            ///< b of mu/(2 b) (exp(b (I1 - 3)) - 1), the shear energy of the neo-Hookean law
  bool stiffens_as_tissue = false;  ///< `stiffening: auto`: the value of the tissue
  std::string tissue;  ///< preset (docs/tissues.md) for those of the first three keys that the scene does not give
  FractureConfig cut;
  PrestressConfig prestress;
  TearConfig tear;
  BleedingConfig bleeding;
};

/// Elasticity, toughness, prestress and bleeding of one part of a body, such as a valve. A key that a scene file leaves
/// out has the value of the body's material.
struct PartConfig {
  std::string part;
  double young_modulus_pa = 20e3;
  double poisson_ratio = 0.25;
  double density_kg_per_m3 = 1060;
  std::string tissue = {};  ///< as in MaterialConfig
  FractureConfig cut = {};
  PrestressConfig prestress = {};
  BleedingConfig bleeding = {};
  std::optional<Vector3d> color = {};  ///< red, green, blue; without: that of the body
};

/// Layer of a wound's wall: its colour down to a depth below the surface, and its toughness.
struct LayerConfig {
  double depth_m = 0.001;
  Vector3d color = Vector3d(0.86, 0.66, 0.34);
  double toughness_j_per_m2 = 0;  ///< work per area of cut [J/m2]; 0: that of the material or the part
};

}  // namespace viscera
