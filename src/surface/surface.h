// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "surface/shown_triangles.h"
#include "viscera/layout/skin.h"
#include "viscera/model/model.h"
#include "viscera/solver/state.h"

namespace viscera {

class NetworkSurface;

/// The skins of all bodies on the GPU, following the nodes: bound to lattices (EGVE 3.3), or one to one the nodes of
/// networks (EGVE 3.2). Vertices and triangles of the bodies are concatenated in the model's order; vertex indices are
/// global. A network that can be cut has two more vertices per edge behind its own, which its split triangles show.
class Surface {
 public:
  /// Needs a current context. Positions are zero until the first follow(). @throws GpuError
  explicit Surface(const Model& model);
  ~Surface();

  /// Brings positions and normals to the given state. One pass over bound nodes, one over vertices. At rest the mesh
  /// comes back to float rounding; nodes on one line or in one point still give finite vertices and unit normals.
  /// What it writes is ready to be drawn, copied or read by a kernel. Vertices none of whose nodes have moved since the
  /// last call are left as they are, where the state says which those are; that changes no bit.
  void follow(const StateView& state);
  /// Takes out the triangles of lattices whose springs were cut (the rule is in model/skin.h), until reset(), and
  /// splits those of networks along the cut (the rule is in split_triangles.comp). Looks at the springs only if
  /// state.cut_revision has changed since the last call; costs nothing otherwise.
  void tear(const StateView& state);
  /// Every triangle whole again.
  void reset();

  size_t vertices() const { return vertices_; }
  size_t triangles() const { return shown_.count(); }
  const gpu::Buffer<float>& positions() const { return positions_; }  ///< [3 * vertices] m, tissue frame
  const gpu::Buffer<uint32_t>& normals() const { return normals_; }   ///< [vertices] packed, see packNormal
  const gpu::Buffer<uint32_t>& alive() const { return alive_; }       ///< [triangles] see appendShown
  const gpu::Buffer<uint32_t>& liveIndices() const { return live_; }  ///< for drawing; (0, 0, 0) shows nothing
  const gpu::Buffer<uint32_t>& colors() const { return colors_; }     ///< [vertices] RGBA8, see vertexColors
  const ShownTriangles& skin() const { return shown_; }
  ShownTriangles& skin() { return shown_; }        ///< makes of alive() what is shown
  uint64_t mappings() const { return mappings_; }  ///< times follow() did its work

 private:
  void followLattices(uint32_t since);

  size_t vertices_ = 0;
  gpu::Buffer<uint32_t> surface_nodes_, normals_, triangle_buffer_, tie_starts_, alive_, live_, colors_;
  gpu::Buffer<layout::vec4> node_normals_;
  gpu::Buffer<layout::SkinBinding> bindings_;
  gpu::Buffer<layout::Tie> ties_;
  gpu::Buffer<float> positions_;
  gpu::Buffer<uint32_t> unknown_{size_t{1}};  ///< in place of StateView::stale_bricks; nobody reads it
  gpu::Program node_normal_, map_, tear_;     ///< none where every body is a network
  std::unique_ptr<NetworkSurface> networks_;  ///< null where none is
  ShownTriangles shown_;
  uint64_t cut_revision_ = 0, mappings_ = 0;
  uint32_t followed_revision_ = 0;  ///< of the state that positions and normals belong to; 0 if nobody knows
};

}  // namespace viscera
