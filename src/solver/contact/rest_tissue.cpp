// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/contact/rest_tissue.h"

#include <algorithm>
#include <cmath>

#include "math/archive.h"
#include "viscera/model/body/elasticity.h"

namespace viscera {

namespace {

constexpr double kFillSide = 0.5;     // of the spacing: of the cube within which tissue begins smoothly
constexpr double kPartedStep = 0.25;  // of the spacing: places of a parted surface that are noted

/// The part of a cube of side kFillSide around x that is above 0, in cells.
double above(double x) {
  return std::clamp(0.5 + x / kFillSide, 0.0, 1.0);
}

}  // namespace

RestTissue::RestTissue(const Model& model, size_t body) {
  const Lattice& lattice = model.bodies[body].lattice;
  spacing_m_ = lattice.spacing_m;
  origin_m_ = lattice.origin_m;
  count_ = lattice.nodes_per_axis;
  const size_t places =
      static_cast<size_t>(count_.x()) * static_cast<size_t>(count_.y()) * static_cast<size_t>(count_.z());
  grid_.assign(places, kNone);
  shares_.assign(places, 0);
  parted_.assign(8 * places, 0);
  const Strengths strong = strengths(model.bodies[body]);
  const MaterialConfig& material = model.bodies[body].material;
  const double cell_kg = material.density_kg_per_m3 * spacing_m_ * spacing_m_ * spacing_m_;
  const uint32_t offset = model.slotOffset(body);
  nodes_.reserve(lattice.active_slots.size());
  for (const uint32_t slot : lattice.active_slots) {
    const float mass_kg = strong.mass_kg[slot];
    const bool fixed = (lattice.nodes[slot].lo & layout::kFixedBit) != 0;
    const size_t place = at(lattice.nodeAt(slot));
    if (lattice.nodes[slot].lo & layout::kCellBit) shares_[place] = static_cast<float>(fillOf(lattice, slot).share);
    if (!(mass_kg > 0)) continue;
    grid_[place] = static_cast<uint32_t>(nodes_.size());
    nodes_.push_back({offset + slot, mass_kg, fixed ? 0 : 1 / mass_kg, static_cast<float>(mass_kg / cell_kg),
                      lattice.restPosition(slot)});
  }
}

double RestTissue::fill(const Vector3d& at_m) const {
  const Vector3d middle = (at_m - origin_m_) / spacing_m_;
  const Vector3i face(static_cast<int>(std::lround(middle.x())), static_cast<int>(std::lround(middle.y())),
                      static_cast<int>(std::lround(middle.z())));
  const Vector3d beyond = middle - face.cast<double>();
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    const Vector3i side(c & 1, c >> 1 & 1, c >> 2 & 1), cell = face + side - Vector3i::Ones();
    if ((cell.array() < 0).any() || (cell.array() >= count_.array()).any()) continue;
    double part = shares_[at(cell)];
    for (int a = 0; a < 3; ++a) part *= side[a] ? above(beyond[a]) : 1 - above(beyond[a]);
    sum += part;
  }
  return std::min(sum, 1.0);
}

Vector3i RestTissue::halfCell(const Vector3d& at_m) const {
  const Vector3d half = 2 / spacing_m_ * (at_m - origin_m_);
  return {static_cast<int>(std::floor(half.x())), static_cast<int>(std::floor(half.y())),
          static_cast<int>(std::floor(half.z()))};
}

/// Beyond the end where there is none.
size_t RestTissue::halfAt(const Vector3i& half) const {
  if ((half.array() < 0).any() || (half.array() >= 2 * count_.array()).any()) return parted_.size();
  const size_t corner = at({half.x() / 2, half.y() / 2, half.z() / 2});
  return 8 * corner + static_cast<size_t>((half.x() & 1) + 2 * (half.y() & 1) + 4 * (half.z() & 1));
}

void RestTissue::part(const Vector3d& p, const Vector3d& q, const Vector3d& r, const Vector3d& s) {
  const double step = kPartedStep * spacing_m_;
  const double along = std::max((q - p).norm(), (r - s).norm()), across = std::max((s - p).norm(), (r - q).norm());
  const int n = 1 + static_cast<int>(along / step), m = 1 + static_cast<int>(across / step);
  for (int i = 0; i <= n; ++i) {
    const double t = static_cast<double>(i) / n;
    const Vector3d from = p + t * (q - p), to = s + t * (r - s);
    for (int j = 0; j <= m; ++j) {
      const size_t at = halfAt(halfCell(from + static_cast<double>(j) / m * (to - from)));
      if (at < parted_.size()) parted_[at] = 1;
    }
  }
}

bool RestTissue::isParted(const Vector3d& at_m) const {
  const size_t at = halfAt(halfCell(at_m));
  return at < parted_.size() && parted_[at] != 0;
}

void RestTissue::reset() {
  std::fill(parted_.begin(), parted_.end(), uint8_t{0});
}

void RestTissue::persist(Archive& archive) {
  archive.values(parted_);
}

}  // namespace viscera
