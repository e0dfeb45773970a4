// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "layout/multigrid.h"
#include "solver/gpu/buffers/lattice_buffers.h"

namespace viscera {

class Archive;

/// Arrays of integrator multigrid on the GPU beside the lattice's (shaders/layout/multigrid.h).
struct MultigridBuffers {
  /// @throws GpuError  memory, longer than the driver lets a storage block be
  MultigridBuffers(const FeatureSet& features, const LatticeBuffers& buffers);
  void bind() const;

  void persist(Archive& archive);

  using Sums = std::array<double, 4>;
  /// As in the buffer.
  struct Read {
    layout::MultigridScalars scalars;
    std::array<Sums, layout::kSumsRows> rows;
  };
  Read read() const;  ///< waits for the GPU

  gpu::Buffer<layout::vec4> step, system;   ///< [kStepVectors, kSystemVectors * slots]
  gpu::Buffer<layout::NodeBits> tangents;   ///< [9 * slots] two words each
  gpu::Buffer<layout::vec4> cell_tangents;  ///< [3 * slots]; feature volume
  gpu::Buffer<layout::vec4> touched;        ///< [kTouchedVectors * slots]; where something may touch
  gpu::RawBuffer sums;
  gpu::Buffer<Sums> partials;  ///< [rows * groups]
};

/// Groups that Program::dispatch() launches.
size_t launchedGroups(size_t invocations, uint32_t group_size);

}  // namespace viscera
