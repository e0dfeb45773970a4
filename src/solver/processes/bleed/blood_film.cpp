// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/bleed/blood_film.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/body/body_nodes.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

constexpr double kClings_m = 1e-5;    // a film no thicker than the width of a red cell does not flow
constexpr int kSubsteps = 4;          // per tick
constexpr double kMostLeaves = 0.5;   // of a node's blood leaves it per substep, at most: two spacings in a tick
constexpr double kFacesDown = 0.3;    // cosine: exceeded by edges of flat tissue, not by walls
constexpr double kOverAnEdge = -0.1;  // cosine: the same of the edges of a flat sheet
constexpr double kOneSided = 0.5;     // sum of unit vectors to a node's neighbours below which it has no outside
constexpr double kLower = 0.01;       // in spacings: smaller differences of height are ignored

bool isSheet(const Body& body) {
  return hasOwnNetwork(body);
}

}  // namespace

BloodFilm::BloodFilm(const Model& model, const HeatGraph& graph, const Vector3d& gravity_m_per_s2,
                     double viscosity_m2_per_s)
    : graph_(graph),
      speed_per_m2_s_(gravity_m_per_s2.norm() / (3 * viscosity_m2_per_s)),
      rest_m_(model.slots(), Vector3d::Zero()),
      height_m_(model.slots(), 0),
      drip_cos_(model.slots(), kFacesDown),
      down_(gravity_m_per_s2.norm() > 0 ? Vector3d(gravity_m_per_s2.normalized()) : Vector3d::Zero().eval()),
      is_cut_(graph.links.size(), 0),
      surface_(model.slots()),
      volume_m3_(model.slots(), 0),
      gain_m3_(model.slots(), 0),
      is_wet_(model.slots(), 0) {
  for (uint32_t b = 0; b < model.bodies.size(); ++b) {
    forEachNode(model.bodies[b], [&](uint32_t slot) {
      const uint32_t at = model.slotOffset(b) + slot;
      rest_m_[at] = restPosition(model.bodies[b], slot);
      height_m_[at] = -down_.dot(rest_m_[at]);
      if (isSheet(model.bodies[b])) drip_cos_[at] = kOverAnEdge;
    });
  }
  setCuts(is_cut_);
}

/// Calls visit for each link of a node. @param visit  (link, slot at its other end, length)
template <class Visit>
void BloodFilm::forEachLink(uint32_t slot, const Visit& visit) const {
  for (uint32_t i = graph_.starts[slot]; i < graph_.starts[slot + 1]; ++i) {
    const uint32_t link = graph_.links_of[i];
    const uint32_t other = graph_.links[link].a == slot ? graph_.links[link].b : graph_.links[link].a;
    visit(link, other, (rest_m_[other] - rest_m_[slot]).norm());
  }
}

void BloodFilm::setCuts(const std::vector<uint8_t>& is_cut) {
  is_cut_ = is_cut;
  for (uint32_t slot = 0; slot < surface_.size(); ++slot) {
    surface_[slot] = {graph_.exposed_m2[slot], 0, false};
    forEachLink(slot, [&](uint32_t link, uint32_t, double length_m) {
      if (is_cut_[link]) surface_[slot].area_m2 += graph_.links[link].w_per_k * length_m;
    });
  }
  for (uint32_t slot = 0; slot < surface_.size(); ++slot)
    if (surface_[slot].area_m2 > 0) lookAround(slot);
}

/// Finds a node's share of the surface: the sum of width times length to its neighbours is four times the area.
void BloodFilm::lookAround(uint32_t slot) {
  Vector3d inward = Vector3d::Zero();
  int along = 0;
  bool is_lowest = true;
  forEachLink(slot, [&](uint32_t link, uint32_t other, double length_m) {
    if (is_cut_[link]) return;
    inward += (rest_m_[other] - rest_m_[slot]) / length_m;
    if (surface_[other].area_m2 <= 0) return;
    ++along;
    is_lowest = is_lowest && height_m_[other] > height_m_[slot] - kLower * length_m;
  });
  Surface& it = surface_[slot];
  it.width_m = along > 0 ? 4 * it.area_m2 / along : 0;
  it.drips = is_lowest && inward.norm() > kOneSided && -inward.normalized().dot(down_) > drip_cos_[slot];
}

double BloodFilm::thickness_m(uint32_t slot) const {
  return surface_[slot].area_m2 > 0 ? volume_m3_[slot] / surface_[slot].area_m2 : 0;
}

double BloodFilm::onTissue_m3() const {
  double out = 0;
  for (const uint32_t slot : wet_) out += volume_m3_[slot];
  return out;
}

void BloodFilm::wetten(uint32_t slot) {
  if (std::exchange(is_wet_[slot], uint8_t{1}) == 0) wet_.push_back(slot);
}

void BloodFilm::give(uint32_t slot, double m3) {
  wetten(slot);
  volume_m3_[slot] += m3;
}

double BloodFilm::take(uint32_t slot, double share) {
  const double out_m3 = share * volume_m3_[slot];
  volume_m3_[slot] -= out_m3;
  return out_m3;
}

void BloodFilm::step(double dt_s) {
  for (int s = 0; s < kSubsteps; ++s) substep(dt_s / kSubsteps);
}

void BloodFilm::substep(double dt_s) {
  const size_t count = wet_.size();
  for (size_t i = 0; i < count; ++i) run(wet_[i], dt_s);
  for (const uint32_t slot : wet_) volume_m3_[slot] += std::exchange(gain_m3_[slot], 0);
}

/// Moves blood out of a node in a substep: Nusselt's film, g d^3 / (3 nu) per width along a slope, which is that of the
/// film's own surface.
void BloodFilm::run(uint32_t slot, double dt_s) {
  const Surface& it = surface_[slot];
  const double thick_m = thickness_m(slot), movable_m3 = volume_m3_[slot] - kClings_m * it.area_m2;
  if (movable_m3 <= 0 || volume_m3_[slot] == 0) return;
  if (it.width_m == 0) {  // nothing is left around it
    dripped_m3_ += std::exchange(volume_m3_[slot], 0);
    return;
  }
  const double flux_m2_per_s = speed_per_m2_s_ * thick_m * thick_m * thick_m;
  flows_.clear();
  double all_m3 = 0;
  forEachLink(slot, [&](uint32_t link, uint32_t other, double length_m) {
    if (is_cut_[link] || surface_[other].area_m2 <= 0) return;
    const double slope = (height_m_[slot] + thick_m - height_m_[other] - thickness_m(other)) / length_m;
    if (slope <= 0) return;
    const double width_m = 0.5 * (it.width_m + surface_[other].width_m) / length_m;
    flows_.emplace_back(other, flux_m2_per_s * std::min(1.0, slope) * width_m * dt_s);
    all_m3 += flows_.back().second;
  });
  const double drips_m3 = it.drips ? flux_m2_per_s * std::sqrt(it.area_m2) * dt_s : 0;
  all_m3 += drips_m3;
  if (all_m3 <= 0) return;
  const double scale = std::min(1.0, kMostLeaves * movable_m3 / all_m3);
  for (const auto& [other, m3] : flows_) {
    wetten(other);
    gain_m3_[other] += scale * m3;
  }
  gain_m3_[slot] -= scale * all_m3;
  dripped_m3_ += scale * drips_m3;
}

void BloodFilm::reset() {
  for (const uint32_t slot : wet_) {
    volume_m3_[slot] = 0;
    is_wet_[slot] = 0;
  }
  wet_.clear();
  dripped_m3_ = 0;
}

void BloodFilm::persist(Archive& archive) {
  if (archive.reads()) reset();
  std::vector<uint32_t> slots = wet_;
  archive.list(slots);
  archive.value(dripped_m3_);
  for (const uint32_t slot : slots) {
    if (slot >= volume_m3_.size()) throw Error("the saved state has blood on a node that the scene does not have");
    archive.value(volume_m3_[slot]);
    wetten(slot);
  }
}

void BloodFilm::addTo(StateHash& hash) const {
  for (const uint32_t slot : wet_) {
    hash.add(slot);
    hash.add(static_cast<float>(1e9 * volume_m3_[slot]));
  }
}

}  // namespace viscera
