// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "export/page/surface_coder.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace viscera {

namespace {

constexpr uint32_t kNoNeighbour = UINT32_MAX;
constexpr uint8_t kNewTriangles = 1, kNewColors = 2;  // bits of a frame's first byte
constexpr uint16_t kLong = 15;                        // half a byte that stands for a number stored in full

Eigen::AlignedBox3d boxOf(const VisibleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const uint32_t v : mesh.topology->triangles) {
    const Vector3d position_m = mesh.position_m(v).cast<double>();
    if (position_m.allFinite()) box.extend(position_m);
  }
  return box;
}

/// Keeps the two largest of different indices. @param kept  larger first; in, out
void addNeighbour(uint32_t index, std::array<uint32_t, 2>& kept) {
  if (kept[0] == kNoNeighbour) {
    kept = {index, index};
  } else if (index > kept[0]) {
    kept = {index, kept[0]};
  } else if (index < kept[0] && (kept[1] == kept[0] || index > kept[1])) {
    kept[1] = index;
  }
}

/// Appends numbers: half a byte each where it is below kLong, and the others in full behind them.
void putNumbers(const std::vector<uint16_t>& numbers, PageBytes& out) {
  std::vector<uint16_t> in_full;
  for (size_t i = 0; i < numbers.size(); i += 2) {
    uint8_t pair = 0;
    for (size_t k = i; k < std::min(i + 2, numbers.size()); ++k) {
      pair = static_cast<uint8_t>(pair | std::min(numbers[k], kLong) << (k == i ? 0 : 4));
      if (numbers[k] >= kLong) in_full.push_back(numbers[k]);
    }
    out.putByte(pair);
  }
  for (const uint16_t number : in_full) out.putByte(static_cast<uint8_t>(number));
  for (const uint16_t number : in_full) out.putByte(static_cast<uint8_t>(number >> 8));
}

int32_t clampedStep(double steps) {
  constexpr double kMost = 1e9;  // keeps differences within 32 bits
  return static_cast<int32_t>(std::lround(std::isfinite(steps) ? std::clamp(steps, -kMost, kMost) : 0));
}

}  // namespace

PageGrid PageGrid::around(const VisibleMesh& mesh) {
  const Eigen::AlignedBox3d box = boxOf(mesh);
  if (box.isEmpty()) return {};
  const double step_m = std::max(box.sizes().maxCoeff(), 1e-6) / kPerEdge;
  return {box.center() - Vector3d::Constant(kSteps / 2 * step_m), step_m};
}

Eigen::Vector3i PageGrid::nearest(const Vector3d& position_m) const {
  const Vector3d steps = (position_m - origin_m) / step_m;
  return {clampedStep(steps.x()), clampedStep(steps.y()), clampedStep(steps.z())};
}

std::vector<SurfaceCoder::Triangle> SurfaceCoder::trianglesOf(const VisibleTopology& topology) {
  std::vector<Triangle> out;
  out.reserve(topology.triangleCount());
  for (const VisiblePatch& patch : topology.patches) {
    for (size_t t = patch.first; t < patch.first + patch.count; ++t)
      out.push_back({topology.triangles[3 * t], topology.triangles[3 * t + 1], topology.triangles[3 * t + 2],
                     static_cast<uint32_t>(patch.kind)});
  }
  return out;
}

/// Appends the difference between the shown triangles and those of a topology. @param shown  in: shown before; out: now
void SurfaceCoder::putTriangles(const VisibleTopology& topology, std::vector<Triangle>& shown, PageBytes& out) const {
  std::vector<Triangle> wanted = trianglesOf(topology), added;
  std::sort(wanted.begin(), wanted.end());
  std::vector<uint32_t> order(shown.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return shown[a] < shown[b]; });
  std::vector<bool> is_removed(shown.size());
  size_t w = 0;
  for (const uint32_t i : order) {
    for (; w < wanted.size() && wanted[w] < shown[i]; ++w) added.push_back(wanted[w]);
    is_removed[i] = w == wanted.size() || wanted[w] != shown[i];
    if (!is_removed[i]) ++w;
  }
  added.insert(added.end(), wanted.begin() + static_cast<std::ptrdiff_t>(w), wanted.end());
  out.putCount(static_cast<uint32_t>(topology.vertices));
  out.putCount(static_cast<uint32_t>(std::count(is_removed.begin(), is_removed.end(), true)));
  std::vector<Triangle> kept;
  uint32_t after = 0;
  for (uint32_t i = 0; i < shown.size(); ++i) {
    if (!is_removed[i]) {
      kept.push_back(shown[i]);
      continue;
    }
    out.putCount(i - after);
    after = i + 1;
  }
  out.putCount(static_cast<uint32_t>(added.size()));
  uint32_t corner = 0;
  for (const Triangle& triangle : added) {
    out.putByte(static_cast<uint8_t>(triangle[3]));
    for (size_t c = 0; c < 3; ++c) {
      out.putSigned(static_cast<int32_t>(triangle[c] - corner));
      corner = triangle[c];
    }
    corner = triangle[0];
  }
  kept.insert(kept.end(), added.begin(), added.end());
  shown = std::move(kept);
}

/// Finds the vertices that are shown, and the neighbour that predicts each.
void SurfaceCoder::connect() {
  const size_t vertices = last_.topology->vertices;
  neighbours_.assign(vertices, {kNoNeighbour, kNoNeighbour});
  is_shown_.assign(vertices, false);
  for (const Triangle& triangle : last_.triangles) {
    for (size_t c = 0; c < 3; ++c) {
      const uint32_t v = triangle[c];
      is_shown_[v] = true;
      for (const uint32_t other : {triangle[(c + 1) % 3], triangle[(c + 2) % 3]}) {
        if (other < v) addNeighbour(other, neighbours_[v]);
      }
    }
  }
}

void SurfaceCoder::putColors(const State& before, const std::vector<uint32_t>& colors, PageBytes& out) const {
  for (int shift = 0; shift < 32; shift += 8) {
    for (size_t v = 0; v < colors.size(); ++v) {
      const uint32_t from = v < before.vertices() ? before.colors[v] : 0;
      out.putByte(static_cast<uint8_t>((colors[v] >> shift) - (from >> shift)));
    }
  }
}

void SurfaceCoder::putPositions(const State& before, const VisibleMesh& mesh, PageBytes& out) {
  const size_t vertices = mesh.vertices(), known = before.vertices();
  std::vector<uint16_t> steps(3 * vertices);
  std::vector<uint16_t> numbers(vertices);
  for (size_t axis = 0; axis < 3; ++axis) {
    uint16_t* const now = steps.data() + axis * vertices;
    const uint16_t* const then = before.steps.data() + axis * known;
    for (size_t v = 0; v < vertices; ++v) {
      int32_t expected = v < known ? then[v] : 0;
      const auto [a, b] = neighbours_[v];
      if (a != kNoNeighbour) expected += (now[a] + now[b] - (v < known ? then[a] + then[b] : 0) + 1) >> 1;
      const double position =
          (static_cast<double>(mesh.positions_m[3 * v + axis]) - grid_.origin_m[static_cast<int>(axis)]) / grid_.step_m;
      now[v] = is_shown_[v] && std::isfinite(position)
                   ? static_cast<uint16_t>(std::lround(std::clamp(position, 0.0, PageGrid::kSteps)))
                   : static_cast<uint16_t>(expected);
      const auto off = static_cast<int16_t>(now[v] - expected);
      numbers[v] = static_cast<uint16_t>(static_cast<uint16_t>(off) << 1 ^ (off < 0 ? 0xffff : 0));
    }
    putNumbers(numbers, out);
  }
  last_.steps = std::move(steps);
}

void SurfaceCoder::begin(const VisibleMesh& mesh, const std::vector<uint32_t>& colors, PageBytes& out) {
  grid_ = PageGrid::around(mesh);
  last_ = {};
  add(mesh, colors, false, out);
  base_ = last_;
}

bool SurfaceCoder::hasRoomFor(const VisibleMesh& mesh) const {
  const Eigen::AlignedBox3d box = boxOf(mesh),
                            room(grid_.origin_m, grid_.origin_m + Vector3d::Constant(PageGrid::kSteps * grid_.step_m));
  return box.isEmpty() || room.contains(box);
}

void SurfaceCoder::add(const VisibleMesh& mesh, const std::vector<uint32_t>& colors, bool is_key, PageBytes& out) {
  has_new_triangles_ = mesh.topology != last_.topology;
  const State before = is_key ? base_ : last_;
  const bool triangles_differ = mesh.topology != before.topology, colors_differ = colors != before.colors;
  out.putByte(static_cast<uint8_t>((triangles_differ ? kNewTriangles : 0) | (colors_differ ? kNewColors : 0)));
  last_.topology = mesh.topology;
  last_.triangles = before.triangles;
  if (triangles_differ) putTriangles(*mesh.topology, last_.triangles, out);
  if (triangles_differ || is_key) connect();
  if (colors_differ) putColors(before, colors, out);
  putPositions(before, mesh, out);
  last_.colors = colors;
}

}  // namespace viscera
