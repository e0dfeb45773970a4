// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Built as a surgeon would describe it: cavities first. Every cavity is wrapped in a wall, the walls are blended, and
// the cavities are subtracted again. Where two cavities would meet, the one listed later is cut back and leaves a wall
// between. Lengths are fractions of the distance from the base (the plane of the valves, z = 1) to the apex (z = 0).
#include "model/shape/organ/phantom.h"
#include "math/decompositions.h"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>

#include "math/number_text.h"
#include "model/shape/organ/heart_vessels.h"
#include "model/shape/organ/phantom_shapes.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

enum Part : uint16_t {
  kLeftVentricle,
  kRightVentricle,
  kLeftAtrium,
  kRightAtrium,
  kSeptum,
  kAorta,
  kPulmonaryArtery,
  kVenaCava
};

constexpr double kBase = 1;            ///< z of the valves
constexpr double kBlend = 0.05;        ///< width over which walls merge
constexpr double kRim = 0.08;          ///< rounding of the ventricles at the base
constexpr double kSeptumWall = 0.1;    ///< thickness between the ventricles
constexpr double kLumenOverrun = 0.2;  ///< distance by which a lumen is cut past the end of its vessel

/// Chamber or lumen of a vessel, with the wall around it.
struct Cavity {
  enum class Kind { kVentricle, kAtrium, kVessel };

  Part part;
  Kind kind;
  double wall;     ///< thickness before scaling
  Ellipsoid dome;  ///< for a chamber
  Tube tube;       ///< for a vessel, from its root to its open end
  Tube lumen;      ///< for a vessel, cut past that end

  /// Returns the distance to the cavity grown by `margin` on all sides.
  double grown(const Vector3d& p, double margin) const {
    if (kind == Kind::kVessel) return lumen.distance(p, margin);
    const double shell = Ellipsoid{dome.center, dome.radii + Vector3d::Constant(margin)}.distance(p);
    // Ventricles end at the plane of the valves, atria start there.
    const double floor = (kind == Kind::kVentricle ? p.z() - kBase : kBase - p.z()) - margin;
    return smoothMax(shell, floor, kRim);
  }

  /// Returns the distance to the cavity with a wall around it; a vessel is open at its end.
  double wrapped(const Vector3d& p, double thickness) const {
    if (kind == Kind::kVessel) return tube.distance(p, thickness);
    return grown(p, thickness);
  }

  /// Returns how far the cavity with its wall extends along a unit vector.
  double reach(const Vector3d& direction, double thickness) const {
    if (kind == Kind::kVessel) {
      const double along = direction.dot(tube.axis());
      const double aside = (tube.radius() + thickness) * std::sqrt(std::max(0.0, 1 - along * along));
      return std::max(direction.dot(tube.from()), direction.dot(tube.to())) + aside;
    }
    Vector3d radii = dome.radii + Vector3d::Constant(thickness);
    if (kind == Kind::kVentricle && direction.z() > 0) radii.z() = 0;
    const double lid = kind == Kind::kVentricle ? thickness * std::max(0.0, direction.z()) : 0;
    return direction.dot(dome.center) + direction.cwiseProduct(radii).norm() + lid;
  }
};

Cavity chamber(Part part, const Vector3d& center, const Vector3d& radii, double wall) {
  const bool is_ventricle = part == kLeftVentricle || part == kRightVentricle;
  return {part, is_ventricle ? Cavity::Kind::kVentricle : Cavity::Kind::kAtrium, wall, {center, radii}, {}, {}};
}

Cavity vessel(Part part, const Vector3d& root, const Vector3d& end, double radius, double wall) {
  const Tube tube(root, end, radius);
  return {part, Cavity::Kind::kVessel, wall, {}, tube, {root, end + kLumenOverrun * tube.axis(), radius}};
}

/// In order of precedence: where two cavities meet, the later one is cut back. +x is the patient's left, -y anterior.
const std::array<Cavity, 8>& cavities() {
  static const std::array<Cavity, 8> all = {
      chamber(kLeftVentricle, {0.16, 0.05, 1.0}, {0.22, 0.22, 0.88}, 0.12),
      chamber(kRightVentricle, {-0.12, -0.12, 1.0}, {0.38, 0.32, 0.70}, 0.05),
      vessel(kAorta, {0.04, 0.0, 1.0}, {0.14, -0.05, 1.58}, 0.11, 0.042),
      vessel(kPulmonaryArtery, {0.04, -0.30, 0.95}, {0.32, -0.26, 1.48}, 0.10, 0.042),
      chamber(kLeftAtrium, {0.20, 0.28, 1.18}, {0.26, 0.22, 0.22}, 0.045),
      chamber(kRightAtrium, {-0.30, 0.10, 1.20}, {0.23, 0.26, 0.26}, 0.045),
      vessel(kVenaCava, {-0.30, 0.12, 1.38}, {-0.20, 0.10, 1.72}, 0.075, 0.042),
      vessel(kVenaCava, {-0.28, 0.26, 1.08}, {-0.38, 0.36, 0.74}, 0.080, 0.042),
  };
  return all;
}

/// Returns the ventricular septal defect: just below the aortic valve, through the septum into the right ventricle.
const Tube& septalDefect() {
  static const Tube defect = {{0.12, 0.02, 0.82}, {-0.22, -0.16, 0.82}, 0.055};
  return defect;
}

/// Heart with its apex at (0, 0, 0) of its own frame, in fractions of its length.
class Heart {
 public:
  explicit Heart(double wall_scale) : wall_scale_(wall_scale) {}

  LabelledDistance at(const Vector3d& p) const {
    double outside = std::numeric_limits<double>::infinity(), hollow = outside;
    // A point belongs to the part of the cavity in the wall of which it is least deep.
    double least_depth = outside;
    uint16_t part = kLeftVentricle;
    const std::array<Cavity, 8>& all = cavities();
    double ventricles[2] = {0, 0};  // to the left and the right one
    for (size_t i = 0; i < all.size(); ++i) {
      const Cavity& cavity = all[i];
      const double own = cavity.grown(p, 0), distance = hollowOf(i, own, p), depth = distance / cavity.wall;
      if (i <= kRightVentricle) ventricles[i] = own;
      outside = smoothMin(outside, cavity.wrapped(p, wall_scale_ * cavity.wall), wall_scale_ * kBlend);
      hollow = std::min(hollow, distance);
      if (depth >= least_depth) continue;
      least_depth = depth;
      part = cavity.part;
    }
    hollow = std::min(hollow, septalDefect().distance(p));
    return {std::max(outside, -hollow), isSeptum(ventricles) ? uint16_t{kSeptum} : part};
  }

 private:
  double wallBetween(const Cavity& a, const Cavity& b) const {
    const bool is_septum = a.part == kLeftVentricle && b.part == kRightVentricle;
    return wall_scale_ * (is_septum ? kSeptumWall : std::min(a.wall, b.wall));
  }

  /// Returns the distance to a cavity after it was cut back for earlier ones. @param distance  to the whole of it
  double hollowOf(size_t index, double distance, const Vector3d& p) const {
    const std::array<Cavity, 8>& all = cavities();
    for (size_t i = 0; i < index && distance < kFar; ++i) {
      const Cavity &before = all[i], &cavity = all[index];
      distance = std::max(distance, -before.grown(p, wallBetween(before, cavity)));
    }
    return distance;
  }

  /// Returns whether a point is in the wall of the left ventricle where the right one touches it.
  bool isSeptum(const double (&ventricles)[2]) const {
    return ventricles[kLeftVentricle] < wall_scale_ * kSeptumWall && ventricles[kRightVentricle] < 0;
  }

  static constexpr double kFar = 0.15;  ///< farther from a cavity than any wall is thick, its shape has no effect
  double wall_scale_;
};

/// Returns the rotation of the heart's axis: the apex points down, to the patient's left and forward.
Quaterniond tilt() {
  return rotationBetween(-Vector3d::UnitZ(), Vector3d(0.4, -0.2, -0.9));
}

/// Returns the farthest extent of the tilted heart along one of the six axis directions.
double reach(const Vector3d& direction, double wall_scale) {
  double farthest = -std::numeric_limits<double>::infinity();
  for (const Cavity& cavity : cavities()) {
    farthest = std::max(farthest, cavity.reach(tilt().conjugate() * direction, wall_scale * cavity.wall));
  }
  return farthest + wall_scale * kBlend / 2;  // blending swells the seams
}

/// Returns the thinnest wall of each part, thinnest first; the septum is a thicker wall between two of them.
std::vector<Wall> wallsOf(const std::vector<std::string>& part_names, double scale) {
  std::vector<Wall> walls;
  for (const Cavity& cavity : cavities()) {
    const std::string& part = part_names[cavity.part];
    const double thickness_m = scale * cavity.wall;
    auto known = std::find_if(walls.begin(), walls.end(), [&](const Wall& wall) { return wall.part == part; });
    if (known == walls.end()) known = walls.insert(known, {part, thickness_m});
    known->thickness_m = std::min(known->thickness_m, thickness_m);
  }
  std::stable_sort(walls.begin(), walls.end(),
                   [](const Wall& a, const Wall& b) { return a.thickness_m < b.thickness_m; });
  return walls;
}

void requireRange(const char* key, double value, double low, double high) {
  if (value >= low && value <= high) return;
  TextOut out;
  out << key << " must be " << low << ".." << high << ", not " << value;
  throw SceneError(out.str());
}

/// Returns the box around the tilted heart, in fractions of its length.
std::pair<Vector3d, Vector3d> extent(double wall_scale) {
  Vector3d low, high;
  for (int i = 0; i < 3; ++i) {
    high[i] = reach(Vector3d::Unit(i), wall_scale);
    low[i] = -reach(-Vector3d::Unit(i), wall_scale);
  }
  return {low, high};
}

}  // namespace

PlacedPaint heartPaint(double length_m, double wall_scale) {
  const Heart heart(wall_scale);
  const auto right = [heart](const Vector3d& p) { return heart.at(p).part == kRightVentricle; };
  const auto [low, high] = extent(wall_scale);
  PlacedPaint out;
  out.paint =
      std::make_shared<const HeartVessels>([heart](const Vector3d& p) { return heart.at(p).distance_m; }, right);
  out.turn = tilt().conjugate();
  out.shift = out.turn * (0.5 * (low + high));
  out.unit_m = length_m;
  return out;
}

Phantom heartPhantom(double length_m, double wall_scale) {
  requireRange("phantom_length_m", length_m, 0.01, 1);
  requireRange("phantom_wall_scale", wall_scale, 0.1, 2);
  const auto [low, high] = extent(wall_scale);
  const Vector3d middle = 0.5 * (low + high);
  const auto position = [length_m, middle](const Vector3d& p) -> Vector3d { return length_m * (tilt() * p - middle); };
  Phantom phantom;
  phantom.part_names = {"left_ventricle", "right_ventricle", "left_atrium",      "right_atrium",
                        "septum",         "aorta",           "pulmonary_artery", "vena_cava"};
  phantom.walls = wallsOf(phantom.part_names, wall_scale * length_m);
  phantom.min_m = length_m * (low - middle);
  phantom.max_m = length_m * (high - middle);
  phantom.chamber_centers_m = {position({0.16, 0.05, 0.6}), position({-0.3, -0.25, 0.9}), position({0.22, 0.3, 1.2}),
                               position({-0.3, 0.1, 1.22})};
  const Tube& defect = septalDefect();
  phantom.defect_from_m = position(defect.from());
  phantom.defect_to_m = position(defect.to());
  phantom.defect_radius_m = length_m * defect.radius();
  phantom.field = [heart = Heart(wall_scale), upright = tilt().conjugate(), middle, length_m](const Vector3d& point_m) {
    LabelledDistance at = heart.at(upright * (point_m / length_m + middle));
    at.distance_m *= length_m;
    return at;
  };
  return phantom;
}

}  // namespace viscera
