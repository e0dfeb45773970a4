// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/measure_pass.h"

#include <cstddef>

#include "gpu/gl.h"
#include "layout/bindings.h"
#include "solver/gpu/buffers/sum_tree.h"

namespace viscera {

MeasurePass::MeasurePass(const FeatureSet& features, size_t active_count)
    : energies_(active_count + sumTreeSize(active_count), "energies"), group_size_(features.group_size) {
  std::vector<std::string> defines = features.defines();
  measure_ = gpu::Program::compute("measure.comp", defines);
  if (features.walls) {
    FeatureSet in_place = features;  // energy is that of the current, not the predicted, positions
    in_place.dashpot = false;
    rows_.emplace(RowPass::differences(in_place, false));
  }
  defines.push_back("FOLD");
  fold_ = gpu::Program::compute("measure.comp", defines);
}

void MeasurePass::run(const LatticeBuffers& buffers) const {
  const uint32_t zero = 0;
  const auto clear = [&](size_t first, size_t last) {
    glClearNamedBufferSubData(buffers.stats.id(), GL_R32UI, static_cast<GLintptr>(first),
                              static_cast<GLsizeiptr>(last - first), GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
  };
  clear(0, offsetof(layout::TickStats, springs_cut));
  clear(offsetof(layout::TickStats, nonfinite), sizeof(layout::TickStats));
  if (rows_) rows_->run(buffers);
  energies_.bindStorage(layout::kBindPartials);
  measure_.use();
  measure_.set("count", static_cast<uint32_t>(buffers.store.active_count));
  gpu::Program::dispatch(buffers.store.active_count, group_size_);
  gpu::Program::storageBarrier();
  sumEnergies(buffers);
}

void MeasurePass::sumEnergies(const LatticeBuffers& buffers) const {
  fold_.use();
  forEachSumLevel(buffers.store.active_count, [&](size_t inputs, size_t input_first, size_t output_first, bool last) {
    fold_.set("count", static_cast<uint32_t>(inputs));
    fold_.set("input_first", static_cast<uint32_t>(input_first));
    fold_.set("output_first", static_cast<uint32_t>(output_first));
    fold_.set("last_level", last ? 1u : 0u);
    gpu::Program::dispatch(sumRuns(inputs), group_size_);
    gpu::Program::storageBarrier();
  });
}

}  // namespace viscera
