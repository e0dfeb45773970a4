// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "model/shape/detail_paint.h"

namespace viscera {

/// Coronary arteries and veins on a heart, in grooves with fat, as a surgeon sees them: the anterior descending artery
/// between the ventricles with its diagonals, the right and the circumflex artery between atria and ventricles, the
/// posterior descending one, their marginals and twigs, each with a vein beside it. Lengths in the heart's own frame
/// are fractions of its length, apex at the origin, base at z = 1.
class HeartVessels {
 public:
  /// Distance to the tissue, negative within, in the heart's own frame, and whether a place is of the right ventricle.
  using Field = std::function<double(const Vector3d&)>;
  using IsRight = std::function<bool(const Vector3d&)>;
  HeartVessels(const Field& field, const IsRight& is_right);

  /// What is painted on a place of the heart, lengths as fractions of the heart's.
  /// @param place, normal  in the heart's own frame
  PaintedSpot at(const Vector3d& place, const Vector3d& normal) const;
  size_t segments() const { return pieces_.size(); }

 private:
  enum class Kind { kArtery, kVein };
  struct Point {
    Vector3d at, normal;
    double radius = 0, fat = 0;  ///< half the width of the fat around it
  };
  struct Piece {
    Point a, b;
    Kind kind;
  };
  Point onSurface(double z, double turn, double radius, double fat) const;
  double groove(double z, double from, double to) const;
  void addPath(const std::vector<Point>& points, Kind kind);
  void findNear();
  void addWithVein(const std::vector<Point>& points);
  void addBranch(double z, double turn, double to_z, double to_turn, double radius, int order, uint32_t seed);

  Field field_;
  IsRight is_right_;
  std::vector<Piece> pieces_;
  std::unordered_map<uint64_t, std::vector<uint32_t>> near_;  ///< which pieces reach into a cell of space
};

}  // namespace viscera
