// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/drawn_skin.h"

#include <algorithm>
#include <unordered_map>

namespace viscera {

namespace {

bool isClosed(const TriangleMesh& mesh) {
  std::unordered_map<uint64_t, int> balance;  // of an edge: how often it is run through one way more than the other
  double volume = 0;
  for (const auto& triangle : mesh.triangles) {
    for (size_t i = 0; i < 3; ++i) {
      const uint64_t a = triangle[i], b = triangle[(i + 1) % 3];
      balance[std::min(a, b) << 32U | std::max(a, b)] += a < b ? 1 : -1;
    }
    const auto corner = [&](size_t i) { return mesh.positions_m[triangle[i]].cast<double>(); };
    volume += Vector3d(corner(0)).dot(Vector3d(corner(1)).cross(Vector3d(corner(2))));
  }
  return volume > 0 && std::all_of(balance.begin(), balance.end(), [](const auto& edge) { return edge.second == 0; });
}

}  // namespace

std::vector<uint8_t> closedBodies(const Model& model) {
  std::vector<uint8_t> out;
  for (const Body& body : model.bodies)
    out.push_back(!body.skin.two_sided && body.skin.split_edges.empty() && isClosed(body.skin.mesh));
  return out;
}

void DrawnSkin::choose(const Surface& surface, const std::vector<uint8_t>& shown,
                       const std::vector<uint8_t>& fronts_only) {
  if (chosen_ && live_revision_ == surface.liveRevision() && shown == shown_ && fronts_only == fronts_only_) return;
  chosen_ = true;
  live_revision_ = surface.liveRevision();
  shown_ = shown;
  fronts_only_ = fronts_only;
  parts_.clear();
  indices_.clear();
  charts_.clear();
  if (surface.groups().areAll(shown)) {
    addAll(surface);
  } else {
    addSeen(surface);
  }
}

/// Triangles where the surface has them.
void DrawnSkin::addLive(const Surface& surface, size_t first, size_t count, bool fronts_only) {
  const uint32_t indices = surface.liveIndices().id();
  DrawnPart* const last = parts_.empty() ? nullptr : &parts_.back();
  if (last && last->indices == indices && last->first + last->count == first && last->fronts_only == fronts_only) {
    last->count += count;
  } else if (count > 0) {
    parts_.push_back({indices, surface.liveChartsView(), first, count, fronts_only});
  }
}

void DrawnSkin::addAll(const Surface& surface) {
  size_t first = 0;
  for (size_t b = 0; b < fronts_only_.size(); ++b) {
    const size_t count = 3 * surface.skin().trianglesOf(b);
    addLive(surface, first, count, fronts_only_[b]);
    first += count;
  }
  addLive(surface, first, surface.liveCount() - first, false);
}

/// Appends a triangle of our own list.
void DrawnSkin::addListed(const uint32_t* corners, uint32_t chart, bool fronts_only) {
  DrawnPart* last = parts_.empty() ? nullptr : &parts_.back();
  if (!last || last->indices != 0 || last->fronts_only != fronts_only) {
    parts_.push_back({0, 0, indices_.size(), 0, fronts_only});
    last = &parts_.back();
  }
  last->count += 3;
  indices_.insert(indices_.end(), corners, corners + 3);
  charts_.push_back(chart);
}

void DrawnSkin::addSeen(const Surface& surface) {
  const SkinGroups& groups = surface.groups();
  const std::vector<uint8_t> bodies = groups.bodiesOf(shown_);
  size_t first = 0;
  for (size_t b = 0; b < bodies.size(); ++b) {
    const size_t count = surface.skin().trianglesOf(b);
    if (bodies[b] && groups.isSplit(b)) {
      addLive(surface, 3 * first, 3 * count, false);
    } else if (bodies[b]) {
      addBody(surface, b, first);
    }
    first += count;
  }
  size_t split = 3 * first;
  for (size_t b = 0; b < bodies.size(); ++b) {
    if (!groups.isSplit(b)) continue;
    const size_t count = 2 * 3 * surface.skin().trianglesOf(b);
    if (bodies[b]) addLive(surface, split, count, false);
    split += count;
  }
  addBeyond(surface, bodies);
  send(surface);
}

/// Its triangles that lie in the place of the whole ones.
void DrawnSkin::addBody(const Surface& surface, size_t body, size_t first_triangle) {
  const size_t count = surface.skin().trianglesOf(body);
  const std::vector<uint32_t>& charts = surface.charts();
  const auto chartOf = [&](size_t t) { return charts.empty() ? kNoChart : charts[first_triangle + t]; };
  const auto wounds = surface.wounds();
  if (wounds && wounds->bodies[body].wounded) {
    const ShownWounds::OfBody& wounded = wounds->bodies[body];
    for (size_t t = 0; t < std::min(count, wounded.skin.size() / 3); ++t)
      addListed(&wounded.skin[3 * t], chartOf(wounded.skin_sources[t]), false);
    return;
  }
  const uint32_t* const indices = &surface.skin().indices()[3 * first_triangle];
  for (size_t t = 0; t < count; ++t) {
    if (shown_[surface.groups().groupOfVertex(indices[3 * t])])
      addListed(indices + 3 * t, chartOf(t), fronts_only_[body]);
  }
}

/// What wounds have beyond the places of whole triangles.
void DrawnSkin::addBeyond(const Surface& surface, const std::vector<uint8_t>& bodies) {
  const auto wounds = surface.wounds();
  size_t first = 0;
  for (size_t b = 0; b < bodies.size(); ++b) {
    const size_t count = surface.skin().trianglesOf(b);
    if (wounds && bodies[b] && wounds->bodies[b].wounded) {
      const ShownWounds::OfBody& body = wounds->bodies[b];
      for (size_t t = count; t < body.skin.size() / 3; ++t) {
        const uint32_t chart = surface.charts().empty() ? kNoChart : surface.charts()[first + body.skin_sources[t]];
        addListed(&body.skin[3 * t], chart, false);
      }
      for (size_t i = 0; i < body.walls.size(); i += 3) addListed(&body.walls[i], kNoChart, false);
    }
    first += count;
  }
}

/// Brings our own list to the GPU.
void DrawnSkin::send(const Surface& surface) {
  if (indices_.empty()) return;
  const auto roomFor = [](size_t needed) { return needed + needed / 2; };
  const bool charts = surface.liveChartsView() != 0;
  if (indices_.size() > index_buffer_.size()) {
    index_buffer_ = gpu::Buffer<uint32_t>(roomFor(indices_.size()), "drawn triangles");
    if (charts) {
      chart_buffer_ = gpu::Buffer<uint32_t>(roomFor(indices_.size()) / 3, "drawn charts");
      charts_view_ = gpu::TexelView(chart_buffer_.raw(), gpu::TexelFormat::kR32ui);
    }
  }
  index_buffer_.write(indices_);
  if (charts) chart_buffer_.write(charts_);
  for (DrawnPart& part : parts_) {
    if (part.indices != 0) continue;
    part.indices = index_buffer_.id();
    part.charts = charts_view_.id();
  }
}

}  // namespace viscera
