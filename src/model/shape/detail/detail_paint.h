// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "viscera/math/types.h"
#include "viscera/model/shape/solid.h"
#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// Row of points of a surface and the paint on them, as arrays: eight or more are painted at once.
struct PaintRow {
  static constexpr size_t kMost = 32;
  using Lane = std::array<float, kMost>;
  size_t count = 0;                ///< number of points; lanes beyond it are painted too, without meaning
  std::array<Lane, 3> position{};  ///< position, x, y, z
  std::array<Lane, 3> normal{};    ///< unit normal, outward
  std::array<Lane, 3> color{};     ///< linear colour, where something covers
  Lane cover{};                    ///< opacity over the body's own colour, 0..1
  Lane height{};                   ///< height above the surface, for its shading normal
};

/// Paint on a surface, in a frame and a unit of length of its own. Several threads call it at once.
class SurfacePaint {
 public:
  virtual ~SurfacePaint() = default;
  /// Returns the linear colour of uncovered points: filters mix it in.
  virtual Vector3f ground() const = 0;
  /// Finds strokes that may show within a ball, by their indices; none: nothing is painted there.
  virtual void findNear(const Vector3f& middle, float radius, std::vector<uint32_t>& near) const = 0;
  /// Selects those that may show within a smaller ball, where unit normals are no farther than `spread` from `normal`.
  virtual void narrow(const std::vector<uint32_t>& near, const Vector3f& middle, float radius, const Vector3f& normal,
                      float spread, std::vector<uint32_t>& nearer) const = 0;
  /// Paints a row. @param near  strokes of a ball that contains all points of the row
  virtual void paint(const std::vector<uint32_t>& near, PaintRow& row) const = 0;
  /// Computes heights only, as paint() does.
  virtual void raise(const std::vector<uint32_t>& near, PaintRow& row) const = 0;
};

/// Paint with its transform.
struct PlacedPaint {
  std::shared_ptr<const SurfacePaint> paint;   ///< null: no paint
  Quaterniond turn = Quaterniond::Identity();  ///< position in the frame of the paint: turn * (p / unit_m) + shift
  Vector3d shift = Vector3d::Zero();
  double unit_m = 1;
};

/// Returns the surface with an image and a normal map of its paint, as bakeDetail() makes them of a mesh.
/// @param largest_px  largest side of the square of texels
/// @throws MeshError  the surface has more triangles than fit there
TriangleMesh paintDetail(const TriangleMesh& skin, const PlacedPaint& paint, int largest_px,
                         const Progress& progress = {});

}  // namespace viscera
