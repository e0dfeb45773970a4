// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/math/types.h"
#include "viscera/model/scene/stylus_config.h"
#include "viscera/tools/stylus.h"

namespace viscera {

/// Does an edge, a straight piece, meet a link on its way? All in the edge's own frame: there it stands still.
/// @param edge, from, to  both ends
bool edgeMeets(const std::array<Vector3d, 2>& edge, const std::array<Vector3d, 2>& from,
               const std::array<Vector3d, 2>& to);

/// Blades that part threads: styluses in mode cut, and scissors as they close.
class ThreadBlades {
 public:
  explicit ThreadBlades(const std::vector<StylusConfig>& styluses) : styluses_(styluses) {}

  /// @returns whether any blade is there: then places are kept with keep(), thread after thread
  bool beginTick(const ToolMotions& motions);
  void keep(const std::vector<Vector3d>& places_m) { before_m_.push_back(places_m); }
  size_t kept() const { return before_m_.size(); }
  /// Links of a thread that blades have met in the tick, ascending. @param places_m  at its end
  std::vector<size_t> met(size_t thread, const std::vector<Vector3d>& places_m) const;

 private:
  std::vector<StylusConfig> styluses_;
  ToolMotions motions_;
  bool any_ = false;
  std::vector<std::vector<Vector3d>> before_m_;  ///< [threads][nodes] at the start of the tick
};

}  // namespace viscera
