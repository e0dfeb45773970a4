// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "model/shape/detail/detail_paint.h"
#include "viscera/model/shape/solid.h"

namespace viscera {

/// Wall of an organ, with its thickness as constructed.
struct Wall {
  std::string part;
  double thickness_m = 0;
};

/// Built-in organ that needs no download: a distance field with its bounds and part names.
struct Phantom {
  DistanceField field;
  std::vector<std::string> part_names;
  Vector3d min_m, max_m;  ///< box around the tissue
  /// A point in each chamber: left and right ventricle, left and right atrium.
  std::vector<Vector3d> chamber_centers_m;
  Vector3d defect_from_m, defect_to_m;  ///< axis of the septal defect, from the left into the right ventricle
  double defect_radius_m = 0;
  std::vector<Wall> walls;  ///< one wall of each part that has one, the thinnest first
};

/// Returns a four-chamber heart with open great-vessel stubs and a ventricular septal defect, its box centred on the
/// origin. Seen from the front, by a camera that looks along +y with z up, the patient's left is +x, and the apex
/// points to -z, +x and -y. The valves are closed. The left and right ventricle share one cavity through the defect;
/// each atrium has its own. Parts: left_ventricle, right_ventricle, left_atrium, right_atrium, septum, aorta,
/// pulmonary_artery, vena_cava.
/// @param length_m    from the base (the plane of the valves) to the apex [m], 0.01..1
/// @param wall_scale  multiplies every wall thickness, 0.1..2. At 1 the thinnest wall is 0.042 length_m
/// @throws SceneError  a parameter out of its range
Phantom heartPhantom(double length_m, double wall_scale);

/// Returns the paint of its coronary vessels, in grooves with fat, for a surface of that heart (heart_vessels.h).
PlacedPaint heartPaint(double length_m, double wall_scale);

}  // namespace viscera
