// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "surface/wounds/tetrahedra_index.h"
#include "surface/wounds/tetrahedron_walls.h"
#include "viscera/layout/nodes.h"
#include "viscera/layout/skin.h"

namespace viscera {

/// The points of the wounds of one body of tetrahedra: where they are at rest, and which three nodes of their side
/// carry them (shaders/surface/wound_skin.comp). What lies on a face follows from the face alone, so that both of its
/// tetrahedra and the skin share it. All memory is kept.
class TetrahedraPoints {
 public:
  static constexpr uint32_t kNone = UINT32_MAX;

  struct Point {
    Vector3d rest_m = Vector3d::Zero();
    double depth_m = 0;                    ///< below the skin at rest
    std::array<uint32_t, 3> slots{};       ///< joined by springs that are whole, as far as there are any
    Vector3d weights = Vector3d::UnitX();  ///< of the three; below 0 beyond them
    Vector3d offset_m = Vector3d::Zero();  ///< from the weighted mean of the three nodes, at rest
  };

  /// Both must outlive this.
  TetrahedraPoints(const SpringNetwork& network, const TetrahedraIndex& index);

  /// Forgets all points. @param nodes, spring_cut  [slots], [springs] of the body, as in CutSprings; until the next
  /// call
  void update(const layout::NodeBits* nodes, const float* spring_cut);
  const std::vector<uint32_t>& cutSprings() const { return cut_; }  ///< ascending
  bool isCut(uint32_t spring) const { return spring_cut_[spring] != 0; }
  /// Has a node lost all of its springs? Then nothing of it is shown.
  bool isGone(uint32_t slot) const { return (nodes_[slot].lo & layout::kValenceMask) == 0; }
  /// Bits of kTetrahedronEdges.
  uint32_t cutEdges(const TetrahedraIndex::Tetrahedron& of) const;

  /// Where a node is: a new one with each call.
  uint32_t atNode(uint32_t slot);
  /// On a cut spring, of the end that is a node.
  uint32_t lip(uint32_t spring, uint32_t slot);
  /// Of a face with three cut edges, of one corner.
  uint32_t middle(uint32_t face, uint32_t slot, const std::array<uint32_t, 3>& springs);
  /// Of a face with one cut edge.
  uint32_t end(uint32_t face, uint32_t spring);
  /// In a tetrahedron, of a component of its corners: a new one with each call.
  uint32_t centre(const TetrahedraIndex::Tetrahedron& of, const std::array<uint8_t, 4>& component, uint8_t which);
  /// Of a point on a face with the given corners of the tetrahedron.
  uint32_t onFace(const TetrahedraIndex::Tetrahedron& of, const WallVertex& vertex);

  const Point& operator[](uint32_t point) const { return points_[point]; }
  size_t count() const { return points_.size(); }

 private:
  /// What is known of an item in this update only: no two updates have the same mark.
  struct Known {
    std::vector<uint32_t> marks, values;
    explicit Known(size_t items = 0) : marks(items), values(items) {}
  };
  struct Pair {
    uint32_t slot1, slot2;
  };
  /// Where the triangles of a node are listed, and one of its neighbours by a whole spring.
  struct Around {
    uint32_t begin, end, any;
  };
  Vector3d at(uint32_t slot) const { return network_.positions_m[slot]; }
  double shareOf(uint32_t spring) const;
  Point onSpring(uint32_t spring) const;
  template <class... Runs>
  Vector3d normalOf(const Vector3d& near_m, Runs... runs) const;
  Vector3d acrossWound(uint32_t spring) const;
  Point exitOf(const Point& entry, uint32_t spring, uint32_t third) const;
  const Around& aroundOf(uint32_t slot);
  void listTriangles(uint32_t slot);
  uint32_t add(const Point& point);
  void hangOn(uint32_t slot, Point& point);
  void carryBy(const std::array<uint32_t, 3>& slots, const Vector3d& weights, Point& point) const;
  void meanOfWound(const TetrahedraIndex::Tetrahedron& of, Point& mean);

  const SpringNetwork& network_;
  const TetrahedraIndex& index_;
  const layout::NodeBits* nodes_ = nullptr;
  const float* spring_cut_ = nullptr;
  uint32_t mark_ = 0;
  std::vector<uint32_t> cut_;
  std::vector<Point> points_;
  std::vector<Pair> triangles_;
  std::vector<Around> arounds_;
  Known lips_, face_points_, known_;  ///< first points of springs and faces; index into arounds_ of slots
};

}  // namespace viscera
