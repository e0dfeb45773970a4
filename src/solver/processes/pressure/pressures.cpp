// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/pressure/pressures.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "math/number_text.h"
#include "solver/processes/burn/burns.h"
#include "solver/processes/clip/clips.h"
#include "solver/processes/pressure/clipped_stations.h"
#include "viscera/math/error.h"
#include "viscera/math/state_hash.h"
#include "viscera/model/body/neighbors.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

namespace {

constexpr double kRise_s = 0.2;     // from the start until the pressure is reached
constexpr double kSettle_s = 0.05;  // in which pressures follow cuts and clips: loads do not jump
constexpr double kHoleFrom = 0.05;  // of its own area: growth of a cut triangle below which it is no hole
constexpr double kMostWidened = 4;  // cross-section over that at rest that flows take into account
constexpr double kFull = 1 - 1e-4;  // share of the pressure that counts as all of it
constexpr double kMlPerM3 = 1e6, kMinute_s = 60, kTau = 6.283185307179586;

bool isSameNode(const layout::NodeBits& a, const layout::NodeBits& b) {
  return a.lo == b.lo && a.hi == b.hi;
}

std::vector<Cavities> surfacesOf(const Scene& scene, const Model& model) {
  std::vector<Cavities> out;
  for (const Body& body : model.bodies) {
    for (const BodyConfig& config : scene.bodies) {
      if (config.name != body.name || !(config.pressure.mean_pa > 0)) continue;
      try {
        out.push_back(cavitiesOf(body, config));
      } catch (const SceneError& error) {
        throw SceneError((scene.file.empty() ? "" : scene.file + ": ") + error.what());
      }
    }
  }
  return out;
}

bool losesBlood(const BleedingConfig& bleeding) {
  return bleeding.flow_ml_per_min > 0 && bleeding.fluid == Fluid::kBlood;
}

}  // namespace

Pressures::Pressures(const Scene& scene, const Model& model)
    : model_(model), tick_s_(1 / scene.solver.tick_hz), surfaces_(surfacesOf(scene, model)), loads_(model, surfaces_) {
  uint32_t first_spring = 0;
  for (uint32_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    for (const BodyConfig& config : scene.bodies) {
      if (config.name != body.name || !(config.pressure.mean_pa > 0)) continue;
      Vessel vessel;
      vessel.name = body.name;
      vessel.body = b;
      vessel.pressure = config.pressure;
      vessel.bleeds = losesBlood(config.material.bleeding) ||
                      std::any_of(config.parts.begin(), config.parts.end(),
                                  [](const PartConfig& part) { return losesBlood(part.bleeding); });
      elements_.emplace_back(model, b, first_spring);
      vessels_.push_back(std::move(vessel));
    }
    if (body.network) first_spring += static_cast<uint32_t>(body.network->springs.size());
  }
  for (size_t s = 0; s < surfaces_.size(); ++s) {
    const Cavities& surface = surfaces_[s];
    for (const Vector3d& p : surface.positions_m) {
      const std::optional<TissuePoint> by = elements_[s].nearest(p, {});
      if (!by)
        throw SceneError("body '" + vessels_[s].name +
                         "': pressure: a cavity has walls that no cell of the lattice carries; use a smaller "
                         "spacing_m");
      cells_.push_back(*by);
    }
    cells_.resize(cells_.size() + surface.rims.size());
    vessels_[s].triangles.resize(surface.lumen.stations.size());
    for (uint32_t t = 0; t < surface.triangles.size(); ++t)
      vessels_[s].triangles[surface.station_of[t]].push_back(loads_.firstTriangle(s) + t);
  }
  reset();
}

void Pressures::reset() {
  seen_.clear();
  leaks_.clear();
  open_ = 0;
  time_s_ = work_j_ = 0;
  carriers_ = cells_;
  for (uint32_t v = 0; v < cells_.size(); ++v)
    if (cells_[v].count > 0) loads_.carry(v, cells_[v]);
  loads_.gatherNodes();
  vertex_is_cut_.assign(cells_.size(), 0);
  vertex_is_gone_.assign(cells_.size(), 0);
  size_t triangles = 0;
  for (const Cavities& surface : surfaces_) triangles += surface.triangles.size();
  is_cut_.assign(triangles, 0);
  is_gone_.assign(triangles, 0);
  loads_.atRest();
  rest_area_m2_.clear();
  for (uint32_t t = 0; t < triangles; ++t) rest_area_m2_.push_back(loads_.area_m2(t).norm());
  for (size_t s = 0; s < vessels_.size(); ++s) {
    Vessel& vessel = vessels_[s];
    const size_t stations = surfaces_[s].lumen.stations.size();
    vessel.source_pa = 0;
    vessel.share.assign(stations, 1);
    vessel.narrowing.assign(stations, 1);
    vessel.at = {std::vector<double>(stations, 0), std::vector<double>(stations, 1), std::vector<uint8_t>(stations, 0)};
    vessel.flow = {std::vector<double>(stations, 0), std::vector<double>(stations, 0)};
    vessel.rest_m3.clear();
    for (size_t i = 0; i < stations; ++i) vessel.rest_m3.push_back(sector_m3(vessel, i));
    measure(vessel, s);
  }
  setPressures();
}

/// Returns whether a spring along an edge of a cell is cut.
bool Pressures::isCut(const TissuePoint& cell, const CutSprings& cuts) const {
  const Lattice& lattice = model_.bodies[cell.body].lattice;
  const uint32_t offset = model_.slotOffset(cell.body);
  for (uint32_t c = 0; c < cell.count; ++c) {
    for (uint32_t axis = 0; axis < 3; ++axis) {
      if ((c >> axis) & 1U) continue;
      const uint32_t whole = springCount(lattice.nodes[cell.slots[c] - offset], 2 * axis);
      if (whole != 0 && springCount(cuts.nodes[cell.slots[c]], 2 * axis) == 0) return true;
    }
  }
  return false;
}

/// Returns whether at least half of the nodes of a cell have lost all springs along the axes, as erased ones have.
bool Pressures::isGone(const TissuePoint& cell, const CutSprings& cuts) const {
  const auto gone = std::count_if(cell.slots.begin(), cell.slots.begin() + cell.count, [&](uint32_t slot) {
    uint32_t springs = 0;
    for (uint32_t spring = 0; spring < 6; ++spring) springs += springCount(cuts.nodes[slot], spring);
    return springs == 0;
  });
  return 2 * static_cast<uint32_t>(gone) >= cell.count;
}

void Pressures::cutsChanged(const CutSprings& cuts) {
  if (cuts.nodes.empty()) return;
  const auto isChanged = [&](const TissuePoint& point) {
    return std::any_of(point.slots.begin(), point.slots.begin() + point.count,
                       [&](uint32_t slot) { return seen_.empty() || !isSameNode(seen_[slot], cuts.nodes[slot]); });
  };
  bool any = false;
  size_t surface = 0;
  for (uint32_t v = 0; v < cells_.size(); ++v) {
    while (surface + 1 < surfaces_.size() && v >= loads_.firstVertex(surface + 1)) ++surface;
    const TissuePoint& cell = cells_[v];
    if (cell.count == 0) continue;
    if (!isChanged(cell) && !isChanged(carriers_[v])) continue;
    vertex_is_cut_[v] = static_cast<uint8_t>(isCut(cell, cuts));
    vertex_is_gone_[v] = static_cast<uint8_t>(isGone(cell, cuts));
    carriers_[v] = elements_[surface].embed(cell.rest_m, cuts).value_or(cell);
    loads_.carry(v, carriers_[v]);
    any = true;
  }
  seen_ = cuts.nodes;
  if (!any) return;
  loads_.gatherNodes();
  for (uint32_t t = 0; t < is_cut_.size(); ++t) {
    const std::array<uint32_t, 3>& corners = loads_.triangle(t);
    is_cut_[t] = std::any_of(corners.begin(), corners.end(), [&](uint32_t v) { return vertex_is_cut_[v] != 0; });
    is_gone_[t] = std::all_of(corners.begin(), corners.end(), [&](uint32_t v) { return vertex_is_gone_[v] != 0; });
  }
  setPressures();
}

/// Returns three times the volume of a station's sector around the middle of its triangles.
double Pressures::sector_m3(const Vessel& vessel, size_t station) const {
  Vector3d middle = Vector3d::Zero();
  const std::vector<uint32_t>& triangles = vessel.triangles[station];
  for (const uint32_t t : triangles) middle += loads_.position_m(loads_.triangle(t)[0]);
  if (!triangles.empty()) middle /= static_cast<double>(triangles.size());
  double out = 0;
  for (const uint32_t t : triangles) out += loads_.area_m2(t).dot(loads_.position_m(loads_.triangle(t)[0]) - middle);
  return out;
}

/// Measures the volume of a vessel, its narrowing and its holes.
void Pressures::measure(Vessel& vessel, size_t number) {
  const Cavities& surface = surfaces_[number];
  const uint32_t first = loads_.firstTriangle(number);
  const Vector3d origin = loads_.position_m(loads_.firstVertex(number));
  vessel.cavity_m3 = 0;
  double whole_m2 = 0, whole_at_rest_m2 = 0;
  for (uint32_t t = first; t < first + surface.triangles.size(); ++t) {
    const Vector3d area = loads_.area_m2(t);
    vessel.cavity_m3 += area.dot(loads_.position_m(loads_.triangle(t)[0]) - origin) / 3;
    if (is_cut_[t]) continue;
    whole_m2 += area.norm();
    whole_at_rest_m2 += rest_area_m2_[t];
  }
  const double stretch = whole_at_rest_m2 > 0 ? std::max(1.0, whole_m2 / whole_at_rest_m2) : 1;
  for (size_t i = 0; i < vessel.triangles.size(); ++i) {
    double open_m2 = 0;
    bool any = false;
    for (const uint32_t t : vessel.triangles[i]) {
      if (!is_cut_[t]) continue;
      any = true;
      open_m2 += is_gone_[t] ? rest_area_m2_[t]
                             : std::max(0.0, loads_.area_m2(t).norm() - (stretch + kHoleFrom) * rest_area_m2_[t]);
    }
    const LumenStation& station = surface.lumen.stations[i];
    // Both stumps of a vessel that is cut through are open.
    vessel.at.open_m2[i] = std::min(open_m2, 2 * station.area_m2);
    const double now = any || !(vessel.rest_m3[i] > 0) ? 1 : sector_m3(vessel, i) / vessel.rest_m3[i];
    vessel.narrowing[i] = std::clamp(now, 0.0, kMostWidened);
    vessel.at.narrowing[i] = std::max(vessel.narrowing[i], 1e-3);
  }
}

/// Closes the share of holes that burns have coagulated.
void Pressures::seal(Vessel& vessel, const HeatField& heat) const {
  for (size_t i = 0; i < vessel.triangles.size(); ++i) {
    size_t cut = 0, sealed = 0;
    for (const uint32_t t : vessel.triangles[i]) {
      const TissuePoint& cell = cells_[loads_.triangle(t)[0]];
      if (!is_cut_[t] || cell.count == 0) continue;
      ++cut;
      sealed += heat.isCoagulated(cell.slots[0]);
    }
    if (cut > 0) vessel.at.open_m2[i] *= 1 - static_cast<double>(sealed) / static_cast<double>(cut);
  }
}

/// Finds the pressures. Without holes and clips they are those of the source. Without a pressure of the source, shares
/// stay.
void Pressures::flow(Vessel& vessel, size_t number) {
  const LumenNetwork& lumen = surfaces_[number].lumen;
  const bool is_open =
      std::any_of(vessel.at.open_m2.begin(), vessel.at.open_m2.end(), [](double m2) { return m2 > 0; });
  const bool is_closed =
      std::any_of(vessel.at.is_closed.begin(), vessel.at.is_closed.end(), [](auto it) { return it; });
  std::vector<double> wanted(vessel.share.size(), 1);
  std::fill(vessel.flow.outflow_m3_per_s.begin(), vessel.flow.outflow_m3_per_s.end(), 0);
  if (!(vessel.source_pa > 0)) return;
  if (is_open || is_closed) {
    std::vector<double> guess_pa;
    for (const double share : vessel.share) guess_pa.push_back(share * vessel.source_pa);
    vessel.flow = lumen.solve(vessel.source_pa, vessel.at, guess_pa);
    for (size_t i = 0; i < wanted.size(); ++i) wanted[i] = vessel.flow.pressure_pa[i] / vessel.source_pa;
  }
  const double step = 1 - std::exp(-tick_s_ / kSettle_s);
  for (size_t i = 0; i < wanted.size(); ++i) {
    vessel.share[i] += step * (wanted[i] - vessel.share[i]);
    if (wanted[i] == 1 && vessel.share[i] > kFull) vessel.share[i] = 1;
  }
}

/// Adds the flow out of the holes of a vessel, at nodes next to them.
void Pressures::addLeaks(const Vessel& vessel) {
  if (!vessel.bleeds) return;
  for (size_t i = 0; i < vessel.flow.outflow_m3_per_s.size(); ++i) {
    if (!(vessel.flow.outflow_m3_per_s[i] > 0)) continue;
    ++open_;
    std::vector<uint32_t> slots;
    for (const uint32_t t : vessel.triangles[i])
      if (is_cut_[t] && carriers_[loads_.triangle(t)[0]].count > 0)
        slots.push_back(carriers_[loads_.triangle(t)[0]].slots[0]);
    std::sort(slots.begin(), slots.end());
    slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
    for (const uint32_t slot : slots)
      leaks_.push_back({slot, vessel.flow.outflow_m3_per_s[i] / static_cast<double>(slots.size())});
  }
}

void Pressures::setPressures() {
  for (const Vessel& vessel : vessels_) {
    for (size_t i = 0; i < vessel.triangles.size(); ++i) {
      for (const uint32_t t : vessel.triangles[i])
        loads_.setPressure(t, is_cut_[t] ? 0 : vessel.source_pa * vessel.share[i]);
    }
  }
}

void Pressures::beginTick(const ProcessTick&) {
  work_j_ = 0;
  time_s_ += tick_s_;
  const double risen = std::min(1.0, time_s_ / kRise_s);
  for (Vessel& vessel : vessels_) {
    const double pulse_pa = vessel.pressure.pulse_pa * std::sin(kTau * vessel.pressure.pulse_hz * time_s_);
    vessel.source_pa = std::max(0.0, risen * (vessel.pressure.mean_pa + pulse_pa));
  }
  setPressures();
}

bool Pressures::act(TissuePort& port, const ProcessTick&, const ProcessSubstep& substep) {
  loads_.read(port, substep.dt_s);
  work_j_ += loads_.apply(port, substep.dt_s);
  return false;
}

bool Pressures::endTick(TissuePort& port, const ProcessTick&, const TissueProcesses& all) {
  const Burns* const burns = findProcess<Burns>(all);
  const Clips* const clips = findProcess<Clips>(all);
  const std::vector<Clips::Squeezed> squeezed = clips ? clips->squeezed() : std::vector<Clips::Squeezed>();
  loads_.read(port, 0);
  leaks_.clear();
  open_ = 0;
  for (size_t s = 0; s < vessels_.size(); ++s) {
    measure(vessels_[s], s);
    vessels_[s].at.is_closed = clippedStations(surfaces_[s].lumen, vessels_[s].body, squeezed);
    if (burns) seal(vessels_[s], burns->heat());
    flow(vessels_[s], s);
    addLeaks(vessels_[s]);
  }
  return false;
}

bool Pressures::owns(uint32_t slot) const {
  return std::any_of(vessels_.begin(), vessels_.end(), [&](const Vessel& vessel) {
    const uint32_t first = model_.slotOffset(vessel.body);
    return slot >= first && slot < first + model_.bodies[vessel.body].lattice.nodes.size();
  });
}

void Pressures::persist(Archive& archive) {
  archive.section("pressures");
  if (archive.reads()) reset();
  archive.value(time_s_);
  for (Vessel& vessel : vessels_) {
    archive.values(vessel.share);
    if (!archive.reads()) continue;
    const auto is_share = [](double share) { return share >= 0 && share <= 1; };
    archive.require(std::all_of(vessel.share.begin(), vessel.share.end(), is_share), "a share is not within 0 .. 1");
  }
}

bool Pressures::addTo(StateHash& hash) const {
  hash.add(static_cast<float>(time_s_));
  for (const Vessel& vessel : vessels_)
    for (const double share : vessel.share) hash.add(static_cast<float>(share));
  return true;
}

FactGroup Pressures::facts() const {
  std::vector<Fact::Facts> on;
  double cavity_ml = 0;
  for (const Vessel& vessel : vessels_) {
    const auto [least, most] = std::minmax_element(vessel.share.begin(), vessel.share.end());
    const auto narrowest = std::min_element(vessel.narrowing.begin(), vessel.narrowing.end());
    double flow_m3_per_s = 0, open_m2 = 0;
    for (const double m3_per_s : vessel.flow.outflow_m3_per_s) flow_m3_per_s += m3_per_s;
    for (const double m2 : vessel.at.open_m2) open_m2 += m2;
    on.push_back({{"body", vessel.name},
                  {"pressure_pa", *most * vessel.source_pa},
                  {"least_pressure_pa", *least * vessel.source_pa},
                  {"cavity_ml", kMlPerM3 * vessel.cavity_m3},
                  {"narrowest", *narrowest},
                  {"open_m2", open_m2},
                  {"flow_ml_per_min", kMlPerM3 * kMinute_s * flow_m3_per_s}});
    cavity_ml += kMlPerM3 * vessel.cavity_m3;
  }
  FactGroup out{"pressures", numberText(cavity_ml, 3) + " ml under pressure"};
  out.facts = {{"on", std::move(on)}};
  return out;
}

}  // namespace viscera
