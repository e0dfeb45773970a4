// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/implicit_substep.h"

#include "gpu/stage_clock.h"
#include "layout/bindings.h"
#include "solver/gpu/sum_tree.h"

namespace viscera {

namespace {

constexpr size_t kEnergiesPerNode = 2;  // shares.glsl: ENERGIES_PER_NODE

}  // namespace

std::vector<std::string> ImplicitSubstep::defines(const FeatureSet& features, const char* more) {
  std::vector<std::string> out = features.defines();
  out.push_back("INCREMENT");
  if (more) out.push_back(more);
  return out;
}

ImplicitSubstep::ImplicitSubstep(const FeatureSet& features, const LatticeBuffers& buffers, int iterations,
                                 int iterates)
    : guard(1 + 2 * static_cast<size_t>(iterations)),
      energies_(kEnergiesPerNode * (buffers.store.active_count + sumTreeSize(buffers.store.active_count)), "energies"),
      group_size_(features.group_size) {
  const auto stage = [&](const char* name, bool tools = false) {
    return gpu::Program::compute(name, defines(features, tools ? "TOOLS" : nullptr));
  };
  begin_ = stage("implicit_begin.comp");
  guess_ = stage("implicit_guess.comp");
  fold_ = stage("implicit_fold.comp");
  scale_ = stage("implicit_scale.comp");
  end_ = stage("implicit_end.comp");
  if (features.tools) {
    begin_with_tools_ = stage("implicit_begin.comp", true);
    end_with_tools_ = stage("implicit_end.comp", true);
  }
  if (features.volume) cells_ = stage("implicit_cells.comp");
  for (int i = 0; i < iterates; ++i) {
    increments_[i] = gpu::Buffer<layout::vec4>(buffers.store.slot_count, "increments");
    increment_texels_[i] = gpu::TexelView(increments_[i].raw(), gpu::TexelFormat::kRgba32f);
  }
}

void ImplicitSubstep::bindIncrements() const {
  increments_[current_].bindStorage(layout::kBindIncrement);
  if (increments_[1].size()) increments_[1 - current_].bindStorage(layout::kBindIncrementOut);
  increment_texels_[current_].bind(layout::kUnitIncrement);
}

void ImplicitSubstep::swap() {
  current_ = 1 - current_;
  bindIncrements();
}

void ImplicitSubstep::updateVolumes(const LatticeBuffers& buffers, const Substep& step, int iteration) const {
  if (!cells_) return;
  const gpu::TimedStage timed(gpu::Stage::kVolume);
  cells_.use();
  cells_.set("active_count", static_cast<uint32_t>(buffers.store.cells.size()));
  cells_.set("dt_s", step.dt_s);
  cells_.set("iteration", static_cast<uint32_t>(iteration));
  gpu::Program::dispatch(buffers.store.cells.size(), group_size_);
  gpu::Program::storageBarrier();
}

void ImplicitSubstep::runStage(const gpu::Program& stage, const LatticeBuffers& buffers, const Substep& step) const {
  stage.use();
  setSubstep(stage, buffers, step);
  gpu::Program::dispatch(buffers.store.active_count, group_size_);
  gpu::Program::storageBarrier();
}

void ImplicitSubstep::begin(const LatticeBuffers& buffers, const Substep& step) {
  guard.clear();
  guard.bindStorage(layout::kBindGuard);
  bindIncrements();
  runStage(step.tools ? begin_with_tools_ : begin_, buffers, step);
  keepBestShare(buffers, step, false);
}

void ImplicitSubstep::keepBestShare(const LatticeBuffers& buffers, const Substep& step, bool bound_energy) const {
  Substep plain = step;
  plain.tools = false;  // unknown to these stages
  energies_.bindStorage(layout::kBindPartials);
  runStage(guess_, buffers, plain);
  chooseShare(buffers, bound_energy);
  runStage(scale_, buffers, plain);
}

void ImplicitSubstep::chooseShare(const LatticeBuffers& buffers, bool bound_energy) const {
  fold_.use();
  forEachSumLevel(buffers.store.active_count, [&](size_t inputs, size_t input_first, size_t output_first, bool last) {
    fold_.set("count", static_cast<uint32_t>(inputs));
    fold_.set("input_first", static_cast<uint32_t>(input_first));
    fold_.set("output_first", static_cast<uint32_t>(output_first));
    fold_.set("last_level", last ? 1u : 0u);
    fold_.set("bound_energy", bound_energy ? 1u : 0u);
    gpu::Program::dispatch(sumRuns(inputs), group_size_);
    gpu::Program::storageBarrier();
  });
}

void ImplicitSubstep::end(const LatticeBuffers& buffers, const Substep& step) const {
  keepBestShare(buffers, step, !step.tools);        // tools may bring energy in
  if (step.tools) updateVolumes(buffers, step, 0);  // held nodes' momentum needs them
  runStage(step.tools ? end_with_tools_ : end_, buffers, step);
}

}  // namespace viscera
