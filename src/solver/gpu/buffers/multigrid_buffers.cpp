// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/buffers/multigrid_buffers.h"

#include <algorithm>

#include "gpu/archive.h"
#include "layout/bindings.h"

namespace viscera {

namespace {

constexpr size_t kSumsAtOnce = 2;       // rows that a kernel sums
constexpr size_t kPairs = 9;            // springs that a node owns
constexpr size_t kTangentsPerCell = 3;  // vectors

}  // namespace

size_t launchedGroups(size_t invocations, uint32_t group_size) {
  constexpr size_t kMaxGroups = 65535;  // in a row
  const size_t groups = (invocations + group_size - 1) / group_size;
  return groups <= kMaxGroups ? groups : (groups + kMaxGroups - 1) / kMaxGroups * kMaxGroups;
}

MultigridBuffers::MultigridBuffers(const FeatureSet& features, const LatticeBuffers& buffers)
    : step(layout::kStepVectors * buffers.store.slot_count, "vectors of a step"),
      system(layout::kSystemVectors * buffers.store.slot_count, "vectors of a system"),
      tangents(kPairs * buffers.store.slot_count, "tangents of springs"),
      sums(sizeof(Read), "sums of multigrid"),
      partials(kSumsAtOnce * launchedGroups(std::max(buffers.store.active_count, buffers.store.cells.size()),
                                            features.group_size),
               "partial sums of multigrid") {
  if (features.volume)
    cell_tangents = gpu::Buffer<layout::vec4>(kTangentsPerCell * buffers.store.slot_count, "tangents of cells");
  if (features.tools || features.obstacles > 0)
    touched = gpu::Buffer<layout::vec4>(layout::kTouchedVectors * buffers.store.slot_count, "touched nodes");
  bind();  // what is too large for the driver is said now
}

void MultigridBuffers::bind() const {
  step.bindStorage(layout::kBindStepVectors);
  system.bindStorage(layout::kBindSystemVectors);
  tangents.bindStorage(layout::kBindTangents);
  sums.bindStorage(layout::kBindSums);
  partials.bindStorage(layout::kBindPartials);
  if (cell_tangents.size()) cell_tangents.bindStorage(layout::kBindCellTangents);
  if (touched.size()) touched.bindStorage(layout::kBindTouched);
}

void MultigridBuffers::persist(Archive& archive) {
  gpu::persist(archive, step);
  gpu::persist(archive, touched);
}

MultigridBuffers::Read MultigridBuffers::read() const {
  Read out{};
  sums.read(0, sizeof out, &out);
  return out;
}

}  // namespace viscera
