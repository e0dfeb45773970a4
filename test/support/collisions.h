// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "solver/cpu/steps/environment.h"
#include "solver/gpu/contact/environment_pass.h"
#include "solver/reference/collision.h"
#include "solver/tissue/substeps.h"
#include "support/backends.h"

namespace viscera::test {

/// Returns the pairs that a backend's search finds in a state. @param backend  "gpu", which needs a context, or another
inline std::vector<CollisionPair> pairsOf(const std::string& backend, const Model& model, const Scene& scene,
                                          const HostState& state, uint32_t group_size = layout::kGroupSize) {
  const double dt_s = safeTimeStep(model);
  const std::vector<layout::BodyParams> params = bodyParams(model, dt_s);
  if (backend == "gpu") {
    const FeatureSet features = featuresOf(model, scene, 1, group_size);
    LatticeBuffers buffers(model, params, features);
    buffers.state.displacement[buffers.state.current].write(state.displacement_m);
    buffers.store.nodes.write(state.nodes);
    const EnvironmentPass pass(model, scene, features, buffers);
    return pass.findPairs(buffers);
  }
  CpuLattice lattice(model, params, featuresOf(model, scene, 1));
  lattice.write(state);
  const Serial serial;
  CpuEnvironment environment(model, scene, lattice, serial);
  return environment.findPairs(lattice);
}

}  // namespace viscera::test
