// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "viscera/api.h"

namespace VISCERA_PUBLIC viscera {

/// Lens distortion as in OpenCV and sensor_msgs/CameraInfo (plumb_bob): radial k, tangential p. All 0: a pinhole.
struct PlumbBob {
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;

  bool any() const { return k1 != 0 || k2 != 0 || p1 != 0 || p2 != 0 || k3 != 0; }
};

/// Returns the image position at which the lens shows what a pinhole shows at `place`. Both are tangents, x / z and y /
/// z of the optical frame.
Eigen::Vector2d distorted(const PlumbBob& lens, const Eigen::Vector2d& position);

/// Returns the pinhole position that the lens shows at `place`, the inverse of distorted(). None where no position
/// near the middle is shown there: the image folds over.
std::optional<Eigen::Vector2d> undistorted(const PlumbBob& lens, const Eigen::Vector2d& position);

}  // namespace viscera
