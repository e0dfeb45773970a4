// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/api.h"

namespace VISCERA_PUBLIC viscera {

/// Fibres that join two bodies where their surfaces are close (docs/physics.md).
struct AttachmentConfig {
  std::string body_a;              ///< name of the first body
  std::string body_b;              ///< name of the second body
  double reach_m = 0.001;          ///< largest distance of two points that a fibre joins [m]
  double modulus_pa = 3000;        ///< Young's modulus of the connective tissue [Pa]
  double thickness_m = 0.001;      ///< thickness of the connective tissue [m]: traction = modulus x gap / thickness
  double toughness_j_per_m2 = 20;  ///< work per area that parts the bodies [J/m2]
  double strength_pa = 10000;      ///< largest traction [Pa]
};

}  // namespace viscera
