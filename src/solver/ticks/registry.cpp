// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/ticks/registry.h"

#include <algorithm>

#include "model/fracture/toughness.h"
#include "model/scene/structure_rules.h"
#include "model/scene/tool_kinds.h"
#include "solver/processes/attach/attachments.h"
#include "solver/processes/blade/blades.h"
#include "solver/processes/bleed/bleeding.h"
#include "solver/processes/burn/burns.h"
#include "solver/processes/clip/clips.h"
#include "solver/processes/pressure/pressures.h"
#include "solver/processes/suture/suture_bodies.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

namespace {

struct Setup {
  const Scene& scene;
  const Model& model;
  bool tools;
};

/// Returns [bodies] whether they are tubes.
std::vector<uint8_t> hollowBodies(const Setup& setup) {
  std::vector<uint8_t> out;
  for (const Body& body : setup.model.bodies) {
    const auto& all = setup.scene.bodies;
    out.push_back(std::any_of(all.begin(), all.end(), [&](const BodyConfig& config) {
      return config.name == body.name && config.source == TissueSource::kTube;
    }));
  }
  return out;
}

struct Kind {
  bool (*has)(const Setup&);  ///< whether a scene has it
  ProcessActs acts;
  std::unique_ptr<TissueProcess> (*make)(const Setup&);
};

std::unique_ptr<TissueProcess> bleedingOf(const Setup& setup, Fluid fluid) {
  return std::make_unique<Bleeding>(setup.model, setup.scene.styluses, setup.scene.environment.gravity_m_per_s2,
                                    1 / setup.scene.solver.tick_hz, fluid);
}

/// One row per process, in the order in which they act. A process that reads another one's results of the tick
/// (TissueProcess::endTick) need not follow it: all have acted by then. Bleeding must follow Pressures, as
/// endTick() of these finds the leaks.
constexpr Kind kKinds[] = {
    {[](const Setup& setup) { return setup.tools && resistsBlades(setup.scene); }, ProcessActs::kWithTools,
     [](const Setup& setup) -> std::unique_ptr<TissueProcess> {
       return std::make_unique<Blades>(setup.model, setup.scene.styluses);
     }},
    {[](const Setup& setup) { return !setup.scene.attachments.empty(); }, ProcessActs::kAlways,
     [](const Setup& setup) -> std::unique_ptr<TissueProcess> {
       return std::make_unique<Attachments>(setup.scene, setup.model);
     }},
    {[](const Setup& setup) { return hasPressure(setup.scene.bodies); }, ProcessActs::kAlways,
     [](const Setup& setup) -> std::unique_ptr<TissueProcess> {
       return std::make_unique<Pressures>(setup.scene, setup.model);
     }},
    {[](const Setup& setup) { return !setup.scene.sutures.empty(); }, ProcessActs::kAlways,
     [](const Setup& setup) -> std::unique_ptr<TissueProcess> {
       return std::make_unique<SutureBodies>(setup.scene, &setup.model);
     }},
    {[](const Setup& setup) { return mayClip(setup.scene.styluses); }, ProcessActs::kAlways,
     [](const Setup& setup) -> std::unique_ptr<TissueProcess> {
       return std::make_unique<Clips>(setup.scene.styluses, setup.model, hollowBodies(setup));
     }},
    {[](const Setup& setup) { return mayBleed(setup.model.bodies, Fluid::kBlood); }, ProcessActs::kWithTools,
     [](const Setup& setup) { return bleedingOf(setup, Fluid::kBlood); }},
    {[](const Setup& setup) { return mayBleed(setup.model.bodies, Fluid::kBile); }, ProcessActs::kWithTools,
     [](const Setup& setup) { return bleedingOf(setup, Fluid::kBile); }},
    {[](const Setup& setup) { return mayBurn(setup.scene.styluses); }, ProcessActs::kAlways,
     [](const Setup& setup) -> std::unique_ptr<TissueProcess> {
       return std::make_unique<Burns>(setup.scene, setup.model);
     }},
};

}  // namespace

TissueProcesses makeProcesses(const Scene& scene, const Model& model, bool tools) {
  const Setup setup{scene, model, tools};
  TissueProcesses out;
  for (const Kind& kind : kKinds) {
    if (kind.has(setup)) out.push_back(kind.make(setup));
  }
  return out;
}

ProcessActs processesAct(const Scene& scene, const Model& model, bool tools) {
  const Setup setup{scene, model, tools};
  ProcessActs out = ProcessActs::kNever;
  for (const Kind& kind : kKinds) {
    if (kind.has(setup)) out = std::max(out, kind.acts);
  }
  return out;
}

}  // namespace viscera
