// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "solver/contact/blade_edge.h"
#include "viscera/math/types.h"
#include "viscera/model/model.h"

namespace viscera {

/// A point of tissue that thread or needle holds: the nodes that carry it, with weights whose sum is 1.
struct TissuePoint {
  static constexpr size_t kMost = 8;
  uint32_t body = 0;
  uint32_t count = 0;                   ///< of nodes
  std::array<uint32_t, kMost> slots{};  ///< in the solver's buffers
  std::array<float, kMost> weights{};   ///< of a place; may be below 0 beside a cut, where they extrapolate
  Vector3d rest_m = Vector3d::Zero();   ///< tissue frame
};

/// Points of tissue in a substep that was just made (BladeTarget): where they are, and what impulses do to them. Reads
/// the nodes of all of them once, and writes once.
class TissuePoints {
 public:
  explicit TissuePoints(const Model& model);
  /// Carried by the cell around a place at rest; where that is cut, by the nearest whole cell on the place's side.
  /// @returns nothing where there is no tissue
  std::optional<TissuePoint> embed(uint32_t body, const Vector3d& rest_m) const;
  /// Around a place as the tissue is now: in whichever body and cell. Slow beside embed(): for what begins to touch.
  std::optional<TissuePoint> find(BladeTarget& target, const Vector3d& place_m) const;

  /// Begins a substep. @param points  all that will be asked for
  void read(BladeTarget& target, const std::vector<const TissuePoint*>& points);
  Vector3d place_m(
      const TissuePoint& point) const;  ///< at the end of the substep, impulses given since read() among it
  Vector3d velocity_m_per_s(const TissuePoint& point) const;
  /// What an impulse at one changes another's velocity by [1/kg].
  double mobility(const TissuePoint& one, const TissuePoint& other) const;
  void give(const TissuePoint& point, const Vector3d& impulse_ns, double dt_s);
  /// Ends a substep: writes what was given. @param stylus  whose reaction it is; kMaxStyluses: nobody's
  void write(BladeTarget& target, uint32_t stylus, double dt_s);
};

}  // namespace viscera
