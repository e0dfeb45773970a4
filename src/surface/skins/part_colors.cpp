// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/skins/part_colors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "viscera/surface/visible_mesh.h"

namespace viscera {

namespace {

// Multiples of the plastic number's powers fill the square without clusters.
constexpr double kShadeStep = 0.7548776662466927;
constexpr double kTintStep = 0.5698402909980532;
constexpr double kShadeRange = 0.16;  // lightness of parts differs by at most +-16 %
constexpr double kTintRange = 0.10;   // red against blue by at most +-10 %
constexpr uint16_t kNoPart = UINT16_MAX;

/// Returns the part's place in a sequence that fills -1..1 evenly; part 0 is at 0.
double spread(double step, size_t part) {
  const double turns = step * static_cast<double>(part) + 0.5;
  return 2 * (turns - std::floor(turns)) - 1;
}

uint32_t rgba8(const Vector3d& color, uint32_t alpha) {
  uint32_t packed = alpha << 24;
  for (int c = 0; c < 3; ++c) {
    packed |= static_cast<uint32_t>(std::lround(255 * std::clamp(color[c], 0.0, 1.0))) << (8 * c);
  }
  return packed;
}

}  // namespace

Vector3d partColor(const Vector3d& organ_color, size_t part) {
  const double shade = 1 + kShadeRange * spread(kShadeStep, part);
  const double tint = kTintRange * spread(kTintStep, part);
  const Vector3d color = shade * organ_color.cwiseProduct(Vector3d(1 + tint, 1, 1 - tint));
  return color.cwiseMax(0.0).cwiseMin(1.0);
}

namespace {

double srgb(float linear) {
  return linear <= 0.0031308F ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

/// Returns the material that the mesh's file gives a part, or null.
const SurfaceMaterial* materialOf(const SurfaceDetail* detail, size_t part) {
  if (detail == nullptr || part >= detail->part_materials.size()) return nullptr;
  const uint32_t material = detail->part_materials[part];
  if (material == kNoChart || !detail->materials[material].has_color) return nullptr;
  return &detail->materials[material];
}

/// Returns whether no other part has the part's material.
bool isOfOnePart(const SurfaceDetail& detail, size_t part) {
  const std::vector<uint32_t>& materials = detail.part_materials;
  return std::count(materials.begin(), materials.end(), materials[part]) == 1;
}

Vector3d srgbOf(const SurfaceMaterial& material) {
  return {srgb(material.color[0]), srgb(material.color[1]), srgb(material.color[2])};
}

/// Returns the colours of all parts. Parts of one material differ by partColor(), to keep them distinct.
std::vector<Vector3d> partColors(const TriangleMesh& mesh, const Vector3d& organ_color) {
  std::vector<Vector3d> out;
  for (size_t part = 0; part < std::max<size_t>(mesh.part_names.size(), 1); ++part) {
    const SurfaceMaterial* const own = materialOf(mesh.detail.get(), part);
    const Vector3d color = own ? srgbOf(*own) : organ_color;
    const bool alone = own != nullptr && (own->hasTexture() || isOfOnePart(*mesh.detail, part));
    out.push_back(alone ? color : partColor(color, part));
  }
  return out;
}

}  // namespace

std::vector<uint32_t> vertexColors(const TriangleMesh& mesh, const Vector3d& organ_color, bool two_sided,
                                   uint32_t body) {
  std::vector<uint16_t> parts(mesh.positions_m.size(), kNoPart);
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (uint32_t v : mesh.triangles[t]) parts[v] = std::min(parts[v], mesh.parts[t]);
  }
  const std::vector<Vector3d> of_part = partColors(mesh, organ_color);
  std::vector<uint32_t> colors;
  colors.reserve(parts.size());
  for (uint16_t part : parts) colors.push_back(rgba8(of_part[part == kNoPart ? 0 : part], skinAlpha(body, two_sided)));
  return colors;
}

std::vector<Vector3d> insideColors(const Body& body) {
  const TriangleMesh& mesh = body.skin.mesh;
  const std::vector<std::string>& names = body.lattice.part_names;
  std::vector<Vector3d> out(1 + names.size(), woundColor(body.color));
  for (size_t part = 0; part < mesh.part_names.size(); ++part) {
    const SurfaceMaterial* const own = materialOf(mesh.detail.get(), part);
    if (own == nullptr || own->hasTexture()) continue;
    for (size_t label = 1; label < out.size(); ++label)
      if (names[label - 1] == mesh.part_names[part]) out[label] = woundColor(srgbOf(*own));
  }
  return out;
}

bool hasPartColors(const Body& body) {
  const std::vector<Vector3d> inside = insideColors(body);
  return std::any_of(inside.begin(), inside.end(), [&](const Vector3d& color) { return color != inside[0]; });
}

namespace {

/// Returns a colour moved by t towards another, channel by channel; alpha stays.
uint32_t towards(uint32_t rgba, const std::array<float, 3>& rgb, float t) {
  uint32_t out = rgba & 0xff000000U;
  for (size_t c = 0; c < 3; ++c) {
    const auto from = static_cast<float>(rgba >> (8 * c) & 255);
    out |= static_cast<uint32_t>(std::lround(from + t * (rgb[c] - from))) << (8 * c);
  }
  return out;
}

uint32_t burntColor(uint32_t rgba, float share) {
  // sRGB, by share; chosen by eye: pale like boiled liver, brown, black.
  struct Stop {
    float share;
    std::array<float, 3> rgb;
  };
  constexpr std::array<Stop, 3> kStops = {{{1, {205, 178, 150}}, {1.5F, {104, 66, 38}}, {2, {26, 21, 19}}}};
  if (share <= 0) return rgba;
  uint32_t from = rgba;
  float from_share = 0;
  size_t to = 0;
  for (; to + 1 < kStops.size() && share > kStops[to].share; ++to) {
    from = towards(rgba, kStops[to].rgb, 1);
    from_share = kStops[to].share;
  }
  return towards(from, kStops[to].rgb, std::min(1.0F, (share - from_share) / (kStops[to].share - from_share)));
}

constexpr std::array<float, 3> kBlood = {112, 6, 12};  // sRGB, by eye: between that of arteries and that of veins
constexpr std::array<float, 3> kBile = {126, 124, 8};  // sRGB, by eye: dark yellow-green

uint32_t wetColor(uint32_t rgba, const std::array<float, 3>& fluid, float share) {
  return share <= 0 ? rgba : towards(rgba, fluid, std::min(1.0F, share));
}

}  // namespace

uint32_t paintedColor(PaintKind kind, uint32_t rgba, float share) {
  if (kind == PaintKind::kBurn) return burntColor(rgba, share);
  return wetColor(rgba, kind == PaintKind::kBlood ? kBlood : kBile, share);
}

}  // namespace viscera
