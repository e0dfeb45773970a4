// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/bleed/bleeding.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "math/number_text.h"
#include "model/body/body_nodes.h"
#include "solver/processes/burn/burns.h"
#include "solver/processes/pressure/pressures.h"

namespace viscera {

namespace {

constexpr double kSqueezed = 0.75;    // spacings at rest from a clip's line that are squeezed: its lines close a layer
constexpr double kOpaque_m = 3.5e-5;  // depth at which blood with 150 g/l of haemoglobin transmits 1/e of green light
constexpr double kSeen = 1.0 / 128;   // smallest change of a share that is drawn
constexpr double kMlPerM3 = 1e6;
constexpr double kSecondsPerMinute = 60;

double distance_m(const Vector3d& to, const std::array<Vector3d, 2>& line) {
  const Vector3d along = line[1] - line[0];
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((to - line[0]).dot(along) / length2, 0.0, 1.0) : 0;
  return (to - line[0] - t * along).norm();
}

}  // namespace

Bleeding::Bleeding(const Model& model, const Vector3d& gravity_m_per_s2, double tick_s)
    : model_(model),
      tick_s_(tick_s),
      graph_(model, 1),
      vessels_(model, graph_),
      film_(model, graph_, gravity_m_per_s2),
      is_cut_(graph_.links.size(), 0),
      is_closed_(model.slots(), 0) {}

void Bleeding::cutsChanged(const CutSprings& cuts) {
  bool changed = false;
  for (size_t i = 0; i < is_cut_.size(); ++i) {
    const auto is_cut = static_cast<uint8_t>(graph_.springs[graph_.links[i].spring].isCut(cuts));
    changed = std::exchange(is_cut_[i], is_cut) != is_cut || changed;
  }
  if (!changed) return;
  is_stale_ = true;
  film_.setCuts(is_cut_);
}

void Bleeding::detectClosed(const Clips* clips, const HeatField* heat) {
  std::vector<std::array<Vector3d, 2>> squeezed_m;
  if (clips) squeezed_m = clips->squeezed_m();
  size_t coagulated = 0;
  if (heat) {
    for (const uint32_t slot : heat->touched()) coagulated += heat->isCoagulated(slot);
  }
  if (squeezed_m == squeezed_m_ && coagulated == coagulated_) return;
  squeezed_m_ = std::move(squeezed_m);
  coagulated_ = coagulated;
  is_stale_ = true;
  std::fill(is_closed_.begin(), is_closed_.end(), uint8_t{0});
  const double reach_m = kSqueezed * longestSpacing(model_);
  for (const uint32_t slot : squeezed_m_.empty() ? std::vector<uint32_t>() : vessels_.nodes()) {
    is_closed_[slot] = std::any_of(squeezed_m_.begin(), squeezed_m_.end(),
                                   [&](const auto& line) { return distance_m(vessels_.rest_m(slot), line) < reach_m; });
  }
  for (size_t i = 0; coagulated_ > 0 && i < heat->touched().size(); ++i) {
    const uint32_t slot = heat->touched()[i];
    if (heat->isCoagulated(slot)) is_closed_[slot] = 1;
  }
}

bool Bleeding::endTick(TissuePort&, const ProcessTick&, const TissueProcesses& all) {
  const Burns* const burns = findProcess<Burns>(all);
  detectClosed(findProcess<Clips>(all), burns ? &burns->heat() : nullptr);
  if (std::exchange(is_stale_, false)) leaks_ = vessels_.find(is_cut_, is_closed_);
  if (const Pressures* const pressures = findProcess<Pressures>(all)) flowByPressure(*pressures);
  for (const Vessels::Leak& leak : leaks_.of_nodes) {
    film_.give(leak.slot, leak.m3_per_s * tick_s_);
    bled_m3_ += leak.m3_per_s * tick_s_;
  }
  if (film_.wet().empty()) return false;
  film_.step(tick_s_);
  updateVisuals();
  return false;
}

/// Lets blood flow out of bodies with pressure as their lumens do, in this tick.
void Bleeding::flowByPressure(const Pressures& pressures) {
  is_stale_ = true;
  auto& leaks = leaks_.of_nodes;
  leaks.erase(std::remove_if(leaks.begin(), leaks.end(), [&](const auto& leak) { return pressures.owns(leak.slot); }),
              leaks.end());
  for (const Pressures::Leak& leak : pressures.leaks()) leaks.push_back({leak.slot, leak.m3_per_s});
  leaks_.stumps = pressures.openStations();
}

void Bleeding::updateVisuals() {
  std::vector<float> shares(model_.slots(), 0);
  bool changed = !paint_;
  for (const uint32_t slot : film_.wet()) {
    shares[slot] = static_cast<float>(1 - std::exp(-film_.thickness_m(slot) / kOpaque_m));
    changed = changed || std::abs(static_cast<double>(shares[slot] - paint_->shares[slot])) > kSeen;
  }
  if (changed) paint_ = std::make_shared<const NodePaint>(NodePaint{PaintKind::kBlood, std::move(shares)});
}

BloodReport Bleeding::seen() const {
  BloodReport out;
  out.bled_ml = kMlPerM3 * bled_m3_;
  out.on_tissue_ml = kMlPerM3 * film_.onTissue_m3();
  out.dripped_ml = kMlPerM3 * film_.dripped_m3();
  for (const Vessels::Leak& leak : leaks_.of_nodes) out.flow_ml_per_min += kMlPerM3 * kSecondsPerMinute * leak.m3_per_s;
  out.stumps = leaks_.stumps;
  return out;
}

/// Resets the look too, including what must be drawn clean again.
void Bleeding::reset() {
  film_.reset();
  std::fill(is_closed_.begin(), is_closed_.end(), uint8_t{0});
  squeezed_m_.clear();
  coagulated_ = 0;
  is_stale_ = true;
  leaks_ = {};
  bled_m3_ = 0;
  if (paint_)
    paint_ = std::make_shared<const NodePaint>(NodePaint{PaintKind::kBlood, std::vector<float>(model_.slots(), 0)});
}

void Bleeding::persist(Archive& archive) {
  archive.section("bleeding");
  if (archive.reads()) reset();
  archive.value(bled_m3_);
  film_.persist(archive);
  if (archive.reads() && !film_.wet().empty()) updateVisuals();
}

bool Bleeding::addTo(StateHash& hash) const {
  if (film_.wet().empty()) return false;
  film_.addTo(hash);
  return true;
}

FactGroup Bleeding::facts() const {
  const BloodReport blood = seen();
  FactGroup out{"bleeding", fixedText(blood.bled_ml, 1) + " ml, " + fixedText(blood.flow_ml_per_min, 0) + " ml/min"};
  out.facts = {{"bled_ml", blood.bled_ml},
               {"on_tissue_ml", blood.on_tissue_ml},
               {"dripped_ml", blood.dripped_ml},
               {"flow_ml_per_min", blood.flow_ml_per_min},
               {"stumps", blood.stumps}};
  return out;
}

void Bleeding::draw(ProcessVisuals& visuals) const {
  if (paint_) visuals.paints.push_back(paint_);
}

}  // namespace viscera
