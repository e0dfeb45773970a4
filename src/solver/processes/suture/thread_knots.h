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

/// What was thrown.
struct ThrownKnot {
  static constexpr size_t kMostThrows = 8;
  KnotKind kind = KnotKind::kNone;
  std::array<int8_t, kMostThrows> turns{};  ///< of each throw, by their sign; of a knot that no hand threw: none
  uint32_t throws = 0;
  bool drawn = false;       ///< its loop is being drawn tight
  double holds_n = 0;       ///< tied
  double looked_s = 0;      ///< of the time that its loop is being drawn
  double looked_place = 0;  ///< where s2 was then
};

/// What a knot holds before it slips [N]. @param strength_n  at which the thread breaks in a knot
double knotHolds(KnotKind kind, uint32_t throws, double strength_n);
/// By the thread's section: some 200 MPa, as USP asks of sutures of 2-0 to 6-0 that are knotted.
double knotStrength(double radius_m);

/// The knots of one thread, beside its ChainAround::knots, which are in the same order: those that hands throw, counted
/// by their turns about each other, and those that are asked for.
class ThreadKnots {
 public:
  /// Brings both tails together above the channels, or where they are nearest, or one and a strand, and draws the loop.
  /// @param hidden  is the chain in tissue there?   @throws Error  why there can be no knot
  void tie(const ThreadTie& tie, const Chain& chain, const std::function<bool(double s)>& hidden, ChainAround& around);
  /// Before a substep: knots that are apart close, loops that are drawn become shorter.
  void beginSubstep(double dt_s, const Chain& chain, ChainAround& around);
  /// After a tick: a throw is made where the hands have turned the tails about each other and both are pulled then.
  /// Threads pass each other: it is hands that are counted, as what their tails would do if they did not.
  /// @param held  nodes that hands or fixed ends hold
  void countThrows(const Chain& chain, const std::vector<uint32_t>& held, ChainAround& around);
  /// Those that are out are forgotten.
  void clean(ChainAround& around);
  /// Before partAround(). @returns those behind
  ThreadKnots part(double at, const ChainAround& around);
  void persist(Archive& archive);

  const std::vector<ThrownKnot>& thrown() const { return thrown_; }
  double turns() const { return turns_; }  ///< of the tails about each other since the last throw

 private:
  void draw(ThrownKnot& thrown, ChainKnot& knot, double dt_s, double link_m, const ChainAround& around) const;
  void addThrow(int turns, const Chain& chain, ChainAround& around);

  void turnHands(const Vector3d& root_m, const Vector3d& first_m, const Vector3d& second_m);

  std::vector<ThrownKnot> thrown_;
  double turns_ = 0;
  Vector3d apart_m_ = Vector3d::Zero();  ///< from the hand at the start to that at the end, when that was last seen
  bool pulled_ = false;                  ///< both were in some substep since the last count
};

}  // namespace viscera
