// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/steps/implicit_substep.h"

#include "gpu/stage_clock.h"
#include "layout/bindings.h"
#include "solver/gpu/buffers/sum_tree.h"

namespace viscera {

namespace {

constexpr size_t kEnergiesPerNode = 2;  // shares.glsl: ENERGIES_PER_NODE

}  // namespace

std::vector<std::string> ImplicitSubstep::defines(const FeatureSet& features, bool tools) {
  std::vector<std::string> out = features.defines();
  out.push_back("INCREMENT");
  if (tools) out.push_back("TOOLS");
  if (features.obstacles > 0) out.push_back("OBSTACLES");
  if (tools || features.obstacles > 0) out.push_back("CONTACT");
  return out;
}

ImplicitSubstep::ImplicitSubstep(const FeatureSet& features, const LatticeBuffers& buffers, int iterations,
                                 const NodePairs* pairs)
    : guard(1 + 2 * static_cast<size_t>(iterations)),
      energies_(kEnergiesPerNode * (buffers.store.active_count + sumTreeSize(buffers.store.active_count)), "energies"),
      pairs_(pairs),
      group_size_(features.group_size),
      contact_rows_(contactRows(features.tools, features.obstacles)),
      obstacles_(features.obstacles > 0) {
  for (int tools = 0; tools < (features.tools ? 2 : 1); ++tools) {
    std::vector<std::string> known = defines(features, tools != 0);
    if (pairs_) known.push_back("PAIRS");
    begin_[tools] = gpu::Program::compute("implicit_begin.comp", known);
    guess_[tools] = gpu::Program::compute("implicit_guess.comp", known);
    scale_[tools] = gpu::Program::compute("implicit_scale.comp", known);
    end_[tools] = gpu::Program::compute("implicit_end.comp", known);
    if (!pairs_) continue;
    pull_[tools] = gpu::Program::compute("implicit_pull.comp", known);
    place_[tools] = gpu::Program::compute("implicit_place.comp", known);
  }
  if (pairs_) meet_ = gpu::Program::compute("implicit_meet.comp", defines(features));
  fold_ = gpu::Program::compute("implicit_fold.comp", defines(features));
  if (contact_rows_ > 0) {
    contacts_ = gpu::Buffer<layout::vec4>(size_t{3} * contact_rows_ * buffers.store.slot_count, "contacts of nodes");
    contacts_.bindStorage(layout::kBindNodeContacts);  // what is too large for the driver is said now
  }
  if (features.volume) cells_ = gpu::Program::compute("implicit_cells.comp", defines(features));
  for (int i = 0; i < 2; ++i) {
    increments_[i] = gpu::Buffer<layout::vec4>(buffers.store.slot_count, "increments");
    increment_texels_[i] = gpu::TexelView(increments_[i].raw(), gpu::TexelFormat::kRgba32f);
  }
}

void ImplicitSubstep::bindIncrements() const {
  increments_[current_].bindStorage(layout::kBindIncrement);
  increments_[1 - current_].bindStorage(layout::kBindIncrementOut);
  increment_texels_[current_].bind(layout::kUnitIncrement);
  if (contacts_.size()) contacts_.bindStorage(layout::kBindNodeContacts);
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

void ImplicitSubstep::tell(const gpu::Program& program, const LatticeBuffers& buffers, const Substep& step) const {
  setSubstep(program, buffers, step);
  if (!step.tools && !obstacles_) return;
  program.set("slot_count", static_cast<uint32_t>(buffers.store.slot_count));
  program.set("push_speed", step.push_speed_m_per_s);
  program.set("contact_rows", contact_rows_);
  if (!obstacles_) return;
  program.set("obstacle_count", step.obstacle_count);
  program.set("resting_speed", step.resting_speed_m_per_s);
}

void ImplicitSubstep::runStage(const gpu::Program& stage, const LatticeBuffers& buffers, const Substep& step) const {
  stage.use();
  tell(stage, buffers, step);
  gpu::Program::dispatch(buffers.store.active_count, group_size_);
  gpu::Program::storageBarrier();
}

void ImplicitSubstep::begin(const LatticeBuffers& buffers, const Substep& step) {
  guard.clear();
  guard.bindStorage(layout::kBindGuard);
  bindIncrements();
  runStage(begin_[step.tools], buffers, step);
  if (pairs_) pairs_->find(buffers, step);
  keepBestShare(buffers, step, false);
}

void ImplicitSubstep::movePairs(const LatticeBuffers& buffers, const Substep& step, int iteration) const {
  if (!pairs_) return;
  updateVolumes(buffers, step, 0);
  const gpu::Program &pull = pull_[step.tools], &place = place_[step.tools];
  pull.use();
  pull.set("first_sweep", iteration == 0 ? 1u : 0u);
  pairs_->tell(pull, step);
  runStage(pull, buffers, step);
  for (int round = 1; round <= kPairRounds; ++round) {
    meet_.use();
    meet_.set("active_count", static_cast<uint32_t>(buffers.store.active_count));
    pairs_->tell(meet_, step);
    gpu::Program::dispatch(buffers.store.active_count, group_size_);
    gpu::Program::storageBarrier();
    place.use();
    place.set("ends_sweep", round == kPairRounds ? 1u : 0u);
    pairs_->tell(place, step);
    runStage(place, buffers, step);
  }
}

void ImplicitSubstep::keepBestShare(const LatticeBuffers& buffers, const Substep& step, bool bound_energy) const {
  energies_.bindStorage(layout::kBindPartials);
  const gpu::Program& guess = guess_[step.tools];
  guess.use();
  if (pairs_) pairs_->tell(guess, step);
  runStage(guess, buffers, step);
  chooseShare(buffers, bound_energy);
  runStage(scale_[step.tools], buffers, step);
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
  keepBestShare(buffers, step, !step.tools);                      // tools may bring energy in
  if (step.tools || obstacles_) updateVolumes(buffers, step, 0);  // the momentum of who holds or touches needs them
  const gpu::Program& end = end_[step.tools];
  end.use();
  if (pairs_) pairs_->tell(end, step);
  runStage(end, buffers, step);
}

}  // namespace viscera
