// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/steps/pd_pass.h"

#include <cstring>

#include "layout/bindings.h"

namespace viscera {

PdPass::PdPass(const FeatureSet& features, const LatticeBuffers& buffers, const PdOptions& options,
               const NodePairs* pairs)
    : implicit_(features, buffers, options.iterations, pairs), options_(options), group_size_(features.group_size) {
  for (int tools = 0; tools < (features.tools ? 2 : 1); ++tools) {
    sweep_[tools] = gpu::Program::compute("pd.comp", ImplicitSubstep::defines(features, tools != 0));
  }
  if (options_.accelerated && options_.spectral_radius == 0) findRates(features, buffers);
}

void PdPass::findRates(const FeatureSet& features, const LatticeBuffers& buffers) {
  std::vector<std::string> defines = features.defines();
  defines.insert(defines.end(), {"INCREMENT", "RATE"});
  const gpu::Program rate = gpu::Program::compute("pd.comp", defines);
  gpu::Buffer<float> rates(2);
  buffers.bind();
  rates.bindStorage(layout::kBindGuard);
  rate.use();
  rate.set("active_count", static_cast<uint32_t>(buffers.store.active_count));
  gpu::Program::dispatch(buffers.store.active_count, group_size_);
  const std::vector<float> found = rates.read();
  stiffness_rate_per_s2_ = found[0];
  damping_rate_per_s_ = found[1];
}

double PdPass::spectralRadius(double dt_s) const {
  if (options_.spectral_radius > 0) return options_.spectral_radius;
  return jacobiRadius(stiffness_rate_per_s2_, damping_rate_per_s_, dt_s);
}

void PdPass::run(LatticeBuffers& buffers, const Substep& step) {
  implicit_.begin(buffers, step);
  const gpu::Program& sweep = sweep_[step.tools];
  const double rho = spectralRadius(step.dt_s);
  double weight = 1;
  for (int iteration = 0; iteration < options_.iterations; ++iteration) {
    implicit_.updateVolumes(buffers, step, iteration);
    weight = options_.accelerated ? chebyshevWeight(iteration, weight, rho) : 1;
    sweep.use();
    implicit_.tell(sweep, buffers, step);
    sweep.set("iteration", static_cast<uint32_t>(iteration));
    sweep.set("omega", static_cast<float>(weight));
    gpu::Program::dispatch(buffers.store.active_count, group_size_);
    gpu::Program::storageBarrier();
    implicit_.swap();
    implicit_.movePairs(buffers, step, iteration);
  }
  implicit_.end(buffers, step);
}

std::vector<float> PdPass::changes() const {
  const std::vector<uint32_t> words = implicit_.guard.read();
  std::vector<float> out(static_cast<size_t>(options_.iterations));
  for (size_t n = 0; n < out.size(); ++n) std::memcpy(&out[n], &words[1 + 2 * n], sizeof out[n]);
  return out;
}

bool PdPass::gaveUp() const {
  return implicit_.guard.read().back() != 0;
}

}  // namespace viscera
