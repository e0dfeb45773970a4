// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/burn/burns.h"

#include <algorithm>
#include <cmath>

#include "math/number_text.h"
#include "model/body/body_nodes.h"
#include "model/scene/tool_kinds.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

namespace {

constexpr size_t kLookedAt = 4;          // nodes nearest to a tip, in the directions of which it may touch tissue
constexpr double kSpark_m = 0.0005;      // distance from a tip to tissue that sparks of coagulation reach
constexpr double kKerf_m = 0.0005;       // width boiled dry at which a node's tissue separates: a fine electrode's cut
constexpr double kNearby = 1.5;          // spacings from a tip: tissue that it touches has a node within that distance
constexpr double kErased = 0.1;          // spacings around a node that separates: none of its neighbours is that near
constexpr double kBurnSeen = 1.0 / 128;  // smallest change of a share that is drawn

layout::vec4 vec4Of(const Vector3d& v, double w = 0) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), static_cast<float>(w)};
}

}  // namespace

Burns::Burns(const Scene& scene, const Model& model)
    : model_(model),
      styluses_(scene.styluses),
      tick_s_(1 / scene.solver.tick_hz),
      heat_(model),
      tissue_(model),
      springs_(model),
      is_parted_(model.slots(), 0) {
  for (uint32_t b = 0; b < model.bodies.size(); ++b)
    forEachNode(model.bodies[b], [&](uint32_t slot) { nodes_.push_back(model.slotOffset(b) + slot); });
}

void Burns::cutsChanged(const CutSprings& cuts) {
  heat_.setCuts(cuts);
  tissue_.setCuts(cuts);
  cuts_ = cuts;
  springs_.find(heat_, cuts_);
}

uint32_t Burns::bodyOf(uint32_t slot) const {
  uint32_t body = 0;
  while (body + 1 < model_.bodies.size() && slot >= model_.slotOffset(body + 1)) ++body;
  return body;
}

bool Burns::act(TissuePort& port, const ProcessTick& tick, const ProcessSubstep& substep) {
  if (tick.recovering) return false;
  bool cut = false;
  if (substep.index == 0) {
    heatWhatTipsTouch(port, tick.motions);
    heat_.step(tick_s_);
    if (heat_.isWarm()) {
      cut = partWhatBoiled(port);
      updateVisuals();
      springs_.find(heat_, cuts_);
    }
  }
  if (!springs_.empty()) work_j_ += springs_.pull(port, substep.dt_s);
  return cut;
}

/// Returns the points that a tip touches: the nearest nodes within spark distance, and the tissue at that distance in
/// the directions of the nearest nodes and of their mean.
std::vector<TissuePoint> Burns::touchedBy(TissuePort& port, const StylusMotion& motion, double radius_m) const {
  const Vector3d tip_m = motion.to.position_m;
  std::vector<Vector3f> u(nodes_.size()), v(nodes_.size());
  port.readNodes(nodes_, u, v);
  struct Near {
    double distance_m;
    uint32_t slot;
    Vector3d offset_m;
    bool operator<(const Near& other) const {
      return std::make_pair(distance_m, slot) < std::make_pair(other.distance_m, other.slot);
    }
  };
  std::vector<Near> near;
  const double within_m = radius_m + kNearby * longestSpacing(model_);
  for (size_t i = 0; i < nodes_.size(); ++i) {
    if (is_parted_[nodes_[i]]) continue;
    const Vector3d offset_m = tissue_.rest_m(nodes_[i]) + u[i].cast<double>() - tip_m;
    if (offset_m.norm() < within_m) near.push_back({offset_m.norm(), nodes_[i], offset_m});
  }
  std::sort(near.begin(), near.end());
  if (near.size() > kLookedAt) near.resize(kLookedAt);
  const double reach_m = radius_m + kSpark_m;
  Vector3d mean = Vector3d::Zero();
  std::vector<TissuePoint> out;
  const auto visuals = [&](const Vector3d& offset) {
    if (const auto point = tissue_.find(port, tip_m + reach_m * offset.normalized())) out.push_back(*point);
  };
  for (const Near& node : near) {
    mean += node.offset_m;
    if (node.distance_m > reach_m) {
      visuals(node.offset_m);
    } else {
      const uint32_t body = bodyOf(node.slot);
      out.push_back(nodePoint(model_, body, node.slot - model_.slotOffset(body)));
    }
  }
  if (!near.empty()) visuals(mean);
  return out;
}

void Burns::heatWhatTipsTouch(TissuePort& port, const ToolMotions& motions) {
  for (uint32_t s = 0; s < styluses_.size(); ++s) {
    const StylusMotion& motion = motions[s];
    const CauteryConfig& config = styluses_[s].cautery;
    if (!motion.present || !kindOf(motion.mode).burns || config.power_w <= 0) continue;
    const std::vector<TissuePoint> points = touchedBy(port, motion, config.radius_m);
    for (const TissuePoint& point : points) {
      double sum = 0;  // weights may be negative next to a cut
      for (uint32_t c = 0; c < point.count; ++c) sum += std::max(0.0, static_cast<double>(point.weights[c]));
      for (uint32_t c = 0; c < point.count; ++c) {
        const double share = std::max(0.0, static_cast<double>(point.weights[c])) / sum;
        if (share > 0)
          heat_.give(point.slots[c], share * config.power_w * tick_s_ / static_cast<double>(points.size()));
      }
    }
  }
}

/// Returns the share of a node's water at which a kerf's width of its tissue is boiled dry.
double Burns::boiledToPart(uint32_t body) const {
  return std::min(1.0, kKerf_m / heat_.graph().spacing_m[body]);
}

bool Burns::partWhatBoiled(TissuePort& port) {
  bool any = false;
  for (const uint32_t slot : heat_.touched()) {
    const uint32_t b = bodyOf(slot);
    if (is_parted_[slot] || heat_.boiled(slot) < boiledToPart(b)) continue;
    const Lattice& lattice = model_.bodies[b].lattice;
    Vector3d at_m = tissue_.rest_m(slot);
    if (!lattice.offset_to_surface_m.empty())
      at_m += lattice.offset_to_surface_m[slot - model_.slotOffset(b)].cast<double>();
    layout::ToolMotion sweep{};
    sweep.from = sweep.to = sweep.blade_to = vec4Of(at_m);
    sweep.blade_from = vec4Of(at_m, kErased * heat_.graph().spacing_m[b]);
    port.selectBody(b);
    port.cutAtRest(sweep, true);
    is_parted_[slot] = 1;
    parted_.push_back(slot);
    any = true;
  }
  return any;
}

void Burns::updateVisuals() {
  std::vector<float> shares(model_.slots(), 0);
  bool changed = !paint_;
  for (const uint32_t slot : heat_.touched()) {
    const double charred = std::min(1.0, heat_.boiled(slot) / boiledToPart(bodyOf(slot)));
    shares[slot] = static_cast<float>(heat_.coagulated(slot) + charred);
    changed = changed || std::abs(static_cast<double>(shares[slot] - paint_->shares[slot])) > kBurnSeen;
  }
  if (changed) paint_ = std::make_shared<const NodePaint>(NodePaint{PaintKind::kBurn, std::move(shares)});
}

BurnReport Burns::seen() const {
  BurnReport out = heat_.seen();
  out.parted = parted_.size();
  return out;
}

void Burns::reset() {
  heat_.reset();
  for (const uint32_t slot : parted_) is_parted_[slot] = 0;
  parted_.clear();
  cuts_ = {};
  springs_.find(heat_, cuts_);
  if (paint_) updateVisuals();
}

void Burns::persist(Archive& archive) {
  archive.section("burns");
  if (archive.reads()) reset();
  heat_.persist(archive);
  archive.list(parted_);
  if (!archive.reads()) return;
  for (const uint32_t slot : parted_) {
    if (slot >= is_parted_.size()) throw Error("the saved state has a burn on a node that the scene does not have");
    is_parted_[slot] = 1;
  }
  if (!heat_.touched().empty()) updateVisuals();
}

bool Burns::addTo(StateHash& hash) const {
  heat_.addTo(hash);
  return true;
}

FactGroup Burns::facts() const {
  const BurnReport burns = seen();
  FactGroup out{"burns", "hottest node " + numberText(std::round(burns.hottest_c)) + " C"};
  out.facts = {{"given_j", burns.given_j},
               {"stored_j", burns.stored_j},
               {"steam_j", burns.steam_j},
               {"perfused_j", burns.perfused_j},
               {"surface_j", burns.surface_j},
               {"hottest_c", burns.hottest_c},
               {"coagulated_m3", burns.coagulated_m3},
               {"parted", burns.parted}};
  return out;
}

void Burns::draw(ProcessVisuals& visuals) const {
  if (paint_) visuals.paints.push_back(paint_);
}

}  // namespace viscera
