// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <unordered_map>
#include <vector>

#include "viscera/math/types.h"

namespace viscera::bench {

/// A triangulation in the plane z = 0 with edges that can be flipped.
class Triangulation {
 public:
  /// Bounds that flips must preserve.
  struct Bounds {
    uint32_t least_valence, most_valence;  ///< valence of interior nodes
    double longest_m;                      ///< longest edge [m]
  };

  /// @param at_m  [nodes], must outlive this object   @param triangles  every edge belongs to one or two of them
  Triangulation(const std::vector<Vector3d>& at_m, const std::vector<std::array<uint32_t, 3>>& triangles);
  /// Tries to flip edges chosen at random; the number of trials is a multiple of the number of edges.
  void flipAtRandom(const Bounds& bounds, std::mt19937& random);
  /// Returns [triangles], counter-clockwise seen from +z.
  std::vector<std::array<uint32_t, 3>> triangles() const;

 private:
  static constexpr uint32_t kNone = ~0u;
  struct Edge {
    uint32_t a, b;                                 ///< end nodes
    std::array<uint32_t, 2> across{kNone, kNone};  ///< opposite corners of its triangles
  };
  static uint64_t keyOf(uint32_t a, uint32_t b);
  Edge& edge(uint32_t a, uint32_t b) { return edges_[index_.at(keyOf(a, b))]; }
  void addCorner(uint32_t a, uint32_t b, uint32_t across);
  bool mayFlip(const Edge& edge, const Bounds& bounds) const;
  bool isConvex(const Edge& edge) const;
  void flip(size_t e);
  double turn(uint32_t a, uint32_t b, uint32_t c) const;  ///< twice the signed area of a triangle [m2]

  const std::vector<Vector3d>& at_m_;
  std::vector<Edge> edges_;
  std::unordered_map<uint64_t, size_t> index_;
  std::vector<uint32_t> valence_;
};

}  // namespace viscera::bench
