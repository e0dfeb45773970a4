// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>

#include "model/body/network_body.h"
#include "model/body/network_builder.h"
#include "model/body/spacing_search.h"
#include "model/scene/key_location.h"
#include "model/scene/structure_rules.h"
#include "model/shape/organ/tissue.h"
#include "viscera/math/error.h"
#include "viscera/model/body/spacing_choice.h"

namespace viscera {
namespace {

Body bareBody(const BodyConfig& config, const Tissue& tissue, double spacing_m) {
  if (isNetwork(config.structure)) return networkBody(config, tissue, {});
  Body body = plainBody(config);
  const Filling filling =
      config.target_nodes > 0 ? fillToNodes(tissue, config.target_nodes, {}) : tissue.fill(spacing_m, {});
  body.lattice = buildLattice(filling.solid, config.material.weights);
  if (config.structure == Structure::kExplicit) body.network = latticeNetwork(body, config.bending_ratio);
  return body;
}

/// Runs `act`, and adds the body's name to what it throws.
template <class Act>
auto naming(const BodyConfig& config, Act act) {
  try {
    return act();
  } catch (const LatticeError& error) {
    throw LatticeError("body '" + config.name + "': " + error.what());
  }
}

}  // namespace

UndividedBodies::UndividedBodies(const Scene& scene) {
  const std::vector<size_t> chosen = autoBodies(scene);
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    const bool is_auto = std::find(chosen.begin(), chosen.end(), b) != chosen.end();
    BodyConfig config = scene.bodies[b];
    config.material.law = lawOf(config, scene.solver.integrator);
    (is_auto ? auto_ : others_).push_back({config, withLocation(scene, b, [&] {
                                             return makeTissue(config, scene.folder);
                                           })});
  }
}

UndividedBodies::~UndividedBodies() = default;

size_t UndividedBodies::nodes(double spacing_m) const {
  size_t sum = 0;
  for (const Draft& draft : auto_) {
    sum += naming(draft.config, [&] { return countNodes(draft.tissue->fill(spacing_m, {}).solid); });
  }
  return sum;
}

double UndividedBodies::spacingOf(size_t wanted) const {
  constexpr double kNear = 0.2;
  constexpr int kMostPasses = 8;
  double volume_m3 = 0, smallest_m = std::numeric_limits<double>::infinity();
  for (const Draft& draft : auto_) {
    const Vector3d size_m = draft.tissue->bounds().sizes();
    volume_m3 += size_m.prod();
    smallest_m = std::min(smallest_m, size_m.maxCoeff());
  }
  double spacing_m = std::min(smallest_m, std::cbrt(volume_m3 / static_cast<double>(wanted)));
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const double ratio = static_cast<double>(nodes(spacing_m)) / static_cast<double>(wanted);
    if (std::abs(ratio - 1) < kNear) break;
    spacing_m = std::min(smallest_m, spacing_m * std::cbrt(ratio));
  }
  return spacing_m;
}

double UndividedBodies::wholeEdge_m() const {
  if (auto_.empty()) return 0;
  const BodyConfig& first = auto_[0].config;
  return first.source == TissueSource::kBox && first.rotation_deg.isZero() ? first.box_size_m.maxCoeff() : 0;
}

double UndividedBodies::thinnestWall_m() const {
  double thinnest_m = std::numeric_limits<double>::infinity();
  for (const Draft& draft : auto_) {
    for (const Wall& wall : draft.tissue->walls()) thinnest_m = std::min(thinnest_m, wall.thickness_m);
  }
  return thinnest_m;
}

Model UndividedBodies::lattices(double spacing_m) const {
  Model model;
  for (const Draft& draft : auto_) {
    model.bodies.push_back(naming(draft.config, [&] { return bareBody(draft.config, *draft.tissue, spacing_m); }));
  }
  return model;
}

Model UndividedBodies::others() const {
  Model model;
  for (const Draft& draft : others_) {
    model.bodies.push_back(
        naming(draft.config, [&] { return bareBody(draft.config, *draft.tissue, draft.config.spacing_m); }));
  }
  return model;
}

}  // namespace viscera
