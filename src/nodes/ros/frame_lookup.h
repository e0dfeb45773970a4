// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tf2_ros/buffer.h>

#include <string>

#include "viscera/math/types.h"

namespace viscera::nodes {

/// Returns the newest pose of a frame in tf, without waiting.
/// @param max_age_s  largest age of a moving frame's transform [s]
/// @throws tf2::TransformException  tf does not connect it to the tissue frame, or the transform is too old or not
/// finite
Pose newestPose(const tf2_ros::Buffer& frames, const std::string& tissue_frame, const std::string& frame,
                double max_age_s);

}  // namespace viscera::nodes
