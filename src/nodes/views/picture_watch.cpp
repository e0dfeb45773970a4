// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/views/picture_watch.h"

#include "math/number_text.h"
#include "render/g_buffer.h"
#include "viscera/render/camera.h"

namespace viscera::nodes {

PictureWatch::PictureWatch(const std::vector<CameraConfig>& cameras)
    : cameras_(cameras), slowness_(cameras.size(), Slowness(kReadings)) {}

std::vector<std::string> PictureWatch::record(const std::vector<double>& wanted_hz,
                                              const std::vector<double>& sent_hz) {
  std::vector<std::string> out;
  behind_ = false;
  for (size_t c = 0; c < cameras_.size(); ++c) {
    const bool behind = sent_hz[c] < kShare * wanted_hz[c];
    behind_ = behind_ || behind;
    if (!slowness_[c].record(behind)) continue;
    const CameraConfig& camera = cameras_[c];
    TextOut text;
    text.precision(2);
    text << "camera '" << camera.name << "': " << sent_hz[c] << " pictures per second of " << wanted_hz[c]
         << " wanted, for " << kReadings << " s. Possible remedies: fewer pixels (cameras[].width_px "
         << camera.width_px << ", height_px " << camera.height_px
         << "), cameras[].supersampling 1, a lower cameras[].rate_hz, fewer cameras with subscribers; a coarser "
            "bodies[].spacing_m, or 'auto', which reserves CPU time for pictures; fewer other "
            "programs; a GPU";
    out.push_back(text.str());
  }
  return out;
}

std::vector<std::string> PictureWatch::renderPaths(bool software) const {
  std::vector<std::string> out;
  for (const CameraConfig& camera : cameras_) {
    const CameraConfig drawn = pinholeOf(camera);
    TextOut text;
    text << "camera '" << camera.name << "': " << camera.width_px << " x " << camera.height_px << " pixels, ";
    if (camera.supersampling == 1) {
      text << "1 sample each; edges are not smooth";
    } else if (camera.supersampling == 0 && software && drawn.width_px * drawn.height_px <= GBuffer::kMostPixels) {
      text << "4 samples each; without a GPU only one is lit, and all at edges "
              "(cameras[].supersampling: 2 lights all)";
    } else {
      text << "4 samples each";
    }
    out.push_back(text.str());
  }
  return out;
}

}  // namespace viscera::nodes
