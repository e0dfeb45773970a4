// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "bench/gw/gw_blend.h"
#include "gpu/buffer.h"
#include "gpu/program.h"

namespace viscera::bench {

/// What components of displacements and velocities are stored in.
enum class StateFormat { kFloat32, kFloat16 };

/// What moves a network (physics.md 2): leapfrog with the symmetric drag of its body.
struct GwMotion {
  double dt_s = 0;
  Vector3d gravity_m_per_s2 = Vector3d::Zero();
};

/// The stages of GW's two ways on the GPU, each to be run and timed by itself. Needs the context current.
class GwKernels {
 public:
  /// @param network  must outlive this
  explicit GwKernels(const GwNetwork& network, StateFormat format = StateFormat::kFloat32);

  /// @name Forces from the current displacements
  /// @{
  void pointForces();                       ///< point-centric, one pass
  void pointPasses();                       ///< point-centric, a pass per neighbour: GW's way with varying valence
  void springForces();                      ///< edge-centric, a pass over springs: each force is stored at both links
  void sumForces();                         ///< edge-centric, second pass, as a gather over each node's links
  void forceTexture();                      ///< edge-centric as GW did it, first pass
  void scatterForces(BlendTarget& target);  ///< the second one, by blending
  /// @}

  /// One leapfrog substep from the forces there are. @param target  forces are in it; else in the buffer
  void integrate(const GwMotion& motion, const BlendTarget* target = nullptr);

  /// Starts again. @param u_m  [slots]; velocities become zero
  void start(const Field& u_m);
  Field forces() const;         ///< [slots, N] of the passes that leave them in a buffer
  Field displacements() const;  ///< [slots, m]
  /// Bytes of the buffers that one way needs.
  size_t pointBytes() const;
  size_t edgeBytes() const;

 private:
  struct State {
    gpu::RawBuffer u, v;
    TexelArray u_view, v_view;
  };
  State makeState() const;
  size_t vectorBytes() const { return format_ == StateFormat::kFloat16 ? 8 : 16; }
  void makeOrder();
  void makeViews();
  void bindMesh() const;

  const GwNetwork& network_;
  StateFormat format_;
  gpu::Program point_, point_pass_, edge_runs_, edge_each_, sum_, integrate_, integrate_target_;
  gpu::Buffer<layout::Link> links_;
  gpu::Buffer<uint32_t> starts_, order_;
  gpu::Buffer<layout::SpringEnds> springs_;
  gpu::Buffer<float> inverse_mass_;
  gpu::Buffer<layout::vec4> forces_, link_forces_, spring_forces_;
  TexelArray links_view_, starts_view_, springs_view_, mass_view_, forces_view_, link_forces_view_, spring_forces_view_;
  State states_[2];
  int current_ = 0;
  bool first_ = true;
  std::vector<size_t> with_valence_above_;  ///< [most valence] nodes with more than so many links
};

}  // namespace viscera::bench
