// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/gw/gw_triangulation.h"

#include <algorithm>

namespace viscera::bench {

namespace {

constexpr size_t kTriesPerEdge = 12;
constexpr double kFlattest = 0.05;  // least area of a triangle after a flip, doubled, over its longest edge squared

void replace(std::array<uint32_t, 2>& corners, uint32_t from, uint32_t to) {
  corners[corners[0] == from ? 0 : 1] = to;
}

}  // namespace

Triangulation::Triangulation(const std::vector<Vector3d>& at_m, const std::vector<std::array<uint32_t, 3>>& triangles)
    : at_m_(at_m), valence_(at_m.size(), 0) {
  for (const auto& t : triangles) {
    for (int i = 0; i < 3; ++i) addCorner(t[i], t[(i + 1) % 3], t[(i + 2) % 3]);
  }
}

uint64_t Triangulation::keyOf(uint32_t a, uint32_t b) {
  return (uint64_t{std::min(a, b)} << 32) | std::max(a, b);
}

void Triangulation::addCorner(uint32_t a, uint32_t b, uint32_t across) {
  const auto [at, is_new] = index_.emplace(keyOf(a, b), edges_.size());
  if (is_new) {
    edges_.push_back({a, b});
    ++valence_[a];
    ++valence_[b];
  }
  replace(edges_[at->second].across, kNone, across);
}

double Triangulation::turn(uint32_t a, uint32_t b, uint32_t c) const {
  return (at_m_[b] - at_m_[a]).cross(at_m_[c] - at_m_[a]).z();
}

/// Returns whether the diagonals of the two triangles cross and the flipped triangles are not slivers.
bool Triangulation::isConvex(const Edge& edge) const {
  const auto [c, d] = edge.across;
  const double a_side = turn(c, d, edge.a), b_side = turn(c, d, edge.b);
  const double least_m2 = kFlattest * (at_m_[c] - at_m_[d]).squaredNorm();
  return a_side * b_side < 0 && std::min(std::abs(a_side), std::abs(b_side)) > least_m2;
}

bool Triangulation::mayFlip(const Edge& edge, const Bounds& bounds) const {
  const auto [c, d] = edge.across;
  if (c == kNone || d == kNone) return false;
  if (std::min(valence_[edge.a], valence_[edge.b]) <= bounds.least_valence) return false;
  if (std::max(valence_[c], valence_[d]) >= bounds.most_valence) return false;
  return (at_m_[c] - at_m_[d]).norm() <= bounds.longest_m && isConvex(edge) && index_.count(keyOf(c, d)) == 0;
}

void Triangulation::flip(size_t e) {
  const Edge old = edges_[e];
  const auto [c, d] = old.across;
  for (uint32_t corner : {c, d}) {
    const uint32_t other = corner == c ? d : c;
    replace(edge(old.a, corner).across, old.b, other);
    replace(edge(old.b, corner).across, old.a, other);
  }
  --valence_[old.a];
  --valence_[old.b];
  ++valence_[c];
  ++valence_[d];
  index_.erase(keyOf(old.a, old.b));
  index_.emplace(keyOf(c, d), e);
  edges_[e] = {c, d, {old.a, old.b}};
}

void Triangulation::flipAtRandom(const Bounds& bounds, std::mt19937& random) {
  for (size_t i = 0; i < kTriesPerEdge * edges_.size(); ++i) {
    const size_t e = random() % edges_.size();  // std::uniform_int_distribution differs between libraries
    if (mayFlip(edges_[e], bounds)) flip(e);
  }
}

std::vector<std::array<uint32_t, 3>> Triangulation::triangles() const {
  std::vector<std::array<uint32_t, 3>> out;
  for (const Edge& edge : edges_) {
    for (uint32_t across : edge.across) {
      // Of the three edges of a triangle, only the one opposite its highest corner outputs it.
      if (across == kNone || across < std::max(edge.a, edge.b)) continue;
      const bool left = turn(edge.a, edge.b, across) > 0;
      out.push_back({left ? edge.a : edge.b, left ? edge.b : edge.a, across});
    }
  }
  return out;
}

}  // namespace viscera::bench
