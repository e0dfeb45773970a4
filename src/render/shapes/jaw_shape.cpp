// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/shapes/jaw_shape.h"

#include <cmath>
#include <vector>

#include "render/shapes/lathe.h"

namespace viscera {

namespace {

constexpr int kBackSteps = 8;  // of the round back of a jaw
constexpr float kHalfTurn = static_cast<float>(M_PI), kQuarter = static_cast<float>(M_PI / 2);

/// Cross-section of a jaw: a flat inner side at x = inner, and a round back out to x = outer.
struct Station {
  float z, inner, outer, low_y, high_y;
};

Vector3f backPoint(const Station& at, float angle) {
  return {at.inner + (at.outer - at.inner) * std::cos(angle),
          0.5F * (at.low_y + at.high_y) + 0.5F * (at.high_y - at.low_y) * std::sin(angle), at.z};
}

Vector3f backNormal(const Station& at, float angle) {
  return Vector3f(std::cos(angle) / (at.outer - at.inner), std::sin(angle) / (0.5F * (at.high_y - at.low_y)), 0)
      .normalized();
}

/// Adds a quad with its own vertices, counter-clockwise from the side of the normals.
void addQuad(const std::array<Vector3f, 4>& corners, const std::array<Vector3f, 4>& normals,
             const std::array<uint8_t, 4>& color, ToolShape& shape) {
  const auto first = static_cast<uint32_t>(shape.vertices.size());
  for (size_t i = 0; i < 4; ++i) {
    const Vector3f &p = corners[i], &n = normals[i];
    shape.vertices.push_back({{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}, color});
  }
  const Vector3f side = (corners[2] - corners[0]).cross(corners[3] - corners[1]);
  const bool turned = side.dot(normals[0] + normals[1] + normals[2] + normals[3]) < 0;
  for (const uint32_t i :
       turned ? std::array<uint32_t, 6>{0, 2, 1, 0, 3, 2} : std::array<uint32_t, 6>{0, 1, 2, 0, 2, 3})
    shape.indices.push_back(first + i);
}

/// Adds the skin between cross-sections.
void addLoft(const std::vector<Station>& stations, const std::array<uint8_t, 4>& color, ToolShape& shape) {
  for (size_t s = 0; s + 1 < stations.size(); ++s) {
    const Station &a = stations[s], &b = stations[s + 1];
    for (int i = 0; i < kBackSteps; ++i) {
      const float from = -kQuarter + kHalfTurn * static_cast<float>(i) / kBackSteps, to = from + kHalfTurn / kBackSteps;
      addQuad({backPoint(a, from), backPoint(a, to), backPoint(b, to), backPoint(b, from)},
              {backNormal(a, from), backNormal(a, to), backNormal(b, to), backNormal(b, from)}, color, shape);
    }
    const Vector3f inward = Vector3f(a.z - b.z, 0, b.inner - a.inner).normalized();
    addQuad({Vector3f(a.inner, a.low_y, a.z), Vector3f(a.inner, a.high_y, a.z), Vector3f(b.inner, b.high_y, b.z),
             Vector3f(b.inner, b.low_y, b.z)},
            {inward, inward, inward, inward}, color, shape);
  }
}

float between(float from, float to, float share) {
  return from + share * (to - from);
}

/// Returns the cross-sections of a jaw with teeth from its tip to three quarters of its length.
std::vector<Station> toothed(float length, float unit, int teeth, float half_y) {
  // Shares of the length, and of the unit: teeth of closed jaws mesh.
  constexpr float kToothed = 0.75F, kPoint = 0.02F, kCrest = -0.2F, kValley = 0.1F;
  std::vector<Station> out = {{0, kCrest * unit, 0.3F * unit, -0.3F * unit, 0.3F * unit}};
  const auto at = [&](float share, float inner) {
    const float half = unit * between(0.8F, 1, std::min(8 * share, 1.F)) * half_y;
    out.push_back({share * length, inner, unit * between(1.45F, 2.2F, share), -half, half});
  };
  at(kPoint, kCrest * unit);
  for (int tooth = 0; tooth < teeth; ++tooth) {
    const float from = between(kPoint, kToothed, static_cast<float>(tooth) / static_cast<float>(teeth));
    const float to = between(kPoint, kToothed, static_cast<float>(tooth + 1) / static_cast<float>(teeth));
    at(between(from, to, 0.7F), kValley * unit);
    at(to, kCrest * unit);
  }
  at(0.9F, 0);
  at(1.05F, 0);
  return out;
}

/// Returns the cross-sections of a blade of scissors, next to the plane in which the other one moves.
std::vector<Station> sheared(float length, float unit) {
  constexpr float kThick = 0.8F, kOverlap = -0.15F;
  std::vector<Station> out;
  for (const auto& [share, outer] : {std::pair(0.F, 0.2F), {0.04F, 0.6F}, {0.3F, 1.2F}, {0.7F, 1.9F}, {1.05F, 2.1F}})
    out.push_back({share * length, share * kOverlap * unit, outer * unit, 0.02F * unit, kThick * unit});
  return out;
}

}  // namespace

void addJaw(const ToolKind& kind, float length_m, float unit_m, const std::array<uint8_t, 4>& color, ToolShape& shape) {
  constexpr int kTeeth = 9, kFineTeeth = 16;
  constexpr float kUsual = 1.5F, kBroad = 2.2F;  // half widths along y, in units
  if (kind.closes) return addLoft(sheared(length_m, unit_m), color, shape);
  if (kind.clips) return addLoft(toothed(length_m, 0.8F * unit_m, 1, kBroad), color, shape);
  addLoft(toothed(length_m, unit_m, kind.does(kHolds) ? kTeeth : kFineTeeth, kUsual), color, shape);
}

void addFork(float pivot_m, float unit_m, const std::array<uint8_t, 4>& color, ToolShape& shape) {
  constexpr float kPlate = 2.2F, kPlateY = 2.1F, kFlat = 0.25F, kPin = 0.7F, kPinEnd = 2.9F;  // in units
  const float radius = kPlate * unit_m, end = kPinEnd * unit_m;
  const Profile plate =
      Profile().arc(radius, pivot_m, -kQuarter, 0).line(radius, pivot_m, radius, pivot_m + 4 * radius);
  for (const float side : {-1.F, 1.F}) {
    const Eigen::Affine3f placement =
        Eigen::Translation3f(0, side * kPlateY * unit_m, 0) * Eigen::Affine3f(Eigen::Scaling(1.0F, kFlat, 1.0F));
    addLathe(plate, placement, color, shape);
  }
  const Profile pin = Profile()
                          .line(0, -end, kPin * unit_m, -end + 0.1F * unit_m)
                          .line(kPin * unit_m, -end + 0.1F * unit_m, kPin * unit_m, end - 0.1F * unit_m)
                          .line(kPin * unit_m, end - 0.1F * unit_m, 0, end);
  addLathe(pin, Eigen::Translation3f(0, 0, pivot_m) * Eigen::AngleAxisf(kQuarter, Vector3f::UnitX()), color, shape);
}

}  // namespace viscera
