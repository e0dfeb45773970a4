// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/blade/blades.h"

#include "math/archive.h"
#include "math/number_text.h"
#include "model/fracture/toughness.h"
#include "model/scene/tool_kinds.h"

namespace viscera {

namespace {

void add(const BladeWork& one, BladeWork& out) {
  out.area_m2 += one.area_m2;
  out.work_j += one.work_j;
  out.parting_j += one.parting_j;
  out.limit_n += one.limit_n;
}

}  // namespace

Blades::Cut::Cut(const Model& model, size_t body, const std::vector<StylusConfig>& styluses)
    : body(body), tissue(std::make_unique<RestTissue>(model, body)) {
  for (uint32_t s = 0; s < layout::kMaxStyluses; ++s) {
    const CutConfig& cut = s < styluses.size() ? styluses[s].cut : CutConfig{};
    edges.emplace_back(*tissue, cut.friction_n_per_m);
    points.emplace_back();
    if (cut.point_width_m > 0) points.back().emplace(*tissue, cut.point_width_m);
  }
}

Blades::Blades(const Model& model, const std::vector<StylusConfig>& styluses) : styluses_(styluses.size()) {
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    if (resistsBlades(model.bodies[b])) cuts_.emplace_back(model, b, styluses);
  }
}

bool Blades::act(TissuePort& port, const ProcessTick& tick, const ProcessSubstep& substep) {
  if (!tick.cuts || tick.recovering) return false;
  for (Cut& cut : cuts_) {
    port.selectBody(cut.body);
    for (uint32_t s = 0; s < layout::kMaxStyluses; ++s) {
      const bool cuts = kindOf(tick.motions[s].mode).does(kCuts);
      if (cuts)
        cut.edges[s].act(port, s, substep.tools[s], substep.dt_s);
      else
        cut.edges[s].leave(port);
      if (cut.points[s] && cuts) cut.edges[s].addStored(cut.points[s]->act(port, s, substep.tools[s], substep.dt_s));
      if (cut.points[s] && !cuts) cut.points[s]->leave();
    }
  }
  return true;
}

bool Blades::endTick(TissuePort& port, const ProcessTick& tick, const TissueProcesses&) {
  return (!tick.cuts || tick.recovering) && restart(port);
}

/// Ends the contact of all blades. @returns  whether there were any, which may have cut
bool Blades::restart(TissuePort& port) {
  bool any = false;
  for (Cut& cut : cuts_) {
    port.selectBody(cut.body);
    for (BladeEdge& edge : cut.edges) any |= edge.leave(port);
    for (std::optional<BladePoint>& point : cut.points) {
      if (point) point->leave();
    }
  }
  return any;
}

void Blades::reset() {
  for (Cut& cut : cuts_) {
    cut.tissue->reset();
    for (BladeEdge& edge : cut.edges) edge.reset();
    for (std::optional<BladePoint>& point : cut.points) {
      if (point) point->reset();
    }
  }
}

BladeWork Blades::done(uint32_t stylus) const {
  BladeWork out;
  for (const Cut& cut : cuts_) {
    add(cut.edges[stylus].done(), out);
    if (cut.points[stylus]) add(cut.points[stylus]->done(), out);
  }
  return out;
}

FactGroup Blades::facts() const {
  FactGroup out{"blades", {}};
  std::vector<Fact::Facts> styluses;
  double area_m2 = 0;
  for (uint32_t s = 0; s < styluses_; ++s) {
    const BladeWork work = done(s);
    area_m2 += work.area_m2;
    styluses.push_back(
        {{"area_m2", work.area_m2}, {"work_j", work.work_j}, {"parting_j", work.parting_j}, {"limit_n", work.limit_n}});
  }
  out.summary = numberText(1e6 * area_m2) + " mm2 cut";
  out.facts = {{"styluses", std::move(styluses)}};
  return out;
}

BladeWork bladeWork(const Solver& solver, uint32_t stylus) {
  const Blades* const blades = findProcess<Blades>(solver);
  return blades ? blades->done(stylus) : BladeWork{};
}

void Blades::persist(Archive& archive) {
  archive.section("blades");
  for (Cut& cut : cuts_) {
    cut.tissue->persist(archive);
    for (BladeEdge& edge : cut.edges) edge.persist(archive);
    for (std::optional<BladePoint>& point : cut.points) {
      if (point) point->persist(archive);
    }
  }
}

}  // namespace viscera
