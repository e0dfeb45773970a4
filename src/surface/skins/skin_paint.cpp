// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/skins/skin_paint.h"

#include <algorithm>
#include <optional>

#include "surface/skins/joined_skins.h"
#include "surface/skins/part_colors.h"
#include "surface/skins/smooth_shares.h"

namespace viscera {

namespace {

constexpr float kBelowLayers_m = 0.02F;  // deeper than the layers of tissue (skin, fat and so on) in scenes

/// One paint of all bodies.
class Paint {
 public:
  Paint(const Model& model, const NodePaint& paint) : paint_(paint) {
    for (size_t b = 0; b < model.bodies.size(); ++b) {
      const Body& body = model.bodies[b];
      bodies_.emplace_back();
      if (!isOneToOne(body)) bodies_.back().emplace(body.lattice, paint.shares.data() + model.slotOffset(b));
    }
  }
  float at(uint32_t body, const layout::vec4& rest, const layout::SkinBinding& binding) const {
    if (bodies_[body]) return bodies_[body]->at({rest.x, rest.y, rest.z});
    return paint_.shares[binding.slot0];
  }
  PaintKind kind() const { return paint_.kind; }

 private:
  const NodePaint& paint_;
  std::vector<std::optional<SmoothShares>> bodies_;  ///< [bodies] of lattices
};

}  // namespace

void paintSkin(const Model& model, const std::vector<std::shared_ptr<const NodePaint>>& paints,
               const std::vector<layout::SkinBinding>& bindings, SkinPaint& skin) {
  std::vector<Paint> all;
  for (const std::shared_ptr<const NodePaint>& paint : paints) all.emplace_back(model, *paint);
  for (size_t v = 0; v < skin.colors.size(); ++v) {
    float most = 0;
    const uint32_t body = bodyOfAlpha(skin.colors[v] >> 24);
    layout::vec4& rest = skin.rests[v];
    const bool is_wall = isWallAlpha(skin.colors[v] >> 24);
    for (const Paint& paint : all) {
      const float share = paint.at(body, rest, bindings[v]);
      if (share <= 0) continue;
      skin.colors[v] = paintedColor(paint.kind(), skin.colors[v], share);
      most = std::max(most, share);
      if (!is_wall && paint.kind() == PaintKind::kBurn) rest.w = -share;
    }
    if (is_wall && rest.w > 0) rest.w += kBelowLayers_m * std::clamp(most, 0.0F, 1.0F);
  }
}

}  // namespace viscera
