// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "viscera/model/scene/stylus_config.h"
#include "viscera/tools/force_limiter.h"
#include "viscera/tools/stylus.h"

namespace viscera {

class Archive;

/// Contact of the shafts of two styluses that tissue meets: a force that grows with the depth of one in the other
/// pushes them apart (physics.md 5). It remembers on which side each is, so that one that is pushed past the other's
/// axis is pushed back.
class ShaftMeeting {
 public:
  explicit ShaftMeeting(const std::vector<StylusConfig>& styluses) : configs_(styluses) {}
  /// Finds the contact at the end of a tick.
  void advance(const ToolMotions& motions);
  bool touch() const { return side_.has_value(); }
  /// Adds the force on a stylus, and its torque about the tip.
  void addTo(size_t stylus, Reaction& reaction) const;
  void reset();
  void persist(Archive& archive);

 private:
  bool meets() const { return configs_.size() == 2 && configs_[0].shaft_contact && configs_[1].shaft_contact; }

  std::vector<StylusConfig> configs_;
  std::optional<Vector3d> side_;  ///< direction from the first to the second while they touch, unit vector
  std::array<Reaction, layout::kMaxStyluses> forces_;
};

}  // namespace viscera
