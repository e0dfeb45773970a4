// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "nodes/ros/slowness.h"
#include "viscera/model/scene/camera_config.h"

namespace viscera::nodes {

/// Says how a camera's pictures are drawn, once, and which cameras' pictures come far less often than they are wanted.
class PictureWatch {
 public:
  explicit PictureWatch(const std::vector<CameraConfig>& cameras);

  /// A reading of a second. @param wanted_hz  [cameras] 0: not wanted   @param sent_hz  [cameras]
  /// @return  what is to be said now, a line each
  std::vector<std::string> note(const std::vector<double>& wanted_hz, const std::vector<double>& sent_hz);
  /// Whether any camera's pictures fell behind in the last reading.
  bool areBehind() const { return behind_; }
  /// How each camera's pixels are made, a line each. @param software  the renderer is
  std::vector<std::string> ways(bool software) const;

  static constexpr double kShare = 1.0 / 3;  ///< of the wanted rate, below which pictures are behind
  static constexpr int kReadings = 4;        ///< in a row before it is said

 private:
  std::vector<CameraConfig> cameras_;
  std::vector<Slowness> slowness_;
  bool behind_ = false;
};

}  // namespace viscera::nodes
