// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/burn/heat_field.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "viscera/math/error.h"

namespace viscera {

namespace {

constexpr double kWarm_k = 0.002;        // warmer nodes heat their neighbours
constexpr double kForgotten_k = 0.0005;  // cooler nodes without such a neighbour are set to body temperature
constexpr double kStable = 0.5;  // of the stability limit of an explicit step: no node overshoots its neighbours
constexpr double kGas_j_per_mol_k = 8.314462;
constexpr double kZero_c = -273.15;
constexpr double kMostDose = 30;  // fully coagulated; the dose is clamped here

}  // namespace

HeatField::HeatField(const Model& model, const HeatConstants& constants)
    : constants_(constants),
      graph_(model, constants.conductivity_w_per_m_k),
      nodes_(model.slots()),
      is_touched_(model.slots(), 0),
      is_active_(model.slots(), 0),
      rise_k_(model.slots(), 0),
      gain_j_(model.slots(), 0) {}

void HeatField::setCuts(const CutSprings& cuts) {
  closed_.resize(graph_.springs.size());
  for (size_t s = 0; s < closed_.size(); ++s) closed_[s] = graph_.springs[s].isCut(cuts);
}

double HeatField::capacity_j_per_k(uint32_t slot) const {
  return graph_.mass_kg[slot] * constants_.heat_j_per_kg_k - nodes_[slot].boiled_kg * constants_.water_j_per_kg_k;
}

double HeatField::rise_k(uint32_t slot) const {
  return graph_.mass_kg[slot] > 0 ? nodes_[slot].heat_j / capacity_j_per_k(slot) : 0;
}

double HeatField::temperature_c(uint32_t slot) const {
  return constants_.body_c + rise_k(slot);
}

double HeatField::coagulated(uint32_t slot) const {
  return 1 - std::exp(-nodes_[slot].dose);
}

double HeatField::boiled(uint32_t slot) const {
  return nodes_[slot].boiled_kg / (constants_.water_share * graph_.mass_kg[slot]);
}

void HeatField::touch(uint32_t slot) {
  if (!is_touched_[slot]) touched_.push_back(slot);
  if (!is_active_[slot]) active_.push_back(slot);
  is_touched_[slot] = is_active_[slot] = 1;
}

void HeatField::give(uint32_t slot, double joule) {
  touch(slot);
  nodes_[slot].heat_j += joule;
  sums_.given_j += joule;
  boil(slot);
}

template <class Visit>
void HeatField::forEachNeighbor(uint32_t slot, const Visit& visit) const {
  for (uint32_t i = graph_.starts[slot]; i < graph_.starts[slot + 1]; ++i) {
    const HeatGraph::Link& link = graph_.links[graph_.links_of[i]];
    if (isOpen(link)) visit(link.a == slot ? link.b : link.a, link.w_per_k);
  }
}

void HeatField::step(double dt_s) {
  if (active_.empty()) return;
  widen();
  const int steps = static_cast<int>(std::ceil(dt_s * fastest_per_s() / kStable));
  for (int i = 0; i < steps; ++i) substep(dt_s / steps);
  narrow();
}

void HeatField::widen() {
  const size_t count = active_.size();
  for (size_t i = 0; i < count; ++i) {
    if (rise_k(active_[i]) > kWarm_k) forEachNeighbor(active_[i], [&](uint32_t other, double) { touch(other); });
  }
}

/// Deactivates cool nodes. Their remaining heat counts as carried away by blood. Isolated nodes keep theirs, with no
/// effect.
void HeatField::narrow() {
  const auto hasWarmNeighbor = [&](uint32_t slot) {
    bool warm = false;
    forEachNeighbor(slot, [&](uint32_t other, double) { warm = warm || rise_k(other) > kWarm_k; });
    return warm;
  };
  const auto isAlone = [&](uint32_t slot) {
    bool alone = true;
    forEachNeighbor(slot, [&](uint32_t, double) { alone = false; });
    return alone;
  };
  std::vector<uint32_t> leaving;
  for (const uint32_t slot : active_) {
    if (isAlone(slot)) {
      leaving.push_back(slot);
    } else if (rise_k(slot) <= kForgotten_k && !hasWarmNeighbor(slot)) {
      sums_.perfused_j += nodes_[slot].heat_j;
      nodes_[slot].heat_j = 0;
      leaving.push_back(slot);
    }
  }
  if (leaving.empty()) return;
  for (const uint32_t slot : leaving) is_active_[slot] = 0;
  active_.erase(std::remove_if(active_.begin(), active_.end(), [&](uint32_t slot) { return !is_active_[slot]; }),
                active_.end());
}

/// Returns the cooling by blood, which perfuses tissue that is not coagulated.
double HeatField::lossRate_w_per_k(uint32_t slot) const {
  return constants_.perfusion_per_s * constants_.blood_j_per_m3_k * graph_.volume_m3[slot] *
         std::exp(-nodes_[slot].dose);
}

double HeatField::fastest_per_s() const {
  double out = 0;
  for (const uint32_t slot : active_) {
    double sum = lossRate_w_per_k(slot) + constants_.air_w_per_m2_k * graph_.exposed_m2[slot];
    forEachNeighbor(slot, [&](uint32_t, double w_per_k) { sum += w_per_k; });
    out = std::max(out, sum / capacity_j_per_k(slot));
  }
  return out;
}

void HeatField::substep(double dt_s) {
  for (const uint32_t slot : active_) rise_k_[slot] = rise_k(slot);
  for (const uint32_t slot : active_) {
    double gain_w = 0, away_w = 0;  // loss to nodes that stay at body temperature
    forEachNeighbor(slot, [&](uint32_t other, double w_per_k) {
      if (is_active_[other]) {
        gain_w += w_per_k * (rise_k_[other] - rise_k_[slot]);
      } else {
        away_w += w_per_k * rise_k_[slot];
      }
    });
    gain_j_[slot] = dt_s * (gain_w - away_w);
    sums_.perfused_j += dt_s * away_w;
  }
  for (const uint32_t slot : active_) {
    Node& node = nodes_[slot];
    const double perfused_j = dt_s * lossRate_w_per_k(slot) * rise_k_[slot];
    // The loss of a surface at body temperature is balanced by blood: only the excess counts.
    const double surface_j = dt_s * constants_.air_w_per_m2_k * graph_.exposed_m2[slot] * rise_k_[slot];
    node.heat_j += gain_j_[slot] - perfused_j - surface_j;
    sums_.perfused_j += perfused_j;
    sums_.surface_j += surface_j;
    boil(slot);
    const double at_c = temperature_c(slot);
    if (at_c > constants_.dose_above_c) {
      node.dose +=
          dt_s * constants_.dose_per_s * std::exp(-constants_.dose_j_per_mol / (kGas_j_per_mol_k * (at_c - kZero_c)));
      node.dose = std::min(node.dose, kMostDose);
    }
  }
}

/// Turns heat above the boiling point into steam while there is water; steam leaves with its heat.
void HeatField::boil(uint32_t slot) {
  Node& node = nodes_[slot];
  const double span_k = constants_.boiling_c - constants_.body_c;
  const double above_j = node.heat_j - capacity_j_per_k(slot) * span_k;
  const double left_kg = constants_.water_share * graph_.mass_kg[slot] - node.boiled_kg;
  if (above_j <= 0 || left_kg <= 0) return;
  const double steam_kg = std::min(above_j / constants_.boiling_j_per_kg, left_kg);
  const double steam_j = steam_kg * (constants_.boiling_j_per_kg + constants_.water_j_per_kg_k * span_k);
  node.boiled_kg += steam_kg;
  node.heat_j -= steam_j;
  sums_.steam_j += steam_j;
}

BurnReport HeatField::seen() const {
  BurnReport out = sums_;
  out.hottest_c = constants_.body_c;
  for (const uint32_t slot : touched_) {
    out.stored_j += nodes_[slot].heat_j;
    if (is_active_[slot]) out.hottest_c = std::max(out.hottest_c, temperature_c(slot));
    if (isCoagulated(slot)) out.coagulated_m3 += graph_.volume_m3[slot];
  }
  return out;
}

void HeatField::reset() {
  for (const uint32_t slot : touched_) {
    nodes_[slot] = {};
    is_touched_[slot] = is_active_[slot] = 0;
  }
  touched_.clear();
  active_.clear();
  closed_.clear();
  sums_ = {};
}

void HeatField::persist(Archive& archive) {
  if (archive.reads()) reset();
  std::vector<uint32_t> touched = touched_, active = active_;
  archive.list(touched);
  archive.list(active);
  for (const std::vector<uint32_t>* slots : {&touched, &active}) {
    for (const uint32_t slot : *slots) {
      if (slot >= nodes_.size() || graph_.mass_kg[slot] <= 0)
        throw Error("the saved state has a burn on a node that the scene does not have");
    }
  }
  if (archive.reads()) {
    for (const uint32_t slot : touched) is_touched_[slot] = 1;
    for (const uint32_t slot : active) is_active_[slot] = 1;
    touched_ = touched;
    active_ = active;
  }
  for (const uint32_t slot : touched_) archive.value(nodes_[slot]);
  archive.value(sums_);
}

void HeatField::addTo(StateHash& hash) const {
  for (const uint32_t slot : touched_) {
    hash.add(slot);
    hash.add(static_cast<float>(nodes_[slot].heat_j));
    hash.add(static_cast<float>(nodes_[slot].dose));
  }
}

}  // namespace viscera
