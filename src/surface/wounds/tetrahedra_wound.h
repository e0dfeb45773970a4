// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "surface/wounds/tetrahedra_index.h"
#include "surface/wounds/tetrahedra_points.h"
#include "viscera/layout/skin.h"
#include "viscera/model/body/skin.h"
#include "viscera/model/body/spring_network.h"

namespace viscera {

/// The skin of one body of tetrahedra after cuts, closed: split where its edges were cut, with walls inside
/// (docs/wounds.md 4). Vertices are the skin's own, then those that cuts have added. Work follows the wound's size, but
/// for a look at every spring and a copy of the skin's triangles, and all memory is kept.
class TetrahedraWound {
 public:
  /// A vertex beyond the skin's own.
  struct Vertex {
    layout::SkinBinding binding;  ///< see kCopiedNormalMask; slots and vertices of the body
    Vector3d rest_m;
    double depth_m = 0;          ///< below the skin at rest
    uint32_t like = UINT32_MAX;  ///< vertex of the skin that it looks like; UINT32_MAX: flesh
    uint32_t point = 0;          ///< vertices of one point are in one place in every state
  };

  /// @param skin, network  of one body; must outlive this
  TetrahedraWound(const Skin& skin, const SpringNetwork& network);

  /// What blades have left. @param nodes, spring_cut  [slots], [springs] of the body, as in CutSprings
  void update(const layout::NodeBits* nodes, const float* spring_cut);

  bool any() const { return !points_.cutSprings().empty(); }
  size_t ownVertices() const { return skin_.bindings.size(); }
  const std::vector<Vertex>& added() const { return added_; }
  const std::vector<uint32_t>& skinTriangles() const { return triangles_; }  ///< [3 * n]
  const std::vector<uint32_t>& skinSources() const { return sources_; }      ///< [n] as BodyWound's
  const std::vector<uint32_t>& wallTriangles() const { return walls_; }      ///< [3 * n]
  const std::vector<uint32_t>& replaced() const { return replaced_; }        ///< triangles of the skin, ascending
  size_t firstWallVertex() const { return ownVertices() + first_wall_; }

 private:
  static constexpr uint32_t kNone = UINT32_MAX;
  void forget();
  void findAffected();
  void showSkin();
  void showPieces(uint32_t triangle);
  void addPiece(uint32_t triangle, const std::array<uint32_t, 3>& corners);
  void closeGaps();
  uint32_t skinVertex(uint32_t triangle, const FaceVertex& vertex);
  uint32_t copyOf(uint32_t own);
  uint32_t addToSkin(uint32_t point, uint32_t own, bool turned);
  void addWalls();
  void addWallsOf(const TetrahedraIndex::Tetrahedron& of);
  uint32_t wallVertex(uint32_t point);
  void addWall(const std::array<uint32_t, 3>& corners);
  Vector3d restNormal(uint32_t own) const;
  uint32_t addVertex(uint32_t point, const layout::SkinBinding& binding, uint32_t like);

  const Skin& skin_;
  const SpringNetwork& network_;
  const TetrahedraIndex index_;
  TetrahedraPoints points_;
  std::vector<uint32_t> affected_;      ///< tetrahedra
  std::vector<bool> is_affected_;       ///< [tetrahedra]
  std::vector<uint32_t> whole_, left_;  ///< [own vertices] triangles around each; those that are whole
  std::vector<uint32_t> copies_;        ///< [own vertices] an added one in its place, or kNone
  std::vector<uint32_t> copied_;
  std::vector<uint32_t> skin_vertices_, wall_vertices_;  ///< [points] or kNone
  std::vector<Vertex> added_;
  std::vector<Vector3d> normals_;  ///< [wall vertices] sums
  std::vector<uint32_t> triangles_, sources_, walls_, replaced_, gaps_;
  size_t first_wall_ = 0;
  bool place_is_free_ = false;  ///< of the triangle that is being shown
};

}  // namespace viscera
