// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gpu/buffer.h"
#include "layout/edge_forces.h"
#include "solver/edge_forces.h"
#include "solver/features.h"
#include "solver/joined_network.h"
#include "viscera/layout/tick_stats.h"
#include "viscera/model/model.h"

namespace viscera {

/// The lattices of all bodies and their state in GPU memory: what every kernel of the solver works on.
struct LatticeBuffers {
  /// @param bodies  [bodies] material constants   @param features  what is allocated beyond the state itself
  LatticeBuffers(const Model& model, const std::vector<layout::BodyParams>& bodies, const FeatureSet& features);

  /// Binds what all kernels share, with the current state as input and the other as output.
  void bind() const;
  /// What was output becomes the current state. Binds anew only what that changes.
  void swap();
  /// Rest state, whole springs, nothing held.
  void reset();
  /// Whole explicit connections but for those that are cut. @param cut  [springs] as in HostState
  void writeSpringCut(const std::vector<float>& cut);

  size_t active_count = 0, slot_count = 0;
  gpu::Buffer<uint32_t> active;               ///< [active]
  gpu::Buffer<layout::Brick> bricks;          ///< [bricks]
  gpu::Buffer<layout::BodyParams> bodies;     ///< [bodies]
  gpu::Buffer<layout::NodeBits> nodes;        ///< [slots]
  gpu::Buffer<layout::vec4> displacement[2];  ///< [slots] m
  gpu::Buffer<layout::vec4> velocity[2];      ///< [slots] m/s
  gpu::Buffer<layout::vec4> grab_offsets;     ///< [slots] m, stylus frame
  gpu::Buffer<layout::vec4> impulses;         ///< [kMaxStyluses * slots] N s
  gpu::Buffer<layout::TickStats> stats;       ///< [1]
  gpu::Buffer<uint32_t> cells;                ///< [cells] slots of their lowest corners; feature volume
  gpu::Buffer<layout::vec4> cell_forces;      ///< [3 * slots] N, see shaders/solver/volume.comp; feature volume
  gpu::Buffer<layout::vec4> compensation;     ///< [2 * slots] m, m/s; feature compensated
  gpu::Buffer<float> spring_stiffness;        ///< [9 * slots] N/m; feature parts
  gpu::Buffer<float> node_mass;               ///< [slots] kg; features parts, network
  gpu::Buffer<float> cell_bulk;               ///< [slots] J; feature parts
  gpu::Buffer<layout::vec4> rest;             ///< [slots] m; feature network
  gpu::Buffer<uint32_t> link_starts;          ///< [slots + 1]; feature network
  gpu::Buffer<layout::Link> links;            ///< [2 * springs]; feature network
  gpu::Buffer<layout::SpringEnds> springs;    ///< [springs]; feature network
  gpu::Buffer<float> spring_cut;              ///< [springs]; feature network
  gpu::Buffer<layout::uvec4> link_runs;       ///< [slots] in place of link_starts, see EdgeForces; feature edge_forces
  gpu::Buffer<layout::SpringOwner> spring_owners;  ///< [owners]; feature edge_forces
  gpu::Buffer<uint32_t> force_starts;              ///< [slots + 1]; feature edge_forces
  gpu::Buffer<layout::vec4> link_forces;           ///< [springs + owners] N, see EdgeForces; feature edge_forces
  JoinedNetwork network;                           ///< whole, as on the host; empty without
  EdgeForces edge_forces;                          ///< feature edge_forces
  int current = 0;

 private:
  gpu::TexelView brick_texels_, displacement_texels_[2], velocity_texels_[2];
  gpu::TexelView cell_force_texels_, spring_texels_, mass_texels_, bulk_texels_;
  gpu::TexelView rest_texels_, start_texels_, link_texels_;
  gpu::TexelView owner_texels_, force_start_texels_, link_force_texels_;
  void bindState() const;
  void allocateVolume(const Model& model);
  void allocateParts(const Model& model);
  void allocateNetwork();
  void allocateEdgeForces();
  void bindNetwork() const;
  std::vector<layout::NodeBits> whole_nodes_;
};

}  // namespace viscera
