// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "export/page/page_bytes.h"
#include "viscera/surface/visible_mesh.h"

namespace viscera {

/// Positions that a page can express: 65536 along each axis, in equal steps.
struct PageGrid {
  static constexpr double kPerEdge = 3072;  ///< steps along the largest edge of the box of a session's first mesh
  static constexpr double kSteps = 65535;
  Vector3d origin_m = Vector3d::Zero();
  double step_m = 1;

  /// Returns the grid around the shown vertices of a mesh, with room for them to move.
  static PageGrid around(const VisibleMesh& mesh);
  /// Returns the nearest step along each axis, of any size. @param position_m  tissue frame
  Eigen::Vector3i nearest(const Vector3d& position_m) const;
};

/// Encodes the surface meshes of a session, frame after frame. Positions are differences from the frame before, and of
/// these from two neighbouring vertices. A key frame has differences from the base instead, so that decoding can begin
/// there.
///
/// The first surface of a block (page_writer.h) refers to the base, each later one to the surface
/// before it; the base refers to an empty surface. "Before" is that surface. A surface has, in this order:
/// * Flags, a byte: 1, triangles differ from those before; 2, colours differ.
/// * Triangles, if they differ. Counts: vertices; removed triangles, then for each the count of triangles since the
///   last removed one; added triangles. An added triangle is a byte (0 surface, 1 wall of a cut) and three signed
///   counts: each corner minus the last one, the first minus the first of the last added triangle. Removed triangles
///   leave the list, which keeps its order, and added ones follow.
/// * Colours, if they differ: four planes (red, green, blue, alpha) of one byte per vertex, minus the colour before.
/// * Positions. For x, y and z: half a byte per vertex, the lower half first; 15 stands for a longer number. Then the
///   low bytes of all longer numbers, then their high bytes.
///
/// The number of a position is 16 bits with the sign in the lowest bit, modulo 65536: the steps of the vertex minus the
/// expected ones. A vertex that was there before is expected to move by the mean of its two neighbours' steps, a new
/// one to be at their mean: half of the sum plus one, rounded down. The neighbours are the two vertices with the
/// largest numbers below its own that share a triangle, or twice the only one. Without neighbours, the vertex is
/// expected where it was, or at 0. Vertices of no triangle are stored as expected.
class SurfaceCoder {
 public:
  /// Begins with a mesh as the base. @param colors  [vertices] RGBA8, red in the low byte
  void begin(const VisibleMesh& mesh, const std::vector<uint32_t>& colors, PageBytes& out);
  /// Returns whether the grid of the base has room for all shown vertices.
  bool hasRoomFor(const VisibleMesh& mesh) const;
  /// Appends a frame. @param colors  as in begin()   @param is_key  whether it refers to the base
  void add(const VisibleMesh& mesh, const std::vector<uint32_t>& colors, bool is_key, PageBytes& out);
  const PageGrid& grid() const { return grid_; }
  /// Returns whether the last frame shows other triangles than the frame before.
  bool hasNewTriangles() const { return has_new_triangles_; }

 private:
  using Triangle = std::array<uint32_t, 4>;  // corners, then its SurfaceKind
  struct State {
    std::shared_ptr<const VisibleTopology> topology;
    std::vector<Triangle> triangles;  ///< in the decoder's order
    std::vector<uint16_t> steps;      ///< [3 * vertices] x of all, then y, then z
    std::vector<uint32_t> colors;     ///< [vertices]
    size_t vertices() const { return colors.size(); }
  };
  static std::vector<Triangle> trianglesOf(const VisibleTopology& topology);
  void putTriangles(const VisibleTopology& topology, std::vector<Triangle>& shown, PageBytes& out) const;
  void connect();
  void putColors(const State& before, const std::vector<uint32_t>& colors, PageBytes& out) const;
  void putPositions(const State& before, const VisibleMesh& mesh, PageBytes& out);

  PageGrid grid_;
  State base_, last_;
  /// [vertices] the two connected vertices with the largest smaller indices; twice the only one; or kNoNeighbour
  std::vector<std::array<uint32_t, 2>> neighbours_;
  std::vector<bool> is_shown_;  ///< [vertices]
  bool has_new_triangles_ = false;
};

}  // namespace viscera
