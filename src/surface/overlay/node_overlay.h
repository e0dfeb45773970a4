// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "layout/overlay.h"
#include "layout/surface_node.h"
#include "surface/overlay/node_strains.h"
#include "surface/surface.h"
#include "viscera/model/model.h"
#include "viscera/solver/state.h"

namespace viscera {

/// Lines, normals, forces and strains of nodes and springs for overlays, computed on the GPU. Owner of
/// shaders/surface/overlay_*.comp but overlay_nodes.comp. Made when an overlay is first requested.
class NodeOverlay {
 public:
  /// Needs a current context. @param model  must outlive this   @throws GpuError
  explicit NodeOverlay(const Model& model);

  /// Computes positions and strains of the nodes of a state. The functions below use it, and compute each result once
  /// per state.
  /// @param surface  of the same model, that follows the state
  void follow(const StateView& state, const Surface& surface);
  /// Makes lines of the springs between nodes that surface meshes are bound to, without cut ones. @param all  diagonal
  /// ones too
  /// @returns number of indices to draw
  size_t makeLines(const StateView& state, bool all);
  /// Makes approximate normals of nodes that surface meshes are bound to: VR05's eq 5 with any mapping; of networks the
  /// normals of the mesh.
  void makeNormals(const StateView& state, const Surface& surface);
  void makeForces(const Surface& surface);
  /// Makes colours by strain. @param strain_range  the end of the scale
  void makeColors(const Surface& surface, double strain_range);

  const gpu::Buffer<layout::vec4>& nodes() const { return strains_.nodes(); }  ///< [slots] xyz m, w strain
  const gpu::Buffer<uint32_t>& lines() const { return indices_; }              ///< indices of slots, in pairs
  const gpu::Buffer<layout::vec4>& normals() const { return normal_ends_; }    ///< [2 * n] xyz m, in pairs
  const gpu::Buffer<layout::vec4>& forces() const { return force_ends_; }      ///< [2 * n] xyz m, in pairs
  const gpu::Buffer<uint32_t>& colors() const { return colors_; }              ///< [vertices] RGBA8
  bool anyForces() const { return any_forces_; }  ///< whether a body has a force of its own

 private:
  void addLattice(const Body& body, uint32_t slot);
  void addNetwork(const Body& body, uint32_t slot, uint32_t first_spring, uint32_t first_vertex);
  void makeSpikes(const Surface& surface, uint32_t kind, const std::vector<float>& of_bodies,
                  const gpu::Buffer<layout::vec4>& ends);

  std::vector<layout::OverlayLine> axial_, diagonal_;  ///< until they are uploaded
  std::vector<layout::OverlaySpike> spike_list_;
  std::vector<float> normal_lengths_, force_spikes_;  ///< [4 * kMaxBodies] see overlay_spikes.comp
  size_t axial_count_ = 0;
  bool any_forces_ = false, network_;  ///< whether a body has a force; whether one has explicit connections
  NodeStrains strains_;
  struct Made {  ///< results for the current state
    size_t lines = 0;
    bool normals = false, forces = false, colors = false;
    double strain_range = 0;  ///< of the colours
  };
  Made made_;
  gpu::Buffer<layout::vec4> normal_ends_, force_ends_, node_normals_;
  gpu::Buffer<layout::SurfaceNode> bound_nodes_;  ///< of lattices
  gpu::Buffer<uint32_t> indices_, colors_;
  gpu::Buffer<layout::OverlayLine> lines_;
  gpu::Buffer<layout::OverlaySpike> spikes_;
  gpu::Program draw_lines_, draw_spikes_, color_;
  gpu::Program sum_normals_;  ///< empty without lattices
};

}  // namespace viscera
