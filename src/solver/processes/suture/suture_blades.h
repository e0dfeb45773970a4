// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/math/types.h"
#include "viscera/model/scene/stylus_config.h"
#include "viscera/tools/stylus.h"

namespace viscera {

/// Returns whether an edge, a straight segment, meets a link during its motion. All in the edge's own frame, in which
/// it does not move.
/// @param edge, from, to  both ends
bool edgeMeets(const std::array<Vector3d, 2>& edge, const std::array<Vector3d, 2>& from,
               const std::array<Vector3d, 2>& to);

/// Blades that cut sutures: styluses in mode cut, and scissors as they close.
class SutureBlades {
 public:
  explicit SutureBlades(const std::vector<StylusConfig>& styluses) : styluses_(styluses) {}

  /// Begins a tick. @returns whether there is any blade: then positions must be kept with keep(), suture by suture
  bool beginTick(const ToolMotions& motions);
  void keep(const std::vector<Vector3d>& positions_m) { before_m_.push_back(positions_m); }
  size_t kept() const { return before_m_.size(); }
  /// Returns the links of a suture that blades met in the tick, ascending. @param positions_m  positions at its end
  std::vector<size_t> met(size_t suture, const std::vector<Vector3d>& positions_m) const;

 private:
  std::vector<StylusConfig> styluses_;
  ToolMotions motions_;
  bool any_ = false;
  std::vector<std::vector<Vector3d>> before_m_;  ///< [sutures][nodes] at the start of the tick
};

}  // namespace viscera
