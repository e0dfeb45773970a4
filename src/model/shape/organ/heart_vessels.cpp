// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/organ/heart_vessels.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "math/in_parallel.h"

namespace viscera {

namespace {

// Origins of rays to the ventricles' outer surface: inside them, at the apex and at the base.
const Vector3d kApex(0.16, 0.05, 0), kBase(0.02, -0.05, 1);
constexpr double kFarthest = 0.9;    // largest distance of the surface from the axis
constexpr double kTop = 0.955;       // height of the groove below the atria
constexpr double kVeinBeside = 2.4;  // distance between the axes of artery and vein, in radii of the artery
constexpr int kPointsPerPath = 24;
constexpr float kFacing = 0.2F;  // cosine: a surface that faces elsewhere is the wall's other side
constexpr float kFatHeight = 0.010F, kVesselHeight = 0.8F;  // share of the heart's length; of a vessel's radius

const Vector3f kArtery(0.36F, 0.035F, 0.03F), kVein(0.13F, 0.035F, 0.075F), kFat(0.72F, 0.44F, 0.12F);  // linear

double hashed(uint32_t seed) {
  uint32_t h = seed * 0x9e3779b9U;
  h = (h ^ h >> 15U) * 0x2c1b3c6dU;
  h = (h ^ h >> 12U) * 0x297a2d39U;
  return static_cast<double>((h ^ h >> 15U) >> 8U) / 16777216.0;
}

/// Returns a sine, accurate to 4e-6 up to about a hundred radians, without branches, so that loops vectorise.
inline float sine(float x) {
  constexpr float kPerTurn = 0.15915494F, kWhole = 12582912;  // 1.5 * 2^23: adding it rounds to integers
  const float turns = x * kPerTurn, part = turns - ((turns + kWhole) - kWhole), size = std::abs(part);
  const float folded = size > 0.25F ? std::copysign(0.5F, part) - part : part, square = folded * folded;
  constexpr std::array<float, 5> kTaylor = {6.2831853F, -41.341702F, 81.605249F, -76.705860F, 42.058694F};
  return folded *
         (kTaylor[0] + square * (kTaylor[1] + square * (kTaylor[2] + square * (kTaylor[3] + square * kTaylor[4]))));
}

/// Returns a smooth function in -1..1 that makes the border of fat uneven.
inline float wavy(float x, float y, float z) {
  return (sine(41 * x + 17 * y) + sine(37 * y + 29 * z + 1) + sine(43 * z - 23 * x + 2)) / 3;
}

constexpr float kCell = 0.04F;    // cell of the spatial hash
constexpr float kUneven = 0.35F;  // unevenness of the border of fat
constexpr float kRound = 1.0001F;

uint64_t cellOf(const Vector3i& at) {
  const auto bits = [](int i) { return static_cast<uint64_t>(i + 1024) & 0xfffffU; };
  return bits(at.x()) | bits(at.y()) << 20U | bits(at.z()) << 40U;
}

Vector3i cellAt(const Vector3f& position) {
  return (position / kCell).array().floor().cast<int>();
}

// By value, for loops over lanes: GCC makes branches of std::max's references.
inline float larger(float a, float b) {
  return a > b ? a : b;
}
inline float within(float x, float low, float high) {
  const float above = x > low ? x : low;
  return above < high ? above : high;
}
constexpr float kLeast = 1e-9F;   // smallest radius to divide by
constexpr float kElsewhere = 10;  // farther than anything on a heart

float reachOf(float radius, float fat) {
  return kRound * std::max(radius, (1 + kUneven) * fat);
}

inline float smoothStep(float from, float to, float x) {
  const float t = within((x - from) / (to - from), 0, 1);
  return t * t * (3 - 2 * t);
}

inline float lumps(const PaintRow& row, size_t l) {
  constexpr float kFiner = 2.3F;
  return 1 + 0.25F * wavy(kFiner * row.position[0][l], kFiner * row.position[1][l], kFiner * row.position[2][l]);
}

}  // namespace

/// Returns the outermost point of the tissue along a ray from the axis.
Vector3d HeartVessels::outermost(double z, double turn, int halvings) const {
  const Vector3d from = kApex + z * (kBase - kApex), direction(std::cos(turn), std::sin(turn), 0);
  double outside = kFarthest, inside = 0;
  constexpr double kStep = 0.01;
  // The field is nowhere kSteepest times as steep as a distance: the skipped steps contain no tissue.
  constexpr double kSteepest = 4;
  int steps = 0;
  for (double r = kFarthest; r > 0; r -= kStep, --steps) {
    const double distance = steps > 0 ? 0 : field_(from + r * direction);
    if (distance < 0) {
      inside = r;
      break;
    }
    if (steps <= 0) steps = static_cast<int>(distance / (kSteepest * kStep));
    outside = r;
  }
  for (int i = 0; i < halvings; ++i) {
    const double middle = (inside + outside) / 2;
    (field_(from + middle * direction) < 0 ? inside : outside) = middle;
  }
  return from + inside * direction;
}

Vector3d HeartVessels::normalAt(const Vector3d& position) const {
  constexpr double kDifference = 1e-3;
  Vector3d out;
  for (int i = 0; i < 3; ++i) {
    const Vector3d d = kDifference * Vector3d::Unit(i);
    out[i] = field_(position + d) - field_(position - d);
  }
  out.stableNormalize();
  return out;
}

HeartVessels::Point HeartVessels::onSurface(double z, double turn, double radius, double fat) const {
  const Vector3d at = outermost(z, turn, 20);
  return {at, normalAt(at), radius, fat};
}

/// Returns where the surface passes from one ventricle to the other, at a height between two angles.
double HeartVessels::groove(double z, double from, double to) const {
  constexpr int kHalvings = 20;
  const auto right = [&](double turn) {
    const Vector3d at = outermost(z, turn, kHalvings);
    return is_right_(at - 0.01 * normalAt(at));
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
  for (size_t i = 1; i < points.size(); ++i) {
    const Point &a = points[i - 1], &b = points[i];
    const Vector3d direction = b.at - a.at;
    pieces_.push_back({a.at.cast<float>(), direction.cast<float>(), a.normal.cast<float>(),
                       static_cast<float>(1 / std::max(direction.squaredNorm(), 1e-12)), static_cast<float>(a.radius),
                       static_cast<float>(b.radius - a.radius), static_cast<float>(a.fat),
                       static_cast<float>(b.fat - a.fat), kind == Kind::kVein ? 1.0F : 0.0F});
  }
}

void HeartVessels::addWithVein(const std::vector<Point>& points) {
  addPath(points, Kind::kArtery);
  std::vector<Point> vein = points;
  for (size_t i = 0; i < vein.size(); ++i) {
    const Vector3d direction = points[std::min(i + 1, points.size() - 1)].at - points[i == 0 ? 0 : i - 1].at;
    vein[i].at += kVeinBeside * points[i].radius * points[i].normal.cross(direction).stableNormalized();
    vein[i].radius *= 0.85;
    vein[i].fat = 0;
  }
  addPath(vein, Kind::kVein);
}

/// Adds a winding branch from one position to another, which becomes thinner and has twigs.
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
  // +x is the patient's left, -y anterior: the grooves between the ventricles are anterior and posterior.
  for (const bool anterior : {true, false}) {
    const double from = anterior ? -0.85 * kPi : 0.85 * kPi, to = anterior ? -0.1 * kPi : 0.15 * kPi;
    const double last_z = anterior ? 0.1 : 0.2, radius = anterior ? kTrunk : 0.8 * kTrunk;
    const auto shareOf = [](int i) { return static_cast<double>(i) / (2 * kPointsPerPath); };
    std::vector<double> grooves(2 * kPointsPerPath + 1);
    inParallel(grooves.size(),
               [&](size_t i) { grooves[i] = groove(kTop + (last_z - kTop) * shareOf(static_cast<int>(i)), from, to); });
    std::vector<Point> path;
    double turn = 0;
    for (int i = 0; i <= 2 * kPointsPerPath; ++i) {
      const double s = shareOf(i), z = kTop + (last_z - kTop) * s, found = grooves[static_cast<size_t>(i)];
      turn = i == 0 ? found : turn + std::clamp(found - turn, -0.06, 0.06);  // near the apex it jumps
      path.push_back(onSurface(z, turn + 0.02 * std::sin(9 * s), radius * (1 - 0.6 * s), kTrunkFat * (1 - 0.7 * s)));
      if (i % (2 * kPointsPerPath / (kBranches + 1)) != 4) continue;
      const auto seed = static_cast<uint32_t>(i + (anterior ? 100 : 900));
      const double away = anterior ? 1 : -1;  // turns towards the left ventricle
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
  listCells();
}

void HeartVessels::listCells() {
  for (uint32_t i = 0; i < pieces_.size(); ++i) {
    const Piece& piece = pieces_[i];
    const float reach = reachOf(piece.radius, piece.fat);
    const Vector3f b = piece.a + piece.direction;
    const Vector3i low = cellAt((piece.a.cwiseMin(b).array() - reach).matrix());
    const Vector3i high = cellAt((piece.a.cwiseMax(b).array() + reach).matrix());
    for (int z = low.z(); z <= high.z(); ++z) {
      for (int y = low.y(); y <= high.y(); ++y) {
        for (int x = low.x(); x <= high.x(); ++x) cells_[cellOf({x, y, z})].push_back(i);
      }
    }
  }
}

Vector3f HeartVessels::ground() const {
  return kFat;
}

void HeartVessels::findNear(const Vector3f& middle, float radius, std::vector<uint32_t>& near) const {
  near.clear();
  const Vector3i low = cellAt((middle.array() - radius).matrix()), high = cellAt((middle.array() + radius).matrix());
  for (int z = low.z(); z <= high.z(); ++z) {
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int x = low.x(); x <= high.x(); ++x) {
        const auto here = cells_.find(cellOf({x, y, z}));
        if (here == cells_.end()) continue;
        for (const uint32_t i : here->second) {
          if (reaches(i, middle, radius)) near.push_back(i);
        }
      }
    }
  }
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
}

bool HeartVessels::reaches(uint32_t index, const Vector3f& middle, float radius) const {
  const Piece& piece = pieces_[index];
  const Vector3f from = middle - piece.a;
  const Vector3f apart = from - within(from.dot(piece.direction) * piece.per_path2, 0, 1) * piece.direction;
  const float reach = radius + reachOf(piece.radius, piece.fat);
  return apart.squaredNorm() <= reach * reach;
}

void HeartVessels::narrow(const std::vector<uint32_t>& near, const Vector3f& middle, float radius,
                          const Vector3f& normal, float spread, std::vector<uint32_t>& nearer) const {
  nearer.clear();
  for (const uint32_t i : near) {
    if (normal.dot(pieces_[i].normal) + spread >= kFacing && reaches(i, middle, radius)) nearer.push_back(i);
  }
}

struct HeartVessels::Sums {
  PaintRow::Lane fat{};     ///< depth within fat, 0 at its border and 1 at its middle
  PaintRow::Lane best{};    ///< distance from the nearest vessel, in its radii
  PaintRow::Lane radius{};  ///< radius of that vessel
  PaintRow::Lane vein{};    ///< 1: it is a vein
};

HeartVessels::Sums HeartVessels::sumsOf(const std::vector<uint32_t>& near, const PaintRow& row) const {
  const auto& [px, py, pz] = row.position;
  const auto& [nx, ny, nz] = row.normal;
  Sums out;
  out.best.fill(1);
  out.radius.fill(1);
  PaintRow::Lane per_edge, distance, of_radius, of_fat;
  for (size_t l = 0; l < PaintRow::kMost; ++l) per_edge[l] = 1 / (1 + kUneven * wavy(px[l], py[l], pz[l]));
  for (const uint32_t index : near) {
    const Piece& piece = pieces_[index];
    const float ax = piece.a.x(), ay = piece.a.y(), az = piece.a.z(), wx = piece.direction.x(),
                wy = piece.direction.y(), wz = piece.direction.z(), mx = piece.normal.x(), my = piece.normal.y(),
                mz = piece.normal.z(), per_path2 = piece.per_path2, radius = piece.radius,
                radius_change = piece.radius_change, fat = piece.fat, fat_change = piece.fat_change, vein = piece.vein,
                has_fat = fat > 0 ? 1.F : 0.F;
    for (size_t l = 0; l < PaintRow::kMost; ++l) {
      const float x = px[l] - ax, y = py[l] - ay, z = pz[l] - az;
      const float along = within((x * wx + y * wy + z * wz) * per_path2, 0, 1);
      const float u = x - along * wx, v = y - along * wy, w = z - along * wz;
      const float facing = nx[l] * mx + ny[l] * my + nz[l] * mz;
      distance[l] = std::sqrt(u * u + v * v + w * w) + (facing < kFacing ? kElsewhere : 0.F);
      of_radius[l] = larger(radius + along * radius_change, kLeast);
      of_fat[l] = larger(fat + along * fat_change, kLeast);
    }
    for (size_t l = 0; l < PaintRow::kMost; ++l)
      out.fat[l] = larger(out.fat[l], has_fat - distance[l] * per_edge[l] / of_fat[l]);
    for (size_t l = 0; l < PaintRow::kMost; ++l) {
      const float radii = distance[l] / of_radius[l], best = out.best[l];
      const float nearer = radii < best ? 1.F : 0.F;
      out.best[l] = radii < best ? radii : best;
      out.radius[l] += nearer * (of_radius[l] - out.radius[l]);
      out.vein[l] += nearer * (vein - out.vein[l]);
    }
  }
  return out;
}

/// Returns the height of fat and vessels at a point of a row.
template <class Sums>
static inline float height(const PaintRow& row, const Sums& sums, size_t l) {
  const float fat = kFatHeight * smoothStep(0, 0.35F, sums.fat[l]) * lumps(row, l) * (0.6F + 0.4F * sums.fat[l]);
  return fat + kVesselHeight * sums.radius[l] * std::sqrt(larger(0, 1 - sums.best[l] * sums.best[l]));
}

void HeartVessels::raise(const std::vector<uint32_t>& near, PaintRow& row) const {
  const Sums sums = sumsOf(near, row);
  for (size_t l = 0; l < PaintRow::kMost; ++l) row.height[l] = height(row, sums, l);
}

void HeartVessels::paint(const std::vector<uint32_t>& near, PaintRow& row) const {
  const Sums sums = sumsOf(near, row);
  for (size_t l = 0; l < PaintRow::kMost; ++l) row.height[l] = height(row, sums, l);
  for (size_t l = 0; l < PaintRow::kMost; ++l) {
    const float cover = smoothStep(0, 0.35F, sums.fat[l]), vessel = 1 - smoothStep(0.7F, 1, sums.best[l]);
    // Fat partly covers the larger vessels, and shows through a thin film elsewhere.
    const float share = cover > 0 ? vessel * (1 - 0.12F * cover) : vessel > 0 ? 1.0F : 0.0F;
    const float fat = (1 - share) * (0.9F + 0.1F * lumps(row, l));
    for (int i = 0; i < 3; ++i) {
      const float of_vessel = kArtery[i] + sums.vein[l] * (kVein[i] - kArtery[i]);
      row.color[static_cast<size_t>(i)][l] = share * of_vessel + fat * kFat[i];
    }
    row.cover[l] = larger(0.82F * cover, 0.85F * vessel);
  }
}

}  // namespace viscera
