// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scene/feature_rules.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "math/number_text.h"
#include "model/scene/integrators.h"
#include "model/scene/structure_rules.h"
#include "model/scene/tool_kinds.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

namespace {

/// Set of values of an enum, one bit each.
using Set = unsigned;
template <class Enum>
constexpr Set in(Enum value) {
  return 1U << static_cast<unsigned>(value);
}
template <class Enum, class... More>
constexpr Set in(Enum value, More... more) {
  return in(value) | in(more...);
}
constexpr Set kAll = ~0U;

template <class Enum>
using Names = std::vector<std::pair<Enum, const char*>>;

const Names<Structure> kStructures = {
    {Structure::kLattice, "lattice"}, {Structure::kExplicit, "explicit"}, {Structure::kSurface, "surface"}};
const Names<Backend> kBackends = {{Backend::kAuto, "auto"}, {Backend::kCpu, "cpu"}, {Backend::kGpu, "gpu"}};

/// Returns the names of the integrators that a scene can choose.
const Names<Integrator>& sceneIntegrators() {
  static const Names<Integrator> kNames = [] {
    Names<Integrator> out;
    for (const IntegratorTraits& traits : kIntegrators)
      if (traits.about) out.emplace_back(traits.integrator, traits.name);
    return out;
  }();
  return kNames;
}

struct Rule {
  const char* key;                      ///< key as in a scene
  bool (*body_has)(const BodyConfig&);  ///< null: the key belongs to the scene
  bool (*scene_has)(const Scene&);      ///< null: the key belongs to bodies
  Set structures = kAll, integrators = kAll, backends = kAll;
  bool reference = true;
  const char* reason = "";  ///< reason for a person, appended to the error
};

constexpr Set kCells = in(Structure::kLattice, Structure::kExplicit);

/// Each key has one row; a new feature adds its own.
constexpr Rule kRules[] = {
    {"source: sheet", [](const BodyConfig& b) { return b.source == TissueSource::kSheet; }, nullptr,
     in(Structure::kSurface), kAll, kAll, true, "a sheet has no volume"},
    {"source: tube", [](const BodyConfig& b) { return b.source == TissueSource::kTube; }, nullptr, kCells, kAll, kAll,
     true, "a tube has a wall of tissue"},
    {"pressure.mean_pa above 0", [](const BodyConfig& b) { return b.pressure.mean_pa > 0; }, nullptr,
     in(Structure::kLattice), in(Integrator::kLeapfrog), in(Backend::kAuto, Backend::kCpu), false,
     "it acts on nodes of a lattice in every substep, for which a GPU would have to wait"},
    {"fill: enclosed", [](const BodyConfig& b) { return b.fill == Fill::kEnclosed; }, nullptr, kCells},
    {"parts", [](const BodyConfig& b) { return !b.parts.empty(); }, nullptr, kCells},
    {"layers[].toughness_j_per_m2 above 0",
     [](const BodyConfig& b) {
       return std::any_of(b.layers.begin(), b.layers.end(), [](const auto& it) { return it.toughness_j_per_m2 > 0; });
     },
     nullptr, kCells, in(Integrator::kLeapfrog), kAll, true, "a sheet has no depth"},
    {"spacing_m: auto without target_nodes", [](const BodyConfig& b) { return b.auto_spacing && b.target_nodes == 0; },
     nullptr, kCells},
    {"skin other than auto", [](const BodyConfig& b) { return b.skin != SkinSource::kAuto; }, nullptr, kCells, kAll,
     kAll, true, "the skin of a sheet is its surface"},
    {"skin_faces above 0", [](const BodyConfig& b) { return b.skin_faces > 0; }, nullptr, kCells, kAll, kAll, true,
     "the skin of a sheet is its surface"},
    {"detail_mesh", [](const BodyConfig& b) { return !b.detail_mesh.empty(); }, nullptr, kCells, kAll, kAll, true,
     "the skin of a sheet is its surface"},
    {"mapping other than auto", [](const BodyConfig& b) { return b.mapping != Mapping::kAuto; }, nullptr, kCells, kAll,
     kAll, true, "each vertex of a sheet's skin is already one of its nodes"},
    {"bending_ratio above 0", [](const BodyConfig& b) { return b.bending_ratio > 0; }, nullptr,
     in(Structure::kExplicit, Structure::kSurface)},
    {"poisson_ratio other than 0.25, of the material or a part,", [](const BodyConfig& b) { return hasOwnPoisson(b); },
     nullptr, in(Structure::kLattice), in(Integrator::kLeapfrog), kAll, true,
     "only material.law: neo_hookean has a free ratio; springs have 1/4, those of a sheet 1/3"},
    {"material.weights: paper", [](const BodyConfig& b) { return b.material.weights != Weights::kCell; }, nullptr,
     kCells},
    {"material.prestress", [](const BodyConfig& b) { return isPrestressed(b); }, nullptr,
     in(Structure::kLattice, Structure::kSurface), kAll, kAll, true,
     "only material.law: neo_hookean and surfaces have a prestress"},
    {"cut.toughness_j_per_m2 above 0, of the material or a part,",
     [](const BodyConfig& b) {
       const auto resists = [](const PartConfig& part) { return part.cut.toughness_j_per_m2 > 0; };
       return b.material.cut.toughness_j_per_m2 > 0 || std::any_of(b.parts.begin(), b.parts.end(), resists);
     },
     nullptr, kAll, in(Integrator::kLeapfrog)},
    {"material.tear.toughness_j_per_m2 above 0",
     [](const BodyConfig& b) { return b.material.tear.toughness_j_per_m2 > 0; }, nullptr, in(Structure::kLattice),
     in(Integrator::kLeapfrog), in(Backend::kAuto, Backend::kCpu), false},
    {"a stylus with mode cautery", nullptr, [](const Scene& scene) { return mayBurn(scene.styluses); }, kAll,
     in(Integrator::kLeapfrog)},
    {"attachments", nullptr, [](const Scene& scene) { return !scene.attachments.empty(); }, in(Structure::kLattice),
     in(Integrator::kLeapfrog)},
    {"material.stiffening above 0", [](const BodyConfig& b) { return b.material.stiffening > 0; }, nullptr,
     in(Structure::kLattice), in(Integrator::kLeapfrog), kAll, true, "springs do not stiffen"},
    {"material.walls: rows", [](const BodyConfig& b) { return b.material.walls == Walls::kRows; }, nullptr,
     in(Structure::kLattice), in(Integrator::kLeapfrog), kAll, true, "springs have no second derivatives"},
    {"material.law: neo_hookean", [](const BodyConfig& b) { return b.material.law == Law::kNeoHookean; }, nullptr,
     in(Structure::kLattice), in(Integrator::kLeapfrog)},
};

template <class Enum>
std::string namesIn(Set set, const Names<Enum>& all, const char* between) {
  std::string out;
  for (const auto& [value, name] : all) {
    if (set & in(value)) out += (out.empty() ? "" : between) + std::string(name);
  }
  return out;
}

/// Returns "KEY needs WHAT a or b, not c: reason"; empty where the value is in the set.
template <class Enum>
std::string faultOf(const Rule& rule, const char* what, Set set, Enum value, const Names<Enum>& all) {
  if (set & in(value)) return "";
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.first == value; });
  return std::string(rule.key) + " needs " + what + " " + namesIn(set, all, " or ") + ", not " +
         (found == all.end() ? "another one" : found->second) + (*rule.reason ? ": " : "") + rule.reason;
}

std::string solverFault(const Rule& rule, const SolverConfig& solver) {
  const std::string fault = faultOf(rule, "solver.integrator", rule.integrators, solver.integrator, sceneIntegrators());
  return fault.empty() ? faultOf(rule, "solver.backend", rule.backends, solver.backend, kBackends) : fault;
}

/// Calls visit with every rule that a scene uses, and the prefix of the path to its key.
template <class Visit>
void forEachUsed(const Scene& scene, const Visit& visit) {
  for (const Rule& rule : kRules) {
    if (rule.scene_has && rule.scene_has(scene)) visit(rule, std::string());
    for (const BodyConfig& body : scene.bodies) {
      if (rule.body_has && rule.body_has(body)) visit(rule, "body '" + body.name + "': ");
    }
  }
}

/// Returns what is wrong with the pressure of a body.
std::string pressureFault(const BodyConfig& body) {
  const PressureConfig& pressure = body.pressure;
  if (!(pressure.mean_pa > 0)) return "";
  if (pressure.pulse_pa > pressure.mean_pa) {
    return "pressure.pulse_pa must be within 0 .. pressure.mean_pa, " + numberText(pressure.mean_pa, 6) +
           " Pa; found " + numberText(pressure.pulse_pa, 6) + " Pa";
  }
  const auto isBile = [](const BleedingConfig& it) { return it.flow_ml_per_min > 0 && it.fluid == Fluid::kBile; };
  if (isBile(body.material.bleeding) ||
      std::any_of(body.parts.begin(), body.parts.end(), [&](const PartConfig& part) { return isBile(part.bleeding); }))
    return "pressure.mean_pa above 0 needs bleeding.fluid blood, of the material and of all parts; found bile";
  return "";
}

}  // namespace

std::string featureFault(const BodyConfig& body) {
  for (const Rule& rule : kRules) {
    if (!rule.body_has || !rule.body_has(body)) continue;
    std::string fault = faultOf(rule, "structure", rule.structures, body.structure, kStructures);
    if (!fault.empty()) return fault;
  }
  return pressureFault(body);
}

void requireFeatures(const Scene& scene) {
  for (const BodyConfig& body : scene.bodies) {
    const std::string fault = featureFault(body);
    if (!fault.empty()) throw SceneError("body '" + body.name + "': " + fault);
  }
  forEachUsed(scene, [&](const Rule& rule, const std::string& where) {
    const std::string fault = solverFault(rule, scene.solver);
    if (!fault.empty()) throw SceneError(where + fault);
  });
}

void requireReferenceFeatures(const Scene& scene) {
  forEachUsed(scene, [](const Rule& rule, const std::string& where) {
    if (!rule.reference) throw SceneError(where + "the float64 reference does not support " + rule.key);
  });
}

std::string featuresTable() {
  const auto cell = [](Set set, const std::string& names) { return set == kAll ? std::string("any") : names; };
  std::string out = "| feature | structure | integrator | backend | reference |\n|---|---|---|---|---|\n";
  for (const Rule& rule : kRules) {
    out += std::string("| ") + rule.key + " | " + cell(rule.structures, namesIn(rule.structures, kStructures, ", ")) +
           " | " + cell(rule.integrators, namesIn(rule.integrators, sceneIntegrators(), ", ")) + " | " +
           cell(rule.backends, namesIn(rule.backends, kBackends, ", ")) + " | " + (rule.reference ? "yes" : "no") +
           " |\n";
  }
  return out;
}

}  // namespace viscera
