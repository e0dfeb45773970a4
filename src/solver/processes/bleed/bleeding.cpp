// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/bleed/bleeding.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "math/number_text.h"
#include "model/body/body_nodes.h"
#include "model/scene/tool_kinds.h"
#include "solver/processes/burn/burns.h"
#include "solver/processes/pressure/pressures.h"

namespace viscera {

namespace {

constexpr double kSqueezed = 0.75;   // spacings at rest from a clip's line that are squeezed: its lines close a layer
constexpr double kSuction_s = 0.1;   // in which 1/e of a film stays: suction of litres a minute has no limit here
constexpr double kSeen = 1.0 / 128;  // smallest change of a share that is drawn
constexpr double kMlPerM3 = 1e6;
constexpr double kSecondsPerMinute = 60;

/// What distinguishes the fluids, in the order of Fluid.
struct FluidTraits {
  const char* name;  ///< of its facts and of its section of saved states
  const char* lost;  ///< fact: what has flowed out
  PaintKind paint;
  double viscosity_m2_per_s;
  double opaque_m;  ///< depth at which it transmits 1/e of the light
};
constexpr FluidTraits kFluids[] = {
    {"bleeding", "bled_ml", PaintKind::kBlood, kBloodViscosity_m2_per_s, 3.5e-5},  // green light, 150 g/l haemoglobin
    {"bile", "bile_ml", PaintKind::kBile, 2e-6, 1e-4},                             // 2 mPa s over 1 kg/l; by eye
};

const FluidTraits& traitsOf(Fluid fluid) {
  return kFluids[static_cast<size_t>(fluid)];
}

double distance_m(const Vector3d& to, const std::array<Vector3d, 2>& line) {
  const Vector3d along = line[1] - line[0];
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((to - line[0]).dot(along) / length2, 0.0, 1.0) : 0;
  return (to - line[0] - t * along).norm();
}

}  // namespace

Bleeding::Bleeding(const Model& model, const std::vector<StylusConfig>& styluses, const Vector3d& gravity_m_per_s2,
                   double tick_s, Fluid fluid)
    : model_(model),
      styluses_(styluses),
      tick_s_(tick_s),
      fluid_(fluid),
      graph_(model, 1),
      vessels_(model, graph_, fluid),
      film_(model, graph_, gravity_m_per_s2, traitsOf(fluid).viscosity_m2_per_s),
      is_cut_(graph_.links.size(), 0),
      is_closed_(model.slots(), 0),
      left_m3_(vessels_.supplies_m3()) {}

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

/// Returns the share of the fluid of a leak's vessel that is left; 1 where it does not end.
double Bleeding::fullness(const Vessels::Leak& leak) const {
  const double all_m3 = leak.group ? vessels_.supplies_m3()[*leak.group] : 0;
  return all_m3 > 0 ? left_m3_[*leak.group] / all_m3 : 1;
}

/// Lets a tick's fluid out. Where it ends, the flow falls with what is left, as out of an elastic bag: exponentially.
void Bleeding::leak() {
  std::vector<double> full_m3(left_m3_.size(), 0);
  for (const Vessels::Leak& leak : leaks_.of_nodes)
    if (leak.group) full_m3[*leak.group] += leak.m3_per_s * tick_s_;
  std::vector<double> share(left_m3_.size(), 1);  // of the flow of a full vessel
  for (size_t group = 0; group < left_m3_.size(); ++group) {
    const double all_m3 = vessels_.supplies_m3()[group];
    if (all_m3 <= 0 || full_m3[group] <= 0) continue;
    const double out_m3 = left_m3_[group] * -std::expm1(-full_m3[group] / all_m3);
    share[group] = out_m3 / full_m3[group];
    left_m3_[group] -= out_m3;
  }
  for (const Vessels::Leak& leak : leaks_.of_nodes) {
    const double m3 = leak.m3_per_s * tick_s_ * (leak.group ? share[*leak.group] : 1);
    film_.give(leak.slot, m3);
    bled_m3_ += m3;
  }
}

/// Takes fluid from the nodes within reach of tools that suck.
void Bleeding::suck(const TissuePort& port, const ToolMotions& motions) {
  const auto sucks = [](const StylusMotion& motion) { return motion.present && kindOf(motion.mode).sucks; };
  if (std::none_of(motions.begin(), motions.end(), sucks)) return;
  const std::vector<uint32_t>& wet = film_.wet();
  std::vector<Vector3f> u_m(wet.size()), v_m_per_s(wet.size());
  port.readNodes(wet, u_m, v_m_per_s);
  const double share = -std::expm1(-tick_s_ / kSuction_s);
  for (size_t s = 0; s < styluses_.size(); ++s) {
    if (!sucks(motions[s])) continue;
    const double reach_m = kindOf(motions[s].mode).reach_m(styluses_[s]);
    for (size_t i = 0; i < wet.size(); ++i) {
      const Vector3d at_m = vessels_.rest_m(wet[i]) + u_m[i].cast<double>();
      if ((at_m - motions[s].to.position_m).norm() <= reach_m) suctioned_m3_ += film_.take(wet[i], share);
    }
  }
}

bool Bleeding::endTick(TissuePort& port, const ProcessTick& tick, const TissueProcesses& all) {
  const Burns* const burns = findProcess<Burns>(all);
  detectClosed(findProcess<Clips>(all), burns ? &burns->heat() : nullptr);
  findLeaks(fluid_ == Fluid::kBlood ? findProcess<Pressures>(all) : nullptr);
  leak();
  if (film_.wet().empty()) return false;
  film_.step(tick_s_);
  suck(port, tick.motions);
  updateVisuals();
  return false;
}

/// Finds the leaks of this tick. Blood flows out of bodies with pressure as their lumens let it.
void Bleeding::findLeaks(const Pressures* pressures) {
  if (is_stale_) {
    std::vector<uint8_t> is_closed = is_closed_;
    for (const uint32_t slot : vessels_.nodes())
      if (pressures && pressures->owns(slot)) is_closed[slot] = 1;
    found_ = vessels_.find(is_cut_, is_closed);
  }
  if (!std::exchange(is_stale_, false) && !pressures) return;
  leaks_ = found_;
  if (!pressures) return;
  for (const Pressures::Leak& leak : pressures->leaks())
    leaks_.of_nodes.push_back({leak.slot, leak.m3_per_s, vessels_.groupOf(leak.slot)});
  leaks_.stumps += pressures->openStations();
}

void Bleeding::updateVisuals() {
  std::vector<float> shares(model_.slots(), 0);
  const FluidTraits& traits = traitsOf(fluid_);
  bool changed = !paint_;
  for (const uint32_t slot : film_.wet()) {
    shares[slot] = static_cast<float>(1 - std::exp(-film_.thickness_m(slot) / traits.opaque_m));
    changed = changed || std::abs(static_cast<double>(shares[slot] - paint_->shares[slot])) > kSeen;
  }
  if (changed) paint_ = std::make_shared<const NodePaint>(NodePaint{traits.paint, std::move(shares)});
}

BloodReport Bleeding::seen() const {
  BloodReport out;
  out.bled_ml = kMlPerM3 * bled_m3_;
  out.on_tissue_ml = kMlPerM3 * film_.onTissue_m3();
  out.dripped_ml = kMlPerM3 * film_.dripped_m3();
  out.suctioned_ml = kMlPerM3 * suctioned_m3_;
  for (const Vessels::Leak& leak : leaks_.of_nodes)
    out.flow_ml_per_min += kMlPerM3 * kSecondsPerMinute * leak.m3_per_s * fullness(leak);
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
  bled_m3_ = suctioned_m3_ = 0;
  left_m3_ = vessels_.supplies_m3();
  if (paint_)
    paint_ = std::make_shared<const NodePaint>(NodePaint{paint_->kind, std::vector<float>(model_.slots(), 0)});
}

void Bleeding::persist(Archive& archive) {
  archive.section(traitsOf(fluid_).name);
  if (archive.reads()) reset();
  archive.value(bled_m3_);
  archive.value(suctioned_m3_);
  archive.values(left_m3_);
  for (size_t group = 0; archive.reads() && group < left_m3_.size(); ++group)
    archive.require(left_m3_[group] >= 0 && left_m3_[group] <= vessels_.supplies_m3()[group],
                    "the fluid that is left is not within 0 and the supply");
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
  const FluidTraits& traits = traitsOf(fluid_);
  FactGroup out{traits.name, fixedText(blood.bled_ml, 1) + " ml, " + fixedText(blood.flow_ml_per_min, 0) + " ml/min"};
  out.facts = {{traits.lost, blood.bled_ml},
               {"on_tissue_ml", blood.on_tissue_ml},
               {"dripped_ml", blood.dripped_ml},
               {"suctioned_ml", blood.suctioned_ml},
               {"flow_ml_per_min", blood.flow_ml_per_min},
               {"stumps", blood.stumps}};
  return out;
}

void Bleeding::draw(ProcessVisuals& visuals) const {
  if (paint_) visuals.paints.push_back(paint_);
}

}  // namespace viscera
