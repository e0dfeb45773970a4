// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "viscera/model/scene/overrides.h"
#include "viscera/model/scene/stylus_config.h"

namespace viscera::nodes {

/// Limits of forces that the overrides of a launch set: bounds for the styluses of every scene that is loaded later.
/// Limits that a scene file sets are of that scene alone.
class LaunchLimits {
 public:
  /// @param styluses   of the scene that was launched, without the limits of their devices
  /// @param overrides  its overrides
  LaunchLimits(const std::vector<StylusConfig>& styluses, const Overrides& overrides);

  /// Lowers limits to those of the launch. A stylus of a name that the launched scene did not have gets the least of
  /// them, since any of the devices may be its.
  /// @returns a line for each limit that was lowered
  std::vector<std::string> bound(std::vector<StylusConfig>& styluses) const;

 private:
  using Key = double StylusConfig::*;
  struct Named {
    std::string stylus;
    std::vector<std::pair<Key, double>> limits;
  };
  /// @returns infinity: none
  double limitOf(const std::string& stylus, Key key) const;

  std::vector<Named> styluses_;
};

}  // namespace viscera::nodes
