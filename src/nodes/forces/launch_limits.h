// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "viscera/model/scene/overrides.h"
#include "viscera/model/scene/stylus_config.h"

namespace viscera::nodes {

/// Force limits that the overrides of a launch set. They bound the styluses of every scene that is loaded later; limits
/// in a scene file apply to that scene only.
class LaunchLimits {
 public:
  /// @param styluses   styluses of the launched scene, without the limits of their devices
  /// @param overrides  its overrides
  LaunchLimits(const std::vector<StylusConfig>& styluses, const Overrides& overrides);

  /// Lowers limits to those of the launch. A stylus that the launched scene did not have gets the lowest of the
  /// launch's limits, since it may use any of the devices.
  /// @returns a line for each limit that was lowered
  std::vector<std::string> bound(std::vector<StylusConfig>& styluses) const;

 private:
  using Key = double StylusConfig::*;
  struct Named {
    std::string stylus;
    std::vector<std::pair<Key, double>> limits;
  };
  /// Returns the limit of a stylus; infinity if there is none.
  double limitOf(const std::string& stylus, Key key) const;

  std::vector<Named> styluses_;
};

}  // namespace viscera::nodes
