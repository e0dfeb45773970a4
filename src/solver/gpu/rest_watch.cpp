// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/rest_watch.h"

#include <algorithm>

#include "math/float_bits.h"
#include "solver/tissue/joined_lattice.h"

namespace viscera {

namespace {

// The reaction of tools in the first of these ticks may have been measured before the tissue slept.
constexpr int kTicksToBeSure = 2;

bool meet(const ToolBox& a, const ToolBox& b, float margin) {
  return ((a.low.array() - margin) <= b.high.array()).all() && ((a.high.array() + margin) >= b.low.array()).all();
}

}  // namespace

RestWatch::RestWatch(const Model& model, bool may_rest) : may_rest_(may_rest) {
  all_ = {Vector3f::Constant(HUGE_VALF), Vector3f::Constant(-HUGE_VALF)};
  for (const layout::Brick& brick : allBricks(model)) {
    const Lattice& lattice = model.bodies[brick.body].lattice;
    const float h = static_cast<float>(lattice.spacing_m), edge = h * static_cast<float>(layout::kBrickEdge);
    const Vector3f low = lattice.origin_m.cast<float>() + edge * Vector3f(static_cast<float>(brick.coord_x),
                                                                          static_cast<float>(brick.coord_y),
                                                                          static_cast<float>(brick.coord_z));
    bricks_.push_back({low, low + Vector3f::Constant(edge)});
    all_ = {all_.low.cwiseMin(low), all_.high.cwiseMax(bricks_.back().high)};
  }
}

bool RestWatch::mayWake(const std::vector<ToolBox>& boxes) const {
  return std::any_of(boxes.begin(), boxes.end(), [this](const ToolBox& box) {
    // A box that is not finite wakes everything.
    if (!box.low.allFinite() || !box.high.allFinite()) return true;
    return meet(all_, box, farthest_m_) && std::any_of(bricks_.begin(), bricks_.end(), [&](const ToolBox& brick) {
             return meet(brick, box, farthest_m_);
           });
  });
}

void RestWatch::beginTick() {
  const auto wakes = [this](const Disturbance& d) { return d.boxes.empty() || mayWake(d.boxes); };
  resting_ =
      may_rest_ && asleep_ticks_ >= kTicksToBeSure && std::none_of(disturbances_.begin(), disturbances_.end(), wakes);
}

void RestWatch::disturb() {
  resting_ = false;
  if (may_rest_) disturbances_.push_back({tick_, {}});
}

bool RestWatch::disturbNear(const std::vector<ToolBox>& boxes) {
  if (boxes.empty() || (resting_ && !mayWake(boxes))) return false;
  resting_ = false;
  if (may_rest_) disturbances_.push_back({tick_, boxes});
  return true;
}

void RestWatch::receive(uint64_t tick, const layout::AwakeList& awake) {
  asleep_ticks_ = awake.bricks == 0 ? asleep_ticks_ + 1 : 0;
  farthest_m_ = floatFromBits(awake.farthest_bits);
  disturbances_.erase(std::remove_if(disturbances_.begin(), disturbances_.end(),
                                     [tick](const Disturbance& d) { return d.tick <= tick; }),
                      disturbances_.end());
}

}  // namespace viscera
