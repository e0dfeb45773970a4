// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string>

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

/// A knot that no hand throws: the two tails of a thread are brought together, drawn tight and tied (docs/thread.md 4).
struct ThreadTie {
  double at_s = 0;  ///< since the start or the last reset
  KnotKind knot = KnotKind::kSquare;
  double tension_n = 0.1;  ///< to which its loop is drawn
  double holds_n = 0;      ///< before it slips; 0: by knot and thread
};

}  // namespace viscera
