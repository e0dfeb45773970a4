// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "solver/processes/suture/chain/chain_matrix.h"
#include "viscera/math/types.h"

namespace viscera {

/// Effective mass of a rigid holder: with a pull of 20 N it lets a suture move by 50 nm in a substep of 0.5 ms.
constexpr double kRigidMass_kg = 100;

constexpr double kSlack = 1.05;  // factor over a limit of friction or grip above which another iteration is worthwhile
/// Returns grip or friction as a secant stiffness: the limit over the slip, so it never accelerates.
double secant(double limit, double slipped_m, double most_kg);

struct ChainLink {
  Vector3d along;
  double length_m;
};

/// A chain in an iteration of a substep.
struct ChainShape {
  const std::vector<Vector3d>& positions_m;
  const std::vector<ChainLink>& links;
  double link_m;
  double dt_s;
};

/// A point between two nodes.
struct ChainPoint {
  /// @param s  position on a chain with `nodes` nodes [links]
  ChainPoint(double s, size_t nodes);
  Vector3d of(const std::vector<Vector3d>& positions) const;
  /// Distributes a force on the point to its nodes.
  void push(const Vector3d& by, std::vector<ChainMatrix::Unknown>& rest) const;
  uint32_t node;
  double share;  ///< weight of node + 1; the rest is that of node
};

/// Turn of a chain at a held point: from before to behind the two nodes at which the hold bends it. It is continuous
/// where the point passes a node.
struct ChainTurn {
  ChainTurn() = default;
  ChainTurn(const ChainPoint& point, const std::vector<ChainLink>& links);
  /// Returns the share of a difference of tensions before and behind that acts along the tangent.
  double alongBisector() const;
  Vector3d tangent = Vector3d::Zero();  ///< bisector of the whole turn
  double angle = 0;
  double along_link = 1;  ///< component of the tangent along the point's own link
};

/// Returns friction over normal force where a rope turns by an angle: the ratio of its tensions is exp(friction x
/// angle).
double capstan(double friction, double angle);

}  // namespace viscera
