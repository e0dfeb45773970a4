// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <tuple>
#include <unordered_map>

#include "model/shape/solid/solid_volumes.h"
#include "model/shape/solid/triangle_samples.h"

namespace viscera {
namespace {

/// Assignment of one volume's cells to its parts.
class NearestPart {
 public:
  NearestPart(const Volume& volume, Solid& solid) : volume_(volume), solid_(solid) {}

  void apply() {
    for (size_t t = 0; t < volume_.triangle_parts.size(); ++t) markAlong(t);
    std::vector<size_t> front;
    front.reserve(marks_.size());
    for (const auto& [cell, mark] : marks_) front.push_back(cell);
    std::sort(front.begin(), front.end());
    flood(front);
    for (PartFill& fill : solid_.shared) {
      const auto found = marks_.find(fill.cell);
      if (fill.label == volume_.part + 1 && found != marks_.end()) fill.label = found->second.part + 1;
    }
    for (const auto& [cell, mark] : marks_) {
      uint16_t& label = solid_.labels[cell];
      if (label == volume_.part + 1) label = mark.part + 1;
    }
  }

 private:
  struct Mark {
    uint16_t part;
    double distance;  ///< distance in cells from the cell's centre to the nearest point of a triangle
  };

  void markAlong(size_t triangle) {
    std::array<Vector3d, 3> p;
    for (int c = 0; c < 3; ++c) {
      const uint32_t vertex = volume_.shell.triangles[triangle][c];
      p[c] = (volume_.shell.positions_m[vertex] - solid_.origin_m) / solid_.spacing_m;
    }
    forEachSample(p, [&](const Vector3d& point) { mark(point, volume_.triangle_parts[triangle]); });
  }

  void mark(const Vector3d& point, uint16_t part) {
    const Vector3i cell = point.array().floor().cast<int>();
    if (solid_.label(cell.x(), cell.y(), cell.z()) == 0) return;
    const double distance = (point - cell.cast<double>() - Vector3d::Constant(0.5)).norm();
    const auto [known, is_new] = marks_.try_emplace(solid_.index(cell.x(), cell.y(), cell.z()), Mark{part, distance});
    if (!is_new && distance < known->second.distance) known->second = {part, distance};
  }

  void flood(std::vector<size_t>& front) {
    const std::array<size_t, 3> strides = {1, static_cast<size_t>(solid_.cells.x()),
                                           static_cast<size_t>(solid_.cells.x()) * solid_.cells.y()};
    for (size_t next = 0; next < front.size(); ++next) {
      const size_t from = front[next];
      const Mark mark = marks_.at(from);
      for (int axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<int>(from / strides[axis] % solid_.cells[axis]);
        if (at > 0) reach(from - strides[axis], mark, front);
        if (at + 1 < solid_.cells[axis]) reach(from + strides[axis], mark, front);
      }
    }
  }

  void reach(size_t cell, const Mark& mark, std::vector<size_t>& front) {
    if (solid_.labels[cell] != volume_.part + 1) return;
    if (marks_.try_emplace(cell, mark).second) front.push_back(cell);
  }

  const Volume& volume_;
  Solid& solid_;
  std::unordered_map<size_t, Mark> marks_;
};

}  // namespace

void nameJoinedParts(const std::vector<Volume>& volumes, Solid& solid) {
  bool any = false;
  for (const Volume& volume : volumes) {
    if (volume.triangle_parts.empty()) continue;
    NearestPart(volume, solid).apply();
    any = true;
  }
  if (!any) return;
  std::sort(solid.shared.begin(), solid.shared.end(),
            [](const PartFill& a, const PartFill& b) { return std::tie(a.cell, a.label) < std::tie(b.cell, b.label); });
}

}  // namespace viscera
