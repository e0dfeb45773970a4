// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tasks/task_picture.h"

#include <cmath>

#include "tasks/task_kinds.h"
#include "viscera/render/camera.h"

namespace viscera {

namespace {

constexpr uint8_t kTaskColor[] = {0, 158, 115};  // bluish green of Okabe and Ito, as in the report's plots

void drawSegment(const Eigen::Vector2d& from, const Eigen::Vector2d& to, ImageFrame& image) {
  const int steps = std::max(1, static_cast<int>(std::ceil((to - from).cwiseAbs().maxCoeff())));
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d at = from + (to - from) * i / steps;
    if (!(at.x() >= 0 && at.y() >= 0 && at.x() < image.width && at.y() < image.height)) continue;
    const size_t pixel = static_cast<size_t>(at.y()) * static_cast<size_t>(image.width) + static_cast<size_t>(at.x());
    for (size_t k = 0; k < 3; ++k) image.rgb[3 * pixel + k] = kTaskColor[k];
  }
}

}  // namespace

void drawTask(const TaskConfig& task, const CameraConfig& camera, ImageFrame& image) {
  if (image.rgb.empty() || !camera.frame.empty()) return;
  const Pose optical = opticalPose(camera);
  const auto seen = [&](const Vector3d& position) {
    return pixelOf(camera, optical.orientation.conjugate() * (position - optical.position_m));
  };
  constexpr int kPieces = 64;  // pieces of a line, so that each is short in the image
  for (const std::vector<Vector3d>& line : kindOf(task.kind).shapes(task).lines_m) {
    for (size_t i = 1; i < line.size(); ++i) {
      for (int k = 0; k < kPieces; ++k) {
        const Vector3d offset = (line[i] - line[i - 1]) / kPieces;
        const auto from = seen(line[i - 1] + k * offset), to = seen(line[i - 1] + (k + 1) * offset);
        if (from && to && from->cwiseAbs().maxCoeff() < 1e5 && to->cwiseAbs().maxCoeff() < 1e5)
          drawSegment(*from, *to, image);
      }
    }
  }
}

}  // namespace viscera
