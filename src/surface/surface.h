// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "surface/body_items.h"
#include "surface/skin_boxes.h"
#include "surface/visible_triangles.h"
#include "surface/wounds/wounds.h"
#include "viscera/layout/skin.h"
#include "viscera/model/model.h"
#include "viscera/solver/process_visuals.h"
#include "viscera/solver/state.h"

namespace viscera {

class NetworkSurface;

/// The surface meshes of all bodies on the GPU, which follow the nodes: bound to lattices (EGVE 3.3), or one to one to
/// the nodes of networks (EGVE 3.2). Vertices and triangles of the bodies are concatenated in the model's order; vertex
/// indices are global. A sheet that can be cut has two more vertices per edge after its own, for its split triangles.
class Surface {
 public:
  /// Needs a current context. Positions are zero until the first follow(). @throws GpuError
  explicit Surface(const Model& model);
  ~Surface();

  /// Updates positions and normals to the given state, in one pass over bound nodes and one over vertices. At rest the
  /// mesh is the original one to float rounding. Nodes on one line or in one point still give finite vertices and unit
  /// normals. The results are ready to be drawn, copied or read by a kernel. Vertices are skipped if the state says
  /// that none of their nodes have moved since the last call; that changes no bit.
  /// @param asked  [bodies] 1: requested; others stay as they are. Null: all are
  void follow(const StateView& state, const std::vector<uint8_t>* asked = nullptr);
  /// Splits the triangles of networks along the cut (the rule is in split_triangles.comp), until reset(). Reads the
  /// springs only if state.cut_revision has changed since the last call; costs nothing otherwise.
  void split(const StateView& state);
  /// Shows the wounds of bodies on lattices that can be cut (surface/wounds/wounds.h), until reset(). Allocates buffers
  /// only where wounds outgrow the old ones.
  /// @param revision  of the cuts; a repeated one costs nothing
  void wound(const CutSprings& cuts, uint64_t revision);
  /// Paints the tissue like ProcessVisuals::paints, until the next call. Repeated paints cost nothing.
  void paint(const std::vector<std::shared_ptr<const NodePaint>>& paints);
  bool isPainted() const { return !paints_.empty(); }  ///< colors() differ from those before the first tick
  /// Returns whether colors() are more than the colours of bodies: painted, or with colours of parts.
  bool hasColors() const { return has_part_colors_ || isPainted(); }
  /// Returns whether a vertex may be burnt, or is on the lip of a cut (skins/skin_paint.h).
  bool needsPaint() const { return isPainted() || (wounds_ && !wounds_->addedRests().empty()); }
  /// Makes every triangle whole again.
  void reset();

  size_t vertices() const { return vertices_; }        ///< of the surface meshes and of wounds
  size_t capacity() const { return normals_.size(); }  ///< of vertices; grows with wounds
  bool canBeWounded() const { return wounds_ != nullptr; }
  /// Returns the wounds, or null where no body on a lattice can be cut.
  std::shared_ptr<const VisibleWounds> wounds() const { return wounds_ ? wounds_->shown() : nullptr; }
  size_t triangles() const { return shown_.count(); }
  const gpu::Buffer<float>& positions() const { return positions_; }  ///< [3 * vertices] m, tissue frame
  const gpu::Buffer<uint32_t>& normals() const { return normals_; }   ///< [vertices] packed, see packNormal
  const gpu::Buffer<uint32_t>& alive() const { return alive_; }       ///< [triangles] see appendShown
  const gpu::Buffer<uint32_t>& liveIndices() const { return live_; }  ///< for drawing; (0, 0, 0) shows nothing
  /// Returns how many indices to draw: those of the bodies in order, as in skin(), then split pieces, then the
  /// triangles of wounds that did not fit.
  size_t liveCount() const { return live_count_; }
  uint64_t liveRevision() const { return live_revision_; }  ///< changes whenever other triangles may be drawn
  /// Returns the runs of liveIndices() that show some bodies, in drawing order. @param bodies  [bodies] 1: is drawn
  IndexRuns runsOf(const std::vector<uint8_t>& bodies) const;
  const SkinBoxes& boxes() const { return boxes_; }
  /// Returns the texture charts (JoinedSkins::charts) of the triangles drawn, [liveIndices() / 3]; empty where no body
  /// has any.
  const gpu::Buffer<uint32_t>& liveCharts() const { return live_charts_; }
  uint32_t liveChartsView() const { return live_charts_view_.id(); }  ///< of texels; 0: none
  const gpu::Buffer<layout::vec4>& rests() const { return rests_; }   ///< [vertices] see JoinedSkins::rests
  const gpu::Buffer<uint32_t>& colors() const { return colors_; }     ///< [vertices] RGBA8, see vertexColors
  const gpu::Buffer<layout::SkinBinding>& bindings() const { return bindings_; }  ///< [vertices]
  const VisibleTriangles& skin() const { return shown_; }
  VisibleTriangles& skin() { return shown_; }      ///< makes the shown triangles of alive()
  uint64_t mappings() const { return mappings_; }  ///< times that follow() did work

 private:
  bool followLattices(const StateView& state, const std::vector<uint8_t>* asked);
  void followNormals(const StateView& state, const std::vector<uint8_t>* asked);
  bool followNetworks(const StateView& state);
  void clear();
  void showWounds();
  void writeColors();
  void writePaintedColors();
  void makeRoom(size_t vertices, size_t indices);
  void showWoundedCharts();

  const Model& model_;
  size_t vertices_ = 0, live_count_ = 0, first_wound_index_ = 0;
  gpu::Buffer<layout::SurfaceNode> carried_nodes_, summed_nodes_;
  gpu::Buffer<uint32_t> normals_, triangle_buffer_, alive_, live_, colors_;
  gpu::Buffer<uint32_t> live_charts_;
  gpu::TexelView live_charts_view_;
  gpu::Buffer<layout::vec4> node_normals_, rests_;
  gpu::Buffer<layout::SkinBinding> bindings_;
  gpu::Buffer<float> positions_;
  gpu::Buffer<uint32_t> unknown_{size_t{1}};     ///< in place of StateView::stale_bricks; never read
  gpu::Program map_;                             ///< empty where every body is a network
  gpu::Program carried_normal_, summed_normal_;  ///< empty where such normals are not used
  std::unique_ptr<NetworkSurface> networks_;     ///< null without networks
  std::unique_ptr<Wounds> wounds_;               ///< null where no lattice body can be cut
  VisibleTriangles shown_;
  std::vector<std::shared_ptr<const NodePaint>> paints_;
  bool has_part_colors_ = false;
  std::vector<uint32_t> whole_colors_;  ///< [vertices] without wounds, like whole_bindings_
  std::vector<layout::SkinBinding> whole_bindings_;
  std::vector<layout::vec4> whole_rests_;  ///< [vertices] without wounds
  std::vector<uint32_t> wound_indices_, charts_, wound_charts_;
  size_t whole_vertices_ = 0;
  std::vector<bool> was_wounded_;  ///< [bodies]
  uint64_t cut_revision_ = 0, wound_revision_ = 0, mappings_ = 0;
  SkinBoxes boxes_;
  std::vector<bool> one_to_one_;                        ///< [bodies]
  std::vector<size_t> split_indices_, beyond_indices_;  ///< [bodies] of split pieces; of wounds that did not fit
  /// Vertices include those of wounds, as of one more body.
  BodyItems vertex_items_, carried_items_, summed_items_;
  uint32_t followed_networks_ = 0;  ///< revision of the state that their vertices show; 0 if unknown
  uint64_t live_revision_ = 0;
};

}  // namespace viscera
