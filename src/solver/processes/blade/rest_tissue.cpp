// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/blade/rest_tissue.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "math/archive.h"
#include "viscera/model/body/elasticity.h"

namespace viscera {

namespace {

constexpr double kPartedStep = 0.25;  // of the spacing: distance of the recorded points of a cut surface
constexpr int kAround = 3;  // grid positions around structures other than lattices: edges extend beyond sheets

RestGrid gridOf(const Body& body) {
  const Lattice& lattice = body.lattice;
  if (body.hasCells()) return {lattice.spacing_m, lattice.origin_m, lattice.nodes_per_axis};
  Eigen::AlignedBox3d box;
  for (const uint32_t slot : lattice.active_slots) box.extend(body.network->positions_m[slot]);
  const double h = body.network->meanLength();
  const Vector3d around = Vector3d::Constant(kAround * h);
  const Vector3i count = ((box.sizes() + 2 * around) / h).array().ceil().cast<int>() + 1;
  return {h, box.min() - around, count};
}

}  // namespace

RestTissue::RestTissue(const Model& model, size_t body)
    : grid_(gridOf(model.bodies[body])), fill_(model.bodies[body], grid_), toughness_(model.bodies[body], grid_) {
  const Body& of = model.bodies[body];
  parted_.assign(8 * grid_.positions(), 0);
  nodes_.reserve(of.lattice.active_slots.size());
  if (of.hasCells()) {
    const Strengths strong = strengths(of);
    const double cell_kg = of.material.density_kg_per_m3 * grid_.spacing_m * grid_.spacing_m * grid_.spacing_m;
    for (const uint32_t slot : of.lattice.active_slots)
      addNode(model, body, slot, static_cast<double>(strong.mass_kg[slot]), cell_kg);
  } else {
    double all_kg = 0;
    for (const double mass_kg : of.network->masses_kg) all_kg += mass_kg;
    const double mean_kg = all_kg / static_cast<double>(of.lattice.active_slots.size());
    for (const uint32_t slot : of.lattice.active_slots)
      addNode(model, body, slot, of.network->masses_kg[slot], mean_kg);
  }
  sortIntoGrid();
}

/// @param whole_kg  mass of a node inside the tissue
void RestTissue::addNode(const Model& model, size_t body, uint32_t slot, double mass_kg, double whole_kg) {
  const Body& of = model.bodies[body];
  if (!(mass_kg > 0)) return;
  const auto mass = static_cast<float>(mass_kg);
  const bool fixed = (of.lattice.nodes[slot].lo & layout::kFixedBit) != 0;
  nodes_.push_back({model.slotOffset(body) + slot, mass, fixed ? 0 : 1 / mass,
                    static_cast<float>(static_cast<double>(mass) / whole_kg), restPosition(of, slot)});
}

void RestTissue::sortIntoGrid() {
  starts_.assign(grid_.positions() + 1, 0);
  const auto position = [this](const Node& node) { return grid_.at(grid_.nearest(node.rest_m)); };
  for (const Node& node : nodes_) ++starts_[position(node) + 1];
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  std::vector<uint32_t> next(starts_.begin(), starts_.end() - 1);
  sorted_.resize(nodes_.size());
  for (size_t n = 0; n < nodes_.size(); ++n) sorted_[next[position(nodes_[n])]++] = static_cast<uint32_t>(n);
}

Vector3i RestTissue::halfCell(const Vector3d& at_m) const {
  const Vector3d half = 2 / grid_.spacing_m * (at_m - grid_.origin_m);
  return {static_cast<int>(std::floor(half.x())), static_cast<int>(std::floor(half.y())),
          static_cast<int>(std::floor(half.z()))};
}

/// Returns an index beyond the end outside the grid.
size_t RestTissue::halfAt(const Vector3i& half) const {
  if ((half.array() < 0).any() || (half.array() >= 2 * grid_.count.array()).any()) return parted_.size();
  const size_t corner = grid_.at({half.x() / 2, half.y() / 2, half.z() / 2});
  return 8 * corner + static_cast<size_t>((half.x() & 1) + 2 * (half.y() & 1) + 4 * (half.z() & 1));
}

void RestTissue::part(const Vector3d& p, const Vector3d& q, const Vector3d& r, const Vector3d& s) {
  const double step = kPartedStep * grid_.spacing_m;
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
