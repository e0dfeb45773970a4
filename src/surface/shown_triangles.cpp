// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/shown_triangles.h"

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

ShownTriangles::ShownTriangles(const Model& model, size_t vertices, std::vector<uint32_t> indices,
                               std::vector<uint32_t> splits)
    : indices_(std::move(indices)), splits_(std::move(splits)), alive_(indices_.size() / 3, layout::kShownWhole) {
  auto whole = std::make_shared<ShownTopology>();
  whole->revision = 1;
  whole->vertices = vertices;
  whole->triangles = indices_;
  size_t first = 0;
  for (const Body& body : model.bodies) {
    const size_t count = body.skin.mesh.triangles.size();
    whole->patches.push_back({static_cast<uint32_t>(whole->bodies.size()), ShownKind::kSkin, first, count});
    whole->bodies.push_back({body.name, body.color});
    body_triangles_.push_back(count);
    first += count;
  }
  whole_ = shown_ = std::move(whole);
}

const std::shared_ptr<const ShownTopology>& ShownTriangles::shown(const uint32_t* alive) {
  if (std::equal(alive_.begin(), alive_.end(), alive)) return shown_;
  std::copy_n(alive, alive_.size(), alive_.begin());
  const auto is_whole = [](uint32_t code) { return code == layout::kShownWhole; };
  if (std::all_of(alive_.begin(), alive_.end(), is_whole)) return shown_ = whole_;
  auto next = std::make_shared<ShownTopology>();
  next->revision = ++revisions_;
  next->vertices = whole_->vertices;
  next->bodies = whole_->bodies;
  size_t triangle = 0;
  for (size_t b = 0; b < body_triangles_.size(); ++b) {
    const size_t first = next->triangleCount();
    for (const size_t end = triangle + body_triangles_[b]; triangle < end; ++triangle) {
      const uint32_t* const splits = splits_.empty() ? nullptr : &splits_[6 * triangle];
      appendShown(&indices_[3 * triangle], splits, alive_[triangle], next->triangles);
    }
    next->patches.push_back({static_cast<uint32_t>(b), ShownKind::kSkin, first, next->triangleCount() - first});
  }
  return shown_ = std::move(next);
}

}  // namespace viscera
