// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "solver/processes/suture/chain/chain.h"
#include "solver/processes/suture/chain/throws.h"
#include "viscera/model/scene/knot_kind.h"

namespace viscera {

class Archive;

/// A knot and its throws.
struct ThrownKnot {
  static constexpr size_t kMostThrows = 8;
  KnotKind kind = KnotKind::kNone;
  std::array<int8_t, kMostThrows> turns{};  ///< signed turns of each throw; none if not thrown by styluses
  uint32_t throws = 0;
  bool drawn = false;           ///< the loop is being drawn tight
  double holds_n = 0;           ///< force at which it slips when tied
  double looked_s = 0;          ///< time of the last check, since its loop is being drawn
  double checked_position = 0;  ///< value of s2 at that check
};

/// Returns the force at which a knot slips [N]. @param strength_n  at which the suture breaks in a knot
double knotHolds(KnotKind kind, uint32_t throws, double strength_n);
/// Returns the strength by the suture's cross-section: about 200 MPa, as USP requires of knotted sutures of 2-0 to 6-0.
double knotStrength(double radius_m);

/// The knots of one suture, in the same order as its ChainAround::knots: those thrown by styluses, counted by the turns
/// about each other, and those that are requested.
class SutureKnots {
 public:
  /// Brings both tails together above the channels, or where they are nearest, or one and a strand, and draws the loop.
  /// @param hidden  returns whether the chain is in tissue there   @throws Error  why there can be no knot
  void tie(const SutureTie& tie, const Chain& chain, const std::function<bool(double s)>& hidden, ChainAround& around);
  /// Prepares a substep: knots that are apart close, loops that are drawn shrink.
  void beginSubstep(double dt_s, const Chain& chain, ChainAround& around);
  /// Counts throws after a tick. A throw is made when the styluses have turned the tails about each other and both are
  /// pulled. Sutures pass through each other, so the turns of the styluses are counted in place of those of the tails.
  /// @param held  nodes that styluses or fixed ends hold
  void countThrows(const Chain& chain, const std::vector<uint32_t>& held, ChainAround& around);
  /// Removes the knots that are out.
  void clean(ChainAround& around);
  /// Splits the knots; call before partAround(). @returns those behind
  SutureKnots part(double at, const ChainAround& around);
  void persist(Archive& archive);

  const std::vector<ThrownKnot>& thrown() const { return thrown_; }
  double turns() const { return turns_; }  ///< turns of the tails about each other since the last throw

 private:
  void draw(ThrownKnot& thrown, ChainKnot& knot, double dt_s, double link_m, const ChainAround& around) const;
  void addThrow(int turns, const Chain& chain, ChainAround& around);

  void turnGrips(const Vector3d& root_m, const Vector3d& first_m, const Vector3d& second_m);

  std::vector<ThrownKnot> thrown_;
  double turns_ = 0;
  Vector3d apart_m_ = Vector3d::Zero();  ///< last vector from the stylus at the start to that at the end
  bool pulled_ = false;                  ///< both were pulled in some substep since the last count
};

}  // namespace viscera
