// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "solver/processes/suture/chain/chain_matrix.h"
#include "viscera/math/types.h"

namespace viscera {

/// Mass that what never gives way shows: pulled by 20 N it lets a thread go on by 50 nm in a substep of 0.5 ms.
constexpr double kRigidMass_kg = 100;

constexpr double kSlack = 1.05;  // of a limit of friction or grip, before an iteration is worth it
/// Grip or friction as a stiffness: of the limit over what slipped, so that it never drives.
double secant(double limit, double slipped_m, double most_kg);

struct ChainLink {
  Vector3d along;
  double length_m;
};

/// A chain in an iteration of a substep.
struct ChainShape {
  const std::vector<Vector3d>& places_m;
  const std::vector<ChainLink>& links;
  double link_m;
  double dt_s;
};

/// A point between two nodes.
struct ChainPoint {
  /// @param s  on a chain of so many nodes [links]
  ChainPoint(double s, size_t nodes);
  Vector3d of(const std::vector<Vector3d>& places) const;
  /// A force on it, on its nodes.
  void push(const Vector3d& by, std::vector<ChainMatrix::Unknown>& rest) const;
  uint32_t node;
  double share;  ///< of node + 1; the rest is of node
};

/// How a chain turns at a point that something holds: from before the two nodes at which that bends it to behind them.
/// Does not jump where the point passes a node.
struct ChainTurn {
  ChainTurn() = default;
  ChainTurn(const ChainPoint& point, const std::vector<ChainLink>& links);
  /// What a difference of tensions before and behind shows along the tangent.
  double alongBisector() const;
  Vector3d tangent = Vector3d::Zero();  ///< bisector of the whole turn
  double angle = 0;
  double along_link = 1;  ///< of the tangent, in the point's own link
};

/// Friction over what presses across where a rope turns by an angle, so that its tensions are as exp(friction x angle).
double capstan(double friction, double angle);

}  // namespace viscera
