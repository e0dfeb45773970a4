// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/forces/cell_pass.h"

#include "gpu/stage_clock.h"

namespace viscera {

namespace {

void dispatchCells(const gpu::Program& program, const LatticeBuffers& buffers, uint32_t group_size) {
  program.use();
  program.set("cell_count", static_cast<uint32_t>(buffers.store.cells.size()));
  gpu::Program::dispatch(buffers.store.cells.size(), group_size);
  gpu::Program::storageBarrier();
}

}  // namespace

CellPass::CellPass(const FeatureSet& features, const AwakeBricks* awake)
    : awake_(awake), group_size_(features.group_size) {
  std::vector<std::string> defines = features.defines();
  if (awake) defines.push_back("AWAKE");
  cells_ = gpu::Program::compute("cell_forces.comp", defines);
  if (!features.walls) return;
  rows_.emplace(RowPass::differences(features, awake != nullptr));
  row_forces_.emplace(RowPass::forces(features, awake != nullptr));
}

void CellPass::run(const LatticeBuffers& buffers) const {
  const gpu::TimedStage timed(gpu::Stage::kCells);
  if (rows_) rows_->run(buffers);
  runCells(buffers);
  if (row_forces_) row_forces_->run(buffers);
}

void CellPass::runCells(const LatticeBuffers& buffers) const {
  if (!awake_) {
    dispatchCells(cells_, buffers, group_size_);
    return;
  }
  cells_.use();
  awake_->dispatchCells();
  gpu::Program::storageBarrier();
}

TornCellsPass::TornCellsPass(const FeatureSet& features) : group_size_(features.group_size) {
  std::vector<std::string> defines = features.defines();
  defines.push_back("CUT");
  torn_ = gpu::Program::compute("cell_forces.comp", defines);
}

void TornCellsPass::run(const LatticeBuffers& buffers) const {
  dispatchCells(torn_, buffers, group_size_);
}

}  // namespace viscera
