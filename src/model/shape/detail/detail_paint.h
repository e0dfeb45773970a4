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

/// Places of a surface side by side, and what is painted on them: arrays, as eight and more are painted at once.
struct PaintRow {
  static constexpr size_t kMost = 32;
  using Lane = std::array<float, kMost>;
  size_t count = 0;              ///< places; what is beyond is painted too, and means nothing
  std::array<Lane, 3> place{};   ///< x, y, z
  std::array<Lane, 3> normal{};  ///< unit, outward
  std::array<Lane, 3> color{};   ///< linear, where something covers
  Lane cover{};                  ///< 0..1: how much of the body's own colour it hides
  Lane height{};                 ///< above the surface, for its shading normal
};

/// What is painted on a surface, in a frame and a unit of length of its own. Asked by several threads at once.
class SurfacePaint {
 public:
  virtual ~SurfacePaint() = default;
  /// Linear colour of where nothing covers: filters mix it in.
  virtual Vector3f ground() const = 0;
  /// Strokes of it that may show within a ball, by numbers of its own; none: nothing is painted there.
  virtual void findNear(const Vector3f& middle, float radius, std::vector<uint32_t>& near) const = 0;
  /// Those of them that may show within a smaller ball, where unit normals are no farther than `spread` from `normal`.
  virtual void narrow(const std::vector<uint32_t>& near, const Vector3f& middle, float radius, const Vector3f& normal,
                      float spread, std::vector<uint32_t>& nearer) const = 0;
  /// @param near  of a ball that all places of the row lie in
  virtual void paint(const std::vector<uint32_t>& near, PaintRow& row) const = 0;
  /// As paint(), heights alone.
  virtual void raise(const std::vector<uint32_t>& near, PaintRow& row) const = 0;
};

/// Paint, and where it is.
struct PlacedPaint {
  std::shared_ptr<const SurfacePaint> paint;   ///< null: none
  Quaterniond turn = Quaterniond::Identity();  ///< place in the frame of the paint: turn * (p / unit_m) + shift
  Vector3d shift = Vector3d::Zero();
  double unit_m = 1;
};

/// The skin with a picture and a normal map of what is painted on it, as bakeDetail() makes them of a mesh.
/// @param largest_px  side of the square of texels, at most
/// @throws MeshError  the skin has more triangles than fit there
TriangleMesh paintDetail(const TriangleMesh& skin, const PlacedPaint& paint, int largest_px,
                         const Progress& progress = {});

}  // namespace viscera
