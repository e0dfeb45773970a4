// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/visible_triangles.h"

#include <algorithm>
#include <utility>

#include "viscera/layout/skin.h"

namespace viscera {

void appendShown(const uint32_t* corners, const uint32_t* splits, uint32_t alive, std::vector<uint32_t>& out) {
  if (alive == layout::kShownWhole) out.insert(out.end(), corners, corners + 3);
  if (alive <= layout::kShownWhole) return;
  for (uint32_t i = 0; i < 3; ++i) {
    const uint32_t j = (i + 1) % 3, k = (i + 2) % 3;
    const uint32_t behind_j = splits[2 * i + 1], behind_k = splits[2 * k];
    if (alive & (layout::kShownCorner << i)) {
      out.insert(out.end(), {corners[i], splits[2 * i], splits[2 * k + 1]});
    }
    if (alive & (layout::kShownRest << i)) {
      out.insert(out.end(), {behind_j, corners[j], corners[k], behind_j, corners[k], behind_k});
    }
  }
}

VisibleTriangles::VisibleTriangles(const Model& model, size_t vertices, std::vector<uint32_t> indices,
                                   std::vector<uint32_t> splits)
    : indices_(std::move(indices)), splits_(std::move(splits)), alive_(indices_.size() / 3, layout::kShownWhole) {
  auto whole = std::make_shared<VisibleTopology>();
  whole->revision = 1;
  whole->vertices = vertices;
  whole->triangles = indices_;
  size_t first = 0;
  for (const Body& body : model.bodies) {
    const size_t count = body.skin.mesh.triangles.size();
    whole->patches.push_back({static_cast<uint32_t>(whole->bodies.size()), SurfaceKind::kSkin, first, count});
    whole->bodies.push_back({body.name, body.color});
    body_triangles_.push_back(count);
    first += count;
  }
  whole_ = shown_ = std::move(whole);
}

void VisibleTriangles::appendBody(size_t body, size_t first_triangle, const VisibleWounds* wounds,
                                  VisibleTopology& out) const {
  const size_t first = out.triangleCount();
  const auto patch = [&](SurfaceKind kind, size_t from) {
    out.patches.push_back({static_cast<uint32_t>(body), kind, from, out.triangleCount() - from});
  };
  if (wounds && wounds->bodies[body].wounded) {
    const VisibleWounds::OfBody& wounded = wounds->bodies[body];
    out.triangles.insert(out.triangles.end(), wounded.skin.begin(), wounded.skin.end());
    patch(SurfaceKind::kSkin, first);
    const size_t walls = out.triangleCount();
    out.triangles.insert(out.triangles.end(), wounded.walls.begin(), wounded.walls.end());
    if (!wounded.walls.empty()) patch(SurfaceKind::kWound, walls);
    return;
  }
  for (size_t triangle = first_triangle; triangle < first_triangle + body_triangles_[body]; ++triangle) {
    const uint32_t* const splits = splits_.empty() ? nullptr : &splits_[6 * triangle];
    appendShown(&indices_[3 * triangle], splits, alive_[triangle], out.triangles);
  }
  patch(SurfaceKind::kSkin, first);
}

const std::shared_ptr<const VisibleTopology>& VisibleTriangles::shown(const uint32_t* alive,
                                                                      const VisibleWounds* wounds) {
  const uint64_t wounds_revision = wounds ? wounds->revision : 0;
  if (wounds_revision == wounds_revision_ && std::equal(alive_.begin(), alive_.end(), alive)) return shown_;
  wounds_revision_ = wounds_revision;
  std::copy_n(alive, alive_.size(), alive_.begin());
  const auto is_whole = [](uint32_t code) { return code == layout::kShownWhole; };
  const auto is_wounded = [](const VisibleWounds::OfBody& body) { return body.wounded; };
  if (std::all_of(alive_.begin(), alive_.end(), is_whole) &&
      !(wounds && std::any_of(wounds->bodies.begin(), wounds->bodies.end(), is_wounded))) {
    return shown_ = whole_;
  }
  auto next = std::make_shared<VisibleTopology>();
  next->revision = ++revisions_;
  next->vertices = wounds ? wounds->vertices : whole_->vertices;
  next->bodies = whole_->bodies;
  size_t triangle = 0;
  for (size_t b = 0; b < body_triangles_.size(); ++b) {
    appendBody(b, triangle, wounds, *next);
    triangle += body_triangles_[b];
  }
  return shown_ = std::move(next);
}

}  // namespace viscera
