// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tasks/task.h"
#include "viscera/model/scene/camera_config.h"
#include "viscera/session/frame.h"

namespace viscera {

/// Draws the lines of a task over an image, at their positions in the rest shape. @param camera  one without a frame
void drawTask(const TaskConfig& task, const CameraConfig& camera, ImageFrame& image);

}  // namespace viscera
