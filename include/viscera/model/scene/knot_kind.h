// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "viscera/math/types.h"

namespace viscera {

/// What a sequence of throws makes.
enum class KnotKind { kNone, kHalf, kDoubleHalf, kSquare, kGranny, kSurgeons, kSurgeonsGranny };
/// As scenes and services write it.
constexpr std::array<const char*, 7> kKnotNames = {"none",   "half",     "double_half",    "square",
                                                   "granny", "surgeons", "surgeons_granny"};
constexpr const char* nameOf(KnotKind kind) {
  return kKnotNames[static_cast<size_t>(kind)];
}
/// @throws SceneError  there is no such knot; names those there are
KnotKind knotNamed(const std::string& name);

/// What a tail of a thread is tied to.
enum class TieTo { kOtherTail, kStrand };

/// A knot that no hand throws: the two tails of a thread, or one of them and a strand of the same thread, are brought
/// together, drawn tight and tied (docs/thread.md 4).
struct ThreadTie {
  double at_s = 0;  ///< since the start or the last reset
  KnotKind knot = KnotKind::kSquare;
  double tension_n = 0.1;  ///< to which its loop is drawn
  double holds_n = 0;      ///< before it slips; 0: by knot and thread
  TieTo to = TieTo::kOtherTail;
  /// What runs outside of tissue nearest to this place is the strand, and the tail that is nearer along the thread is
  /// tied to it.
  Vector3d strand_m = Vector3d::Zero();
};

}  // namespace viscera
