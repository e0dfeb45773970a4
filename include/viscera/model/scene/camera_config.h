// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/api.h"
#include "viscera/math/types.h"
#include "viscera/model/scene/overlays.h"
#include "viscera/model/scene/plumb_bob.h"

namespace VISCERA_PUBLIC viscera {

/// Light of a camera.
enum class CameraLight {
  kLamp,  ///< above the lens, equally bright at any distance
  kLens,  ///< at the lens, like an endoscope's: a cone that fades with the square of the distance
};

/// Preset of a scene's appearance, for values that the scene does not give.
enum class Look {
  kPlain,     ///< defaults of the keys
  kEndoscope  ///< light at the lens, wet tissue, contact shadows
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
  int supersampling = 0;  ///< samples per pixel along each axis; 0: as many as the renderer can afford, see Renderer
  Overlays overlays;
  double strain_range = 0.3;
  bool draw_hidden = false;
  std::string frame;             ///< tf frame that the camera is mounted on; empty: the tissue frame
  double stereo_baseline_m = 0;  ///< distance of the two eyes [m]; 0: one eye
  /// Lens distortion; lines of sight are unique and reach at most kFarthestSight times as far out.
  PlumbBob distortion;
  CameraLight light = CameraLight::kLamp;
  double light_cone_deg = 90;
  double contact_shadows = 0;
  std::string stylus;         ///< stylus that carries the camera, as an endoscope; empty: none
  double lens_angle_deg = 0;  ///< angle between the shaft of the endoscope and its line of sight [deg]
};

/// Largest distance of a line of sight from the middle of a distorted image, over its distance in a pinhole image.
constexpr double kFarthestSight = 2.5;

}  // namespace viscera
