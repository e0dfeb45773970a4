// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
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
  /// Returns the field for cells of a spacing [m]: the same solid, in which strands thinner than a cell own all tissue
  /// of the cells that their axis passes through. Null: `field`.
  std::function<DistanceField(double spacing_m)> field_for_cells;
  std::vector<std::string> part_names;
  std::vector<Vector3d> part_colors;  ///< sRGB of each part; empty: parts have the body's colour
  Vector3d min_m, max_m;              ///< box around the tissue
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

constexpr int kMostPhantomSeed = 1000000;

/// Returns a gallbladder on the liver, with its ducts, vessels, fat and peritoneum. Seen from the front, by a camera
/// that looks along +y with z up, the liver is lifted: the fundus points to +z, and the common duct is at +x, the
/// patient's left. It ends at a plane below, where ducts and vessels are to be fixed. The gallbladder and the common
/// duct are hollow; strands thinner than a cell are solid. Parts: cystic_artery, hepatic_artery, cystic_duct,
/// common_hepatic_duct, common_bile_duct, infundibulum, gallbladder, gallbladder_bed, peritoneum, fat, liver_capsule,
/// liver.
/// @param length_m    from the top of the fundus to the lowest point of the infundibulum [m], 0.01..1; all sizes follow
///                    it. docs/user_guide.md has those at 0.08
/// @param wall_scale  multiplies the walls of the gallbladder and the common duct, 0.1..2
/// @param seed        variant (gallbladder_variant.h), 0..kMostPhantomSeed
/// @param parts       names of the parts that are built; none: all. The liver with its capsule, the fat with its
///                    peritoneum, and all else can be built without each other
/// @throws SceneError  a parameter out of its range, or other parts
Phantom gallbladderPhantom(double length_m, double wall_scale, int seed, const std::vector<std::string>& parts = {});

/// @throws SceneError  a value of a scene key that is out of its range or not a number
void requirePhantomRange(const char* key, double value, double low, double high);

/// Returns the paint of the heart's coronary vessels, in grooves with fat, for a surface of that heart
/// (heart_vessels.h).
PlacedPaint heartPaint(double length_m, double wall_scale);

}  // namespace viscera
