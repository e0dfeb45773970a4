// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "model/shape/detail/detail_paint.h"

namespace viscera {

/// Coronary arteries and veins on a heart, in grooves with fat, as a surgeon sees them. The anterior descending artery
/// with its diagonals is between the ventricles; the right and the circumflex artery are between atria and ventricles.
/// There are also the posterior descending artery, marginals and twigs, each with a vein next to it. Lengths in the
/// heart's own frame are fractions of its length, apex at the origin, base at z = 1.
class HeartVessels : public SurfacePaint {
 public:
  /// Distance to the tissue, negative inside, in the heart's own frame; and whether a position belongs to the right
  /// ventricle.
  using Field = std::function<double(const Vector3d&)>;
  using IsRight = std::function<bool(const Vector3d&)>;
  HeartVessels(const Field& field, const IsRight& is_right);

  Vector3f ground() const override;
  void findNear(const Vector3f& middle, float radius, std::vector<uint32_t>& near) const override;
  void narrow(const std::vector<uint32_t>& near, const Vector3f& middle, float radius, const Vector3f& normal,
              float spread, std::vector<uint32_t>& nearer) const override;
  void paint(const std::vector<uint32_t>& near, PaintRow& row) const override;
  void raise(const std::vector<uint32_t>& near, PaintRow& row) const override;

 private:
  enum class Kind { kArtery, kVein };
  struct Point {
    Vector3d at, normal;
    double radius = 0, fat = 0;  ///< half the width of the fat around it
  };
  /// Straight piece of a vessel as it is painted, from `a` along `way`.
  struct Piece {
    Vector3f a, direction, normal;
    float per_path2, radius, radius_change, fat, fat_change;
    float vein;  ///< 1 for veins, else 0
  };
  /// Sums over all pieces at the points of a row.
  struct Sums;
  Sums sumsOf(const std::vector<uint32_t>& near, const PaintRow& row) const;
  bool reaches(uint32_t index, const Vector3f& middle, float radius) const;
  Vector3d outermost(double z, double turn, int halvings) const;
  Vector3d normalAt(const Vector3d& position) const;
  Point onSurface(double z, double turn, double radius, double fat) const;
  double groove(double z, double from, double to) const;
  void addPath(const std::vector<Point>& points, Kind kind);
  void listCells();
  void addWithVein(const std::vector<Point>& points);
  void addBranch(double z, double turn, double to_z, double to_turn, double radius, int order, uint32_t seed);

  Field field_;
  IsRight is_right_;
  std::vector<Piece> pieces_;
  std::unordered_map<uint64_t, std::vector<uint32_t>> cells_;  ///< pieces that reach into a cell of space
};

}  // namespace viscera
