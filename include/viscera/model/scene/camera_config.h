// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/math/types.h"
#include "viscera/model/scene/overlays.h"
#include "viscera/model/scene/plumb_bob.h"

namespace viscera {

/// Where the light comes from that a camera sees by.
enum class CameraLight {
  kLamp,  ///< above the lens, as bright at any distance
  kLens,  ///< at the lens, as an endoscope's: a cone that fades with the square of the distance
};

struct CameraConfig {
  std::string name = "camera";
  Vector3d position_m = Vector3d(0, -0.3, 0.1);
  Vector3d target_m = Vector3d::Zero();
  Vector3d up = Vector3d::UnitZ();
  double vertical_fov_deg = 35;
  int width_px = 640;
  int height_px = 480;
  double rate_hz = 30;
  int supersampling = 0;  ///< 0: as the renderer bears, see Renderer
  Overlays overlays;
  double strain_range = 0.3;
  bool draw_hidden = false;
  std::string frame;             ///< tf frame that carries it; empty: the tissue frame
  double stereo_baseline_m = 0;  ///< 0: one eye
  PlumbBob distortion;           ///< one line of sight per pixel, at most kFarthestSight times as far out
  CameraLight light = CameraLight::kLamp;
  double light_cone_deg = 90;
  double contact_shadows = 0;
};

/// How far from the middle of the image a line of sight may be of what a lens shows there, over a pinhole's.
constexpr double kFarthestSight = 2.5;

}  // namespace viscera
