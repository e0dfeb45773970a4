// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "viscera/api.h"
#include "viscera/math/types.h"

namespace VISCERA_PUBLIC viscera {

/// Knot that a sequence of throws makes.
enum class KnotKind { kNone, kHalf, kDoubleHalf, kSquare, kGranny, kSurgeons, kSurgeonsGranny };
/// Names of knots in scenes and services.
constexpr std::array<const char*, 7> kKnotNames = {"none",   "half",     "double_half",    "square",
                                                   "granny", "surgeons", "surgeons_granny"};
constexpr const char* nameOf(KnotKind kind) {
  return kKnotNames[static_cast<size_t>(kind)];
}
/// Returns the knot of this name.
/// @throws SceneError  there is no such knot; lists the names
KnotKind knotNamed(const std::string& name);

/// Object that a tail of a suture is tied to.
enum class TieTo { kOtherTail, kStrand };

/// Knot that is tied without a tool. Two tails of a suture, or one tail and a strand of the same suture, are brought
/// together, drawn tight and tied (docs/physics.md 14).
struct SutureTie {
  double at_s = 0;  ///< time since the start or the last reset [s]
  KnotKind knot = KnotKind::kSquare;
  double tension_n = 0.1;  ///< tension to which its loop is drawn [N]
  double holds_n = 0;      ///< tension that it holds before it slips [N]; 0: by knot and suture
  TieTo to = TieTo::kOtherTail;
  /// Position [m] that selects the strand: the nearest piece of the suture outside tissue. The tail that is nearer
  /// along the suture is tied to it.
  Vector3d strand_m = Vector3d::Zero();
};

}  // namespace viscera
