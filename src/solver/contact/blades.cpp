// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/contact/blades.h"

#include "math/archive.h"
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

Blades::Blades(const Model& model, const std::vector<StylusConfig>& styluses) {
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    if (resistsBlades(model.bodies[b])) cuts_.emplace_back(model, b, styluses);
  }
}

void Blades::act(BladeTarget& target, const ToolMotions& motions, const layout::ToolMotion* substep, double dt_s) {
  for (Cut& cut : cuts_) {
    target.selectBody(cut.body);
    for (uint32_t s = 0; s < layout::kMaxStyluses; ++s) {
      const bool cuts = kindOf(motions[s].mode).does(kCuts);
      if (cuts)
        cut.edges[s].act(target, s, substep[s], dt_s);
      else
        cut.edges[s].leave(target);
      if (cut.points[s] && cuts) cut.edges[s].addStored(cut.points[s]->act(target, s, substep[s], dt_s));
      if (cut.points[s] && !cuts) cut.points[s]->leave();
    }
  }
}

bool Blades::leave(BladeTarget& target) {
  bool any = false;
  for (Cut& cut : cuts_) {
    target.selectBody(cut.body);
    for (BladeEdge& edge : cut.edges) any |= edge.leave(target);
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
