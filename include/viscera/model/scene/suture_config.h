// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/api.h"
#include "viscera/math/types.h"
#include "viscera/model/scene/knot_kind.h"

namespace VISCERA_PUBLIC viscera {

/// Materials of sutures (docs/sutures.md), and their sizes of the United States Pharmacopeia.
enum class SutureMaterial { kSilk, kNylon, kPolypropylene };
enum class SutureSize { kUsp2, kUsp3, kUsp4, kUsp5, kUsp6 };
enum class SutureEnd { kFree, kFixed };

/// Point of a suture's initial path.
struct SuturePathPoint {
  Vector3d position_m = Vector3d::Zero();
};

/// Tissue at rest that a suture passes through initially.
struct SutureChannelConfig {
  std::string body;  ///< name of the body; empty: the first
  Vector3d position_m = Vector3d::Zero();
};
enum class StitchedTissue { kPhantom, kBowel, kFascia };

enum class NeedleArc { kNone, kHalfCircle, kThreeEighths };

/// Needle on the start of a suture (docs/physics.md 16). Values that are 0 follow from the tissue's Young's modulus.
struct NeedleConfig {
  NeedleArc arc = NeedleArc::kNone;
  double radius_m = 0.008;  ///< radius of the arc [m]
  double wire_radius_m = 0.00025;
  double puncture_n = 0;
  double cutting_n = 0;
  double friction_n_per_m = 0;
  Vector3d rotation_deg = Vector3d::Zero();  ///< initial rotation [deg]
};

/// Largest number of pieces of sutures in a session beyond those of its scene. With this many, sutures can no longer be
/// cut.
constexpr size_t kMostParted = 16;

/// Suture that does not stretch.
struct SutureConfig {
  std::string name = "suture";
  SutureMaterial material = SutureMaterial::kNylon;
  SutureSize usp = SutureSize::kUsp3;
  double radius_m = 0;          ///< radius [m]; 0: from usp
  double young_modulus_pa = 0;  ///< Young's modulus [Pa]; 0: that of the material, as for the next two
  double density_kg_per_m3 = 0;
  double bending_share = 0;  ///< bending stiffness over that of a solid suture
  double mass_damping_per_s = 4;
  double length_m = 0;  ///< length [m]; 0: that of its path
  double spacing_m = 0.00075;
  Vector3d position_m = Vector3d::Zero();
  std::vector<SuturePathPoint> path;  ///< points of the path after position_m, at least one
  SutureEnd start = SutureEnd::kFree, end = SutureEnd::kFree;
  std::vector<SutureChannelConfig> channels;  ///< channels in tissue, in the order of the path
  double friction = 0.1;                      ///< friction coefficient in channels
  double through_n_per_m = 0;  ///< force per length through tissue [N/m]; 0: from the Young's modulus of the tissue
  double pull_out_n = 0;       ///< force at which it pulls out of tissue [N]; 0: from `tissue`, bite_m and depth_m
  StitchedTissue tissue = StitchedTissue::kPhantom;
  double bite_m = 0.0045, depth_m = 0.006;
  NeedleConfig needle;          ///< needle on its start
  std::vector<SutureTie> ties;  ///< knots, in the order of their times
  bool feelsTissue() const { return !channels.empty() || needle.arc != NeedleArc::kNone; }
};

}  // namespace viscera
