// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/heart_vessels.h"

#include <algorithm>
#include <cmath>

namespace viscera {

namespace {

// Where rays to the ventricles' outer surface begin: within them, at the apex and at the base.
const Vector3d kApex(0.16, 0.05, 0), kBase(0.02, -0.05, 1);
constexpr double kFarthest = 0.9;    // of the surface from the axis
constexpr double kTop = 0.955;       // of the groove below the atria
constexpr double kVeinBeside = 2.4;  // radii of the artery from its middle to the vein's
constexpr int kPointsPerPath = 24;
constexpr double kFacing = 0.2;                            // cosine: what faces elsewhere is the wall's other side
constexpr double kFatHeight = 0.010, kVesselHeight = 0.8;  // of the heart's length; of a vessel's radius

const Vector3f kArtery(0.36F, 0.035F, 0.03F), kVein(0.13F, 0.035F, 0.075F), kFat(0.72F, 0.44F, 0.12F);  // linear

double hashed(uint32_t seed) {
  uint32_t h = seed * 0x9e3779b9U;
  h = (h ^ h >> 15U) * 0x2c1b3c6dU;
  h = (h ^ h >> 12U) * 0x297a2d39U;
  return static_cast<double>((h ^ h >> 15U) >> 8U) / 16777216.0;
}

/// -1..1, smooth: what makes the border of fat uneven.
double wavy(const Vector3d& p) {
  return (std::sin(41 * p.x() + 17 * p.y()) + std::sin(37 * p.y() + 29 * p.z() + 1) +
          std::sin(43 * p.z() - 23 * p.x() + 2)) /
         3;
}

constexpr double kCell = 0.04;  // of space, for what is near
constexpr double kReach = 1.4;  // radii or widths of fat: what is farther does not show

uint64_t cellOf(const Vector3i& at) {
  const auto bits = [](int i) { return static_cast<uint64_t>(i + 1024) & 0xfffffU; };
  return bits(at.x()) | bits(at.y()) << 20U | bits(at.z()) << 40U;
}

Vector3i cellAt(const Vector3d& place) {
  return (place / kCell).array().floor().cast<int>();
}

double smoothStep(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace

/// The outermost place of the tissue along a ray from the axis.
HeartVessels::Point HeartVessels::onSurface(double z, double turn, double radius, double fat) const {
  const Vector3d from = kApex + z * (kBase - kApex), way(std::cos(turn), std::sin(turn), 0);
  double outside = kFarthest, inside = 0;
  constexpr double kStep = 0.01;
  for (double r = kFarthest; r > 0; r -= kStep) {
    if (field_(from + r * way) < 0) {
      inside = r;
      break;
    }
    outside = r;
  }
  for (int i = 0; i < 20; ++i) {
    const double middle = (inside + outside) / 2;
    (field_(from + middle * way) < 0 ? inside : outside) = middle;
  }
  Point point{from + inside * way, Vector3d::Zero(), radius, fat};
  constexpr double kDifference = 1e-3;
  for (int i = 0; i < 3; ++i) {
    const Vector3d d = kDifference * Vector3d::Unit(i);
    point.normal[i] = field_(point.at + d) - field_(point.at - d);
  }
  point.normal.stableNormalize();
  return point;
}

/// Where the surface passes from one ventricle to the other, at a height between two turns.
double HeartVessels::groove(double z, double from, double to) const {
  const auto right = [&](double turn) {
    const Point p = onSurface(z, turn, 0, 0);
    return is_right_(p.at - 0.01 * p.normal);
  };
  const bool at_from = right(from);
  constexpr int kSteps = 48;
  double before = from;
  for (int i = 1; i <= kSteps; ++i) {
    const double turn = from + (to - from) * i / kSteps;
    if (right(turn) != at_from) return (before + turn) / 2;
    before = turn;
  }
  return (from + to) / 2;
}

void HeartVessels::addPath(const std::vector<Point>& points, Kind kind) {
  for (size_t i = 1; i < points.size(); ++i) pieces_.push_back({points[i - 1], points[i], kind});
}

void HeartVessels::addWithVein(const std::vector<Point>& points) {
  addPath(points, Kind::kArtery);
  std::vector<Point> vein = points;
  for (size_t i = 0; i < vein.size(); ++i) {
    const Vector3d way = points[std::min(i + 1, points.size() - 1)].at - points[i == 0 ? 0 : i - 1].at;
    vein[i].at += kVeinBeside * points[i].radius * points[i].normal.cross(way).stableNormalized();
    vein[i].radius *= 0.85;
    vein[i].fat = 0;
  }
  addPath(vein, Kind::kVein);
}

/// From one place to another, winding, thinner as it goes, with twigs.
void HeartVessels::addBranch(double z, double turn, double to_z, double to_turn, double radius, int order,
                             uint32_t seed) {
  std::vector<Point> path;
  for (int i = 0; i <= kPointsPerPath; ++i) {
    const double s = static_cast<double>(i) / kPointsPerPath, bend = 0.05 * std::sin(7 * s + 6 * hashed(seed)) * s;
    const double at_z = z + (to_z - z) * s + 0.3 * bend, at_turn = turn + (to_turn - turn) * std::sqrt(s) + bend;
    path.push_back(onSurface(std::clamp(at_z, 0.03, kTop), at_turn, radius * (1 - 0.75 * s),
                             order == 1 ? 2.2 * radius * (1 - s) : 0));
    const bool forks = order < 3 && i > 3 && i < kPointsPerPath - 2 && i % (order == 1 ? 5 : 8) == 0;
    if (!forks) continue;
    const double side = hashed(seed + static_cast<uint32_t>(i)) < 0.5 ? -1 : 1;
    const double reach = (1 - 0.5 * s) * (order == 1 ? 0.30 : 0.16);
    addBranch(at_z, at_turn, at_z - reach * 0.8, at_turn + side * reach * 1.2, 0.55 * radius * (1 - 0.6 * s), order + 1,
              seed * 7 + static_cast<uint32_t>(i));
  }
  if (order == 1) {
    addWithVein(path);
  } else {
    addPath(path, Kind::kArtery);
  }
}

HeartVessels::HeartVessels(const Field& field, const IsRight& is_right) : field_(field), is_right_(is_right) {
  constexpr double kPi = 3.14159265358979323846, kTrunk = 0.012, kTrunkFat = 0.055;
  constexpr int kBranches = 4;
  // +x is the patient's left, -y anterior: the grooves between the ventricles are before and behind.
  for (const bool anterior : {true, false}) {
    const double from = anterior ? -0.85 * kPi : 0.85 * kPi, to = anterior ? -0.1 * kPi : 0.15 * kPi;
    const double last_z = anterior ? 0.1 : 0.2, radius = anterior ? kTrunk : 0.8 * kTrunk;
    std::vector<Point> path;
    double turn = 0;
    for (int i = 0; i <= 2 * kPointsPerPath; ++i) {
      const double s = static_cast<double>(i) / (2 * kPointsPerPath), z = kTop + (last_z - kTop) * s;
      const double found = groove(z, from, to);
      turn = i == 0 ? found : turn + std::clamp(found - turn, -0.06, 0.06);  // near the apex it jumps
      path.push_back(onSurface(z, turn + 0.02 * std::sin(9 * s), radius * (1 - 0.6 * s), kTrunkFat * (1 - 0.7 * s)));
      if (i % (2 * kPointsPerPath / (kBranches + 1)) != 4) continue;
      const auto seed = static_cast<uint32_t>(i + (anterior ? 100 : 900));
      const double away = anterior ? 1 : -1;  // turns to the left ventricle
      addBranch(z, turn, std::max(0.08, z - 0.42), turn + away * (0.75 + 0.3 * hashed(seed)), 0.65 * radius, 1, seed);
      addBranch(z, turn, std::max(0.12, z - 0.25), turn - away * (0.55 + 0.3 * hashed(seed + 1)), 0.45 * radius, 1,
                seed + 50);
    }
    addWithVein(path);
  }
  std::vector<Point> around;  // between atria and ventricles
  constexpr int kAround = 96;
  for (int i = 0; i <= kAround; ++i) {
    const double turn = 2 * kPi * i / kAround;
    around.push_back(onSurface(kTop + 0.01 * std::sin(5 * turn), turn, 0.9 * kTrunk, 1.15 * kTrunkFat));
    if (i % 16 == 8) {
      const auto seed = static_cast<uint32_t>(2000 + i);
      addBranch(kTop, turn, 0.45 + 0.2 * hashed(seed), turn + 0.25 * (hashed(seed + 1) - 0.5), 0.5 * kTrunk, 1, seed);
    }
  }
  addWithVein(around);
  findNear();
}

void HeartVessels::findNear() {
  for (uint32_t i = 0; i < pieces_.size(); ++i) {
    const Piece& piece = pieces_[i];
    const double reach = kReach * std::max(piece.a.radius, piece.a.fat);
    const Vector3i low = cellAt((piece.a.at.cwiseMin(piece.b.at).array() - reach).matrix());
    const Vector3i high = cellAt((piece.a.at.cwiseMax(piece.b.at).array() + reach).matrix());
    for (int z = low.z(); z <= high.z(); ++z) {
      for (int y = low.y(); y <= high.y(); ++y) {
        for (int x = low.x(); x <= high.x(); ++x) near_[cellOf({x, y, z})].push_back(i);
      }
    }
  }
}

PaintedSpot HeartVessels::at(const Vector3d& place, const Vector3d& normal) const {
  double fat = 0, best = 1, radius = 1;
  const Piece* nearest = nullptr;
  const auto here = near_.find(cellOf(cellAt(place)));
  if (here == near_.end()) return {kFat, 0, 0};  // mipmaps mix colours of what does not cover, too
  for (const uint32_t i : here->second) {
    const Piece& piece = pieces_[i];
    const Vector3d way = piece.b.at - piece.a.at, from = place - piece.a.at;
    const double widest = std::max(piece.a.radius, piece.a.fat);
    if (from.squaredNorm() > std::pow(way.norm() + kReach * widest, 2) || normal.dot(piece.a.normal) < kFacing)
      continue;
    const double along = std::clamp(from.dot(way) / std::max(way.squaredNorm(), 1e-12), 0.0, 1.0);
    const double distance = (from - along * way).norm();
    const double of_radius = piece.a.radius + along * (piece.b.radius - piece.a.radius);
    const double of_fat = piece.a.fat + along * (piece.b.fat - piece.a.fat);
    if (of_fat > 0) fat = std::max(fat, 1 - distance / (of_fat * (1 + 0.35 * wavy(place))));
    if (of_radius > 0 && distance / of_radius < best) {
      best = distance / of_radius;
      radius = of_radius;
      nearest = &piece;
    }
  }
  PaintedSpot spot;
  const double cover = smoothStep(0, 0.35, fat), vessel = nearest == nullptr ? 0 : 1 - smoothStep(0.7, 1, best);
  const double lumps = 1 + 0.25 * wavy(2.3 * place);
  spot.height_m = static_cast<float>(kFatHeight * cover * lumps * (0.6 + 0.4 * fat));
  if (nearest != nullptr)
    spot.height_m += static_cast<float>(kVesselHeight * radius * std::sqrt(std::max(0.0, 1 - best * best)));
  const Vector3f of_vessel = nearest == nullptr || nearest->kind == Kind::kArtery ? kArtery : kVein;
  // Fat lies over the larger vessels in part, and shows through a thin film elsewhere.
  const auto share = static_cast<float>(vessel * (1 - 0.12 * cover));
  spot.color = share * of_vessel + (1 - share) * static_cast<float>(0.9 + 0.1 * lumps) * kFat;
  spot.cover = static_cast<float>(std::max(0.82 * cover, 0.85 * vessel));
  if (cover == 0 && vessel > 0) spot.color = of_vessel;
  return spot;
}

}  // namespace viscera
