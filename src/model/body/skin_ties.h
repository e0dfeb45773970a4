// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "viscera/model/body/skin.h"

namespace viscera {

/// Finds the springs that hold a skin edge together when the lattice triangles of its two ends share no node.
class TieFinder {
 public:
  /// @param bindings  of the skin's vertices; slots must be set
  TieFinder(const Lattice& lattice, const std::vector<layout::SkinBinding>& bindings)
      : lattice_(lattice), bindings_(bindings) {}

  /// Appends the ties of edge a-b: none where the ends share a node; else one group of all springs that join them
  /// directly; else, every spring its own group, the shortest path of springs between them.
  /// @return false if there is no path of at most kLongestPath springs
  bool tie(uint32_t a, uint32_t b, std::vector<layout::Tie>& ties);

  /// Tissue farther apart than this along the lattice does not hold a skin edge, which is at most one spacing long.
  /// Where a coarse lattice closes over a narrow crevice, real organs need up to about 20.
  static constexpr int kLongestPath = 24;

 private:
  using Triangle = std::array<uint32_t, 3>;
  struct Path {
    bool found = false;
    std::vector<layout::Tie> ties;
  };
  Triangle slotsOf(uint32_t vertex) const;
  void tieDirectly(const Triangle& from, const Triangle& to, std::vector<layout::Tie>& ties) const;
  Path shortestPath(const Triangle& from, const Triangle& to) const;

  const Lattice& lattice_;
  const std::vector<layout::SkinBinding>& bindings_;
  std::unordered_map<uint64_t, Path> paths_;  // by edge: the triangles on both of its sides need it
};

}  // namespace viscera
