// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tf2_ros/buffer.h>

#include <string>

#include "viscera/math/types.h"

namespace viscera::nodes {

/// The newest that tf knows of a frame, without waiting.
/// @param max_age_s  of a frame that moves [s]
/// @throws tf2::TransformException  tf does not join it to the tissue frame, has not heard of it for so long, or what
/// it heard is not finite
Pose newestPose(const tf2_ros::Buffer& frames, const std::string& tissue_frame, const std::string& frame,
                double max_age_s);

}  // namespace viscera::nodes
