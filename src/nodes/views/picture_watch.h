// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "nodes/ros/slowness.h"
#include "viscera/model/scene/camera_config.h"

namespace viscera::nodes {

/// Reports how a camera's images are drawn, once, and which cameras' images come much more rarely than desired.
class PictureWatch {
 public:
  explicit PictureWatch(const std::vector<CameraConfig>& cameras);

  /// Adds a reading of one second. @param wanted_hz  [cameras] 0: no subscriber   @param sent_hz  [cameras]
  /// @return  lines to log now
  std::vector<std::string> record(const std::vector<double>& wanted_hz, const std::vector<double>& sent_hz);
  /// Returns whether any camera's images were behind in the last reading.
  bool areBehind() const { return behind_; }
  /// Returns a line per camera that says how its pixels are drawn.
  /// @param software  whether the renderer runs in software
  std::vector<std::string> renderPaths(bool software) const;

  static constexpr double kShare = 1.0 / 3;  ///< share of the desired rate below which images are behind
  static constexpr int kReadings = 4;        ///< number of readings in a row before a warning

 private:
  std::vector<CameraConfig> cameras_;
  std::vector<Slowness> slowness_;
  bool behind_ = false;
};

}  // namespace viscera::nodes
