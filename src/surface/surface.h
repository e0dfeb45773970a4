// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "surface/body_items.h"
#include "surface/shown_triangles.h"
#include "surface/skin_boxes.h"
#include "surface/wounds/wounds.h"
#include "viscera/layout/skin.h"
#include "viscera/model/model.h"
#include "viscera/solver/seen_blood.h"
#include "viscera/solver/seen_burns.h"
#include "viscera/solver/state.h"

namespace viscera {

class NetworkSurface;

/// The skins of all bodies on the GPU, following the nodes: bound to lattices (EGVE 3.3), or one to one the nodes of
/// networks (EGVE 3.2). Vertices and triangles of the bodies are concatenated in the model's order; vertex indices are
/// global. A sheet that can be cut has two more vertices per edge behind its own, which its split triangles show.
class Surface {
 public:
  /// Needs a current context. Positions are zero until the first follow(). @throws GpuError
  explicit Surface(const Model& model);
  ~Surface();

  /// Brings positions and normals to the given state. One pass over bound nodes, one over vertices. At rest the mesh
  /// comes back to float rounding; nodes on one line or in one point still give finite vertices and unit normals.
  /// What it writes is ready to be drawn, copied or read by a kernel. Vertices none of whose nodes have moved since the
  /// last call are left as they are, where the state says which those are; that changes no bit.
  /// @param asked  [bodies] 1: is asked for; others stay as they are. Null: all are
  void follow(const StateView& state, const std::vector<uint8_t>* asked = nullptr);
  /// Splits the triangles of networks along the cut (the rule is in split_triangles.comp), until reset(). Looks at the
  /// springs only if state.cut_revision has changed since the last call; costs nothing otherwise.
  void split(const StateView& state);
  /// Shows the wounds of bodies on lattices that can be cut (surface/wounds/wounds.h), until reset().
  /// Makes buffers only where wounds outgrow those that are there.
  /// @param revision  of the cuts; the last one again costs nothing
  void wound(const CutSprings& cuts, uint64_t revision);
  /// Shows how far tissue is burnt and covered by blood, from now on. The last ones again cost nothing.
  /// @param burns, blood  null: by nothing
  void paint(const std::shared_ptr<const BurnPaint>& burns, const std::shared_ptr<const BloodPaint>& blood);
  bool isPainted() const { return burns_ || blood_; }  ///< colors() are other ones than before the first tick
  /// Every triangle whole again.
  void reset();

  size_t vertices() const { return vertices_; }        ///< of the skins and of what wounds have added
  size_t capacity() const { return normals_.size(); }  ///< of vertices; grows with wounds
  bool canBeWounded() const { return wounds_ != nullptr; }
  /// Null where no body on a lattice can be cut.
  std::shared_ptr<const ShownWounds> wounds() const { return wounds_ ? wounds_->shown() : nullptr; }
  size_t triangles() const { return shown_.count(); }
  const gpu::Buffer<float>& positions() const { return positions_; }  ///< [3 * vertices] m, tissue frame
  const gpu::Buffer<uint32_t>& normals() const { return normals_; }   ///< [vertices] packed, see packNormal
  const gpu::Buffer<uint32_t>& alive() const { return alive_; }       ///< [triangles] see appendShown
  const gpu::Buffer<uint32_t>& liveIndices() const { return live_; }  ///< for drawing; (0, 0, 0) shows nothing
  /// How many of them are to be drawn: those of the bodies one after the other, as in skin(), then split pieces, then
  /// what wounds have beyond.
  size_t liveCount() const { return live_count_; }
  uint64_t liveRevision() const { return live_revision_; }  ///< another one whenever what is drawn may be others
  /// What of liveIndices() shows some bodies, in the order in which all is drawn. @param bodies  [bodies] 1: is drawn
  IndexRuns runsOf(const std::vector<uint8_t>& bodies) const;
  const SkinBoxes& boxes() const { return boxes_; }
  /// [liveIndices() / 3] texture charts (JoinedSkins::charts) of the triangles drawn; empty where no body has any.
  const gpu::Buffer<uint32_t>& liveCharts() const { return live_charts_; }
  uint32_t liveChartsView() const { return live_charts_view_.id(); }  ///< of texels; 0: none
  const gpu::Buffer<layout::vec4>& rests() const { return rests_; }   ///< [vertices] see JoinedSkins::rests
  const gpu::Buffer<uint32_t>& colors() const { return colors_; }     ///< [vertices] RGBA8, see vertexColors
  const gpu::Buffer<layout::SkinBinding>& bindings() const { return bindings_; }  ///< [vertices]
  const ShownTriangles& skin() const { return shown_; }
  ShownTriangles& skin() { return shown_; }        ///< makes of alive() what is shown
  uint64_t mappings() const { return mappings_; }  ///< times follow() did its work

 private:
  bool followLattices(const StateView& state, const std::vector<uint8_t>* asked);
  void followNormals(const StateView& state, const std::vector<uint8_t>* asked);
  bool followNetworks(const StateView& state);
  void forget();
  void showWounds();
  void writeColors();
  void writePaintedColors();
  void makeRoom(size_t vertices, size_t indices);
  void showWoundedCharts();

  size_t vertices_ = 0, live_count_ = 0, first_wound_index_ = 0;
  gpu::Buffer<layout::SurfaceNode> carried_nodes_, summed_nodes_;
  gpu::Buffer<uint32_t> normals_, triangle_buffer_, alive_, live_, colors_;
  gpu::Buffer<uint32_t> live_charts_;
  gpu::TexelView live_charts_view_;
  gpu::Buffer<layout::vec4> node_normals_, rests_;
  gpu::Buffer<layout::SkinBinding> bindings_;
  gpu::Buffer<float> positions_;
  gpu::Buffer<uint32_t> unknown_{size_t{1}};     ///< in place of StateView::stale_bricks; never read
  gpu::Program map_;                             ///< none where every body is a network
  gpu::Program carried_normal_, summed_normal_;  ///< none where such normals are not followed
  std::unique_ptr<NetworkSurface> networks_;     ///< null where none is
  std::unique_ptr<Wounds> wounds_;               ///< null where no body with an inside can be cut
  ShownTriangles shown_;
  std::shared_ptr<const BurnPaint> burns_;   ///< null: nothing was burnt
  std::shared_ptr<const BloodPaint> blood_;  ///< null: nothing has bled
  std::vector<uint32_t> whole_colors_;       ///< [vertices] where there are no wounds, as are
  std::vector<layout::SkinBinding> whole_bindings_;
  std::vector<uint32_t> wound_indices_, charts_, wound_charts_;
  size_t whole_vertices_ = 0;
  std::vector<bool> was_wounded_;  ///< [bodies]
  uint64_t cut_revision_ = 0, wound_revision_ = 0, mappings_ = 0;
  SkinBoxes boxes_;
  std::vector<bool> one_to_one_;                        ///< [bodies]
  std::vector<size_t> split_indices_, beyond_indices_;  ///< [bodies] of split pieces; of what wounds have beyond
  /// Vertices also of what wounds have added, as of one more body.
  BodyItems vertex_items_, carried_items_, summed_items_;
  uint32_t followed_networks_ = 0;  ///< revision of the state that their vertices show; 0 if unknown
  uint64_t live_revision_ = 0;
};

}  // namespace viscera
