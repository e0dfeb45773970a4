// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "bench/gw/gw_blend.h"
#include "gpu/buffer.h"
#include "gpu/program.h"

namespace viscera::bench {

/// Number format in which displacements and velocities are stored.
enum class StateFormat { kFloat32, kFloat16 };

/// Parameters of a network's motion (physics.md 2): leapfrog with the symmetric drag of its body.
struct GwMotion {
  double dt_s = 0;
  Vector3d gravity_m_per_s2 = Vector3d::Zero();
};

/// The stages of GW's two methods on the GPU, which can be run and timed separately. Requires a current context.
class GwKernels {
 public:
  /// @param network  must outlive this object
  explicit GwKernels(const GwNetwork& network, StateFormat format = StateFormat::kFloat32);

  /// @name Compute forces from the current displacements
  /// @{
  void pointForces();                       ///< point-centric, one pass
  void pointPasses();                       ///< point-centric, a pass per neighbour: GW's method for varying valence
  void springForces();                      ///< edge-centric, a pass over springs: each force is stored at both links
  void sumForces();                         ///< edge-centric, second pass, as a gather over each node's links
  void forceTexture();                      ///< edge-centric in GW's original form, first pass
  void scatterForces(BlendTarget& target);  ///< second pass, by blending
  /// @}

  /// Performs one leapfrog substep with the current forces.
  /// @param target  target with the forces; null: they are in the buffer
  void integrate(const GwMotion& motion, const BlendTarget* target = nullptr);

  /// Sets the initial state. @param u_m  [slots]; velocities become zero
  void start(const Field& u_m);
  Field forces() const;         ///< [slots, N] forces of the passes that write a buffer
  Field displacements() const;  ///< [slots, m] displacements
  /// Returns the size of the buffers that one method needs [bytes].
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
  std::vector<size_t> with_valence_above_;  ///< [largest valence] number of nodes with more links than the index
};

}  // namespace viscera::bench
