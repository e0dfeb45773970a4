// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/solver/gpu/measure_pass.h"

#include <cstddef>

#include "gpu/gl.h"

namespace viscera {

MeasurePass::MeasurePass(const FeatureSet& features) : group_size_(features.group_size) {
  measure_ = gpu::Program::compute("measure.comp", features.defines());
}

void MeasurePass::run(const LatticeBuffers& buffers) const {
  const uint32_t zero = 0;
  const auto clear = [&](size_t first, size_t last) {
    glClearNamedBufferSubData(buffers.stats.id(), GL_R32UI, static_cast<GLintptr>(first),
                              static_cast<GLsizeiptr>(last - first), GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
  };
  clear(0, offsetof(layout::TickStats, springs_cut));
  clear(offsetof(layout::TickStats, nonfinite), sizeof(layout::TickStats));
  measure_.use();
  glUniform1ui(0, static_cast<GLuint>(buffers.active_count));
  gpu::Program::dispatch(buffers.active_count, group_size_);
  gpu::Program::storageBarrier();
}

}  // namespace viscera
