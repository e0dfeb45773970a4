// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/chain/throws.h"

#include <algorithm>
#include <cmath>

namespace viscera {

namespace {

constexpr double kWholeSphere = 4 * 3.14159265358979323846;
constexpr double kLeastTurns = 0.75;  // of a throw: half a turn is two tails that cross

/// Returns the solid angle of a triangle seen from 0 (van Oosterom and Strackee 1983).
double solidAngle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  const double above = a.dot(b.cross(c));
  return above == 0 ? 0 : 2 * std::atan2(above, below);
}

}  // namespace

/// The vectors from a segment of one to a segment of the other span a parallelogram: two triangles.
double turnsOf(const Strand& one, const Strand& other) {
  double sum = 0;
  for (size_t i = 0; i + 1 < one.count; ++i) {
    for (size_t j = 0; j + 1 < other.count; ++j) {
      const Vector3d from = other.nodes[j] - one.nodes[i], to = other.nodes[j + 1] - one.nodes[i + 1];
      sum += solidAngle(from, other.nodes[j] - one.nodes[i + 1], to);
      sum += solidAngle(from, to, other.nodes[j + 1] - one.nodes[i]);
    }
  }
  return sum / kWholeSphere;
}

int throwOf(double turns) {
  return std::abs(turns) < kLeastTurns ? 0 : static_cast<int>(std::lround(turns));
}

KnotKind kindOf(const std::vector<int>& throws) {
  std::vector<int> made;
  std::copy_if(throws.begin(), throws.end(), std::back_inserter(made), [](int turns) { return turns != 0; });
  if (made.empty()) return KnotKind::kNone;
  const bool twice = std::abs(made[0]) > 1;
  if (made.size() == 1) return twice ? KnotKind::kDoubleHalf : KnotKind::kHalf;
  bool in_turn = true;
  for (size_t i = 1; i < made.size(); ++i) in_turn &= (made[i] > 0) != (made[i - 1] > 0);
  if (twice) return in_turn ? KnotKind::kSurgeons : KnotKind::kSurgeonsGranny;
  return in_turn ? KnotKind::kSquare : KnotKind::kGranny;
}

}  // namespace viscera
