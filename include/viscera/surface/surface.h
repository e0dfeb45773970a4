// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "viscera/gpu/buffer.h"
#include "viscera/gpu/program.h"
#include "viscera/model/model.h"
#include "viscera/solver/state.h"

namespace viscera {

/// The skins of all bodies on the GPU, following the nodes (EGVE 3.3). Vertices and triangles of the bodies are
/// concatenated in the model's order; vertex indices are global.
class Surface {
 public:
  /// Needs a current context. Positions are zero until the first follow(). @throws GpuError
  explicit Surface(const Model& model);

  /// Brings positions and normals to the given state. One pass over bound nodes, one over vertices. At rest the mesh
  /// comes back to float rounding; nodes on one line or in one point still give finite vertices and unit normals.
  /// What it writes is ready to be drawn, copied or read by a kernel. Vertices none of whose nodes have moved since the
  /// last call are left as they are, where the state says which those are; that changes no bit.
  void follow(const StateView& state);
  /// Takes out the triangles whose springs were cut (the rule is in model/skin.h), until reset(). Looks at the springs
  /// only if state.cut_revision has changed since the last call; costs nothing otherwise.
  void tear(const StateView& state);
  /// Every triangle whole again.
  void reset();

  size_t vertices() const { return vertices_; }
  size_t triangles() const { return triangles_; }
  const gpu::Buffer<float>& positions() const { return positions_; }         ///< [3 * vertices] m, tissue frame
  const gpu::Buffer<uint32_t>& normals() const { return normals_; }          ///< [vertices] packed, see packNormal
  const gpu::Buffer<uint32_t>& alive() const { return alive_; }              ///< [triangles] 1 whole, 0 torn
  const gpu::Buffer<uint32_t>& liveIndices() const { return live_; }         ///< [3 * triangles] for drawing
  const gpu::Buffer<uint32_t>& colors() const { return colors_; }            ///< [vertices] RGBA8
  const std::vector<uint32_t>& triangleIndices() const { return indices_; }  ///< [3 * triangles], host copy
  uint64_t mappings() const { return mappings_; }                            ///< times follow() did its work

 private:
  size_t vertices_ = 0, triangles_ = 0;
  gpu::Buffer<uint32_t> surface_nodes_, normals_, triangle_buffer_, tie_starts_, alive_, live_, colors_;
  gpu::Buffer<layout::vec4> node_normals_;
  gpu::Buffer<layout::SkinBinding> bindings_;
  gpu::Buffer<layout::Tie> ties_;
  gpu::Buffer<float> positions_;
  gpu::Program node_normal_, map_, tear_;
  std::vector<uint32_t> indices_;
  uint64_t cut_revision_ = 0, mappings_ = 0;
  uint32_t followed_revision_ = 0;  ///< of the state that positions and normals belong to; 0 if nobody knows
};

/// Unit normal <-> three signed 10-bit fractions in a uint (x in the low bits), as GL_INT_2_10_10_10_REV.
uint32_t packNormal(const Vector3f& normal);
Vector3f unpackNormal(uint32_t packed);

}  // namespace viscera
