// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <random>

#include "bench/gw/gw_parts.h"
#include "model/body/network_builder.h"
#include "model/shape/mesh/plain_meshes.h"
#include "solver/cpu/steps/environment.h"
#include "solver/reference/collision.h"
#include "viscera/model/scene/scene.h"

namespace viscera::bench {

namespace {

constexpr double kSpacing_m = 0.01;
constexpr double kTolerance_m = 5e-7;  // float32 rounding at 1 m: pairs this close to the limit may or may not count

/// Returns a cloth with arbitrary node positions: the search does not depend on its springs.
Model clothModel(int edge) {
  Body cloth;
  cloth.name = "cloth";
  adoptNetwork(membraneNetwork(sheetMesh(edge, edge, kSpacing_m), cloth.material, 1e-3), cloth);
  Model model;
  model.bodies.push_back(std::move(cloth));
  return model;
}

/// Returns nodes at random positions in a cube, displaced by the same distance in random directions.
/// @param before  receives the positions before
HostState cloud(const Model& model, double cube_m, double offset_m, std::mt19937& random, HostState* before = nullptr) {
  std::uniform_real_distribution<double> position(-0.5 * cube_m, 0.5 * cube_m);
  std::normal_distribution<double> any;
  const Body& body = model.bodies[0];
  HostState state;
  state.nodes = body.lattice.nodes;
  state.displacement_m.resize(state.nodes.size());
  state.velocity_m_per_s.resize(state.nodes.size());
  state.spring_cut.resize(body.network->springs.size());
  if (before) *before = state;
  for (const uint32_t slot : body.lattice.active_slots) {
    const Vector3d from = Vector3d(position(random), position(random), position(random)) - restPosition(body, slot);
    const Vector3d to = from + offset_m * Vector3d(any(random), any(random), any(random)).normalized();
    const Vector3f f = from.cast<float>(), t = to.cast<float>();
    if (before) before->displacement_m[slot] = {f.x(), f.y(), f.z(), 0};
    state.displacement_m[slot] = {t.x(), t.y(), t.z(), 0};
  }
  return state;
}

Scene collidingScene() {
  Scene scene;
  scene.collision.enabled = true;
  return scene;
}

std::vector<CollisionPair> found(const Model& model, const Scene& scene, const HostState& state) {
  CpuLattice lattice(model, bodyParams(model, safeTimeStep(model)), featuresOf(model, {}, 1));
  lattice.write(state);
  const Serial serial;
  return CpuEnvironment(model, scene, lattice, serial).findPairs(lattice);
}

/// Returns the pairs that touch at some time while all nodes move linearly from one state to the other.
std::vector<ReferencePair> pairsInStep(const Model& model, const Scene& scene, const HostState& from,
                                       const HostState& to, double offset_m) {
  const Body& body = model.bodies[0];
  const auto at = [&body](const HostState& state, uint32_t slot) {
    const layout::vec4& u = state.displacement_m[slot];
    return Vector3d(restPosition(body, slot) + Vector3d(u.x, u.y, u.z));
  };
  std::vector<ReferencePair> out;
  for (ReferencePair pair : referencePairs(model, scene, from, 2 * offset_m)) {
    const uint32_t a = pair.slots[0], b = pair.slots[1];
    const Vector3d apart = at(from, a) - at(from, b), change = at(to, a) - at(to, b) - apart;
    const double nearest = std::clamp(-apart.dot(change) / change.squaredNorm(), 0.0, 1.0);
    pair.depth_m += apart.norm() - (apart + nearest * change).norm();
    if (pair.depth_m > 0) out.push_back(pair);
  }
  return out;
}

void reportDensity(Report& report, const Model& model) {
  Table table("Recall by density: share of touching pairs that are found",
              {{"contacts per node"}, {"pairs"}, {"recall"}});
  std::mt19937 random(1);
  const double nodes = static_cast<double>(model.activeNodes());
  double worst = 1;
  for (const double density : {0.05, 0.2, 0.5, 1.0, 2.0, 5.0}) {  // nodes per cube of the contact distance
    const HostState state = cloud(model, kSpacing_m * std::cbrt(nodes / density), 0, random);
    const Scene scene = collidingScene();
    const auto truth = referencePairs(model, scene, state, 2 * kTolerance_m);
    const double share = recallOf(found(model, scene, state), truth, kTolerance_m).share();
    table.add({2 * static_cast<double>(truth.size()) / nodes, static_cast<double>(truth.size()), share});
    worst = std::min(worst, share);
  }
  report.add(table, "recall_density");
  report.checkAtLeast("recall of the search, all densities", worst, 1);
}

void reportStep(Report& report, const Model& model) {
  Table table("Recall by dt: share of the pairs that touch during a substep and are found at its end",
              {{"way of a node", "cells"}, {"pairs"}, {"recall"}});
  std::mt19937 random(2);
  const double nodes = static_cast<double>(model.activeNodes());
  for (const double offset : {0.01, 0.05, 0.1, 0.25, 0.5, 1.0, 2.0}) {
    HostState before;
    const HostState state = cloud(model, kSpacing_m * std::cbrt(nodes / 0.2), offset * kSpacing_m, random, &before);
    const Scene scene = collidingScene();
    const auto truth = pairsInStep(model, scene, before, state, offset * kSpacing_m);
    const double share = recallOf(found(model, scene, state), truth, kTolerance_m).share();
    table.add({offset, static_cast<double>(truth.size()), share});
  }
  report.add(table, "recall_step");
}

}  // namespace

void collisionRecall(Report& report, bool brief) {
  report.stage("recall of the collision search");
  const Model model = clothModel(brief ? 24 : 48);
  reportDensity(report, model);
  reportStep(report, model);
  report.note(
      "A pair that only grazes during a substep is found at neither end of it. Nodes still do not pass through "
      "sheets below half a cell per substep, because a sheet has many nodes (docs/physics.md 8).");
}

}  // namespace viscera::bench
