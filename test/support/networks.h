// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <random>
#include <vector>

#include "model/body/network_builder.h"
#include "model/shape/mesh/plain_meshes.h"

namespace viscera::test {

/// Returns a sheet of rows x columns nodes (sheetMesh) of structure surface, flat in z = 0 around the origin; nothing
/// fixed, no surface mesh. E 100 kPa and 1 mm thick unless given.
inline Body clothBody(int rows, int columns, double spacing_m, double bending_ratio = 0, double thickness_m = 1e-3) {
  Body body;
  body.name = "cloth";
  body.material.young_modulus_pa = 1e5;
  body.material.density_kg_per_m3 = 1000;
  adoptNetwork(membraneNetwork(sheetMesh(rows, columns, spacing_m), body.material, thickness_m, bending_ratio), body);
  return body;
}

/// Fixes the nodes nearest to points of the tissue frame. Returns their slots.
inline std::vector<uint32_t> fixNearest(Body& body, const std::vector<Vector3d>& points_m) {
  std::vector<uint32_t> fixed;
  for (const Vector3d& point : points_m) {
    const auto& slots = body.lattice.active_slots;
    fixed.push_back(*std::min_element(slots.begin(), slots.end(), [&](uint32_t a, uint32_t b) {
      return (restPosition(body, a) - point).norm() < (restPosition(body, b) - point).norm();
    }));
    body.lattice.nodes[fixed.back()].lo |= layout::kFixedBit;
  }
  return fixed;
}

struct GraphOptions {
  size_t hub_valence = 200;    ///< links of one node, limited by the number of nodes
  size_t islands = 2;          ///< pieces without a spring to the others, in addition to the first
  size_t duplicates = 4;       ///< number of springs that duplicate another
  size_t zero_lengths = 4;     ///< springs of rest length 0 between nodes at one position; limited by the leaves
  double prestrain = 0;        ///< rest lengths differ from the distance at rest by up to this share of it
  double fixed_share = 0;      ///< share of the nodes that are fixed
  double size_m = 0.1;         ///< edge of the cube that contains the nodes
  double mean_n_per_m = 20;    ///< springs have 0.5..1.5 of it
  double mean_mass_kg = 2e-3;  ///< nodes have 0.5..1.5 of it
};

/// A random network of `nodes` nodes and at least `springs` springs, or as many more as needed to connect every piece.
/// Every piece is connected and has nodes with one link; the first also has a hub.
class RandomGraph {
 public:
  RandomGraph(size_t nodes, size_t springs, uint32_t seed, const GraphOptions& options)
      : random_(seed), options_(options) {
    for (size_t i = 0; i < nodes; ++i) {
      network_.positions_m.push_back(options.size_m * Vector3d(share(), share(), share()));
      network_.masses_kg.push_back(options.mean_mass_kg * (0.5 + share()));
    }
    divide(nodes);
    for (size_t p = 0; p < pieces_.size(); ++p) join(pieces_[p], p == 0 ? options.hub_valence : 0);
    addSpecial();
    while (network_.springs.size() < springs && nodes > 1) addWithin(pieces_[random_() % pieces_.size()]);
    addLengths();
  }

  Body body() {
    Body body;
    body.name = "graph";
    adoptNetwork(network_, body);
    for (const uint32_t slot : body.lattice.active_slots) {
      if (share() < options_.fixed_share) body.lattice.nodes[slot].lo |= layout::kFixedBit;
    }
    return body;
  }

 private:
  using Piece = std::vector<uint32_t>;

  double share() { return static_cast<double>(random_() >> 5) / (1u << 27); }

  /// Divides the nodes into pieces. Islands are small: four nodes each, if there are enough.
  void divide(size_t nodes) {
    constexpr size_t kIsland = 4;
    const size_t islands = nodes >= 2 * kIsland * (options_.islands + 1) ? options_.islands : 0;
    pieces_.resize(islands + 1);
    for (uint32_t i = 0; i < nodes; ++i) {
      const size_t from_end = (nodes - 1 - i) / kIsland;
      pieces_[from_end < islands ? from_end + 1 : 0].push_back(i);
    }
  }

  /// Connects a piece: all but the last eighth of the nodes form a chain, the last ones have one spring each.
  void join(const Piece& piece, size_t hub_valence) {
    const size_t core = coreOf(piece);
    for (size_t i = 1; i < piece.size(); ++i) add(piece[i], piece[i < core ? i - 1 : random_() % core]);
    for (size_t i = 2; i < core && i <= hub_valence; ++i) add(piece[0], piece[i]);
  }
  static size_t coreOf(const Piece& piece) { return std::max<size_t>(1, piece.size() - piece.size() / 8); }

  void addWithin(const Piece& piece) {
    const size_t core = coreOf(piece);
    if (core < 2) return add(pieces_[0][0], pieces_[0][1]);
    const size_t a = random_() % core, b = (a + 1 + random_() % (core - 1)) % core;
    add(piece[a], piece[b]);
  }

  void addSpecial() {
    const size_t first = network_.springs.size();
    for (size_t i = 0; i < options_.duplicates && first > 0; ++i) {
      const NetworkSpring& spring = network_.springs[random_() % first];
      add(spring.a, spring.b);
    }
    // A leaf has one spring only: moving its node separates no other spring of length zero.
    const Piece& piece = pieces_[0];
    for (size_t i = coreOf(piece); i < piece.size() && i < coreOf(piece) + options_.zero_lengths; ++i) {
      const auto its = std::find_if(network_.springs.begin(), network_.springs.end(),
                                    [&](const NetworkSpring& spring) { return spring.b == piece[i]; });
      network_.positions_m[piece[i]] = network_.positions_m[its->a];
    }
  }

  void add(uint32_t a, uint32_t b) {
    NetworkSpring spring;
    spring.a = std::min(a, b);
    spring.b = std::max(a, b);
    spring.stiffness_n_per_m = options_.mean_n_per_m * (0.5 + share());
    network_.springs.push_back(spring);
  }

  void addLengths() {
    for (NetworkSpring& spring : network_.springs) {
      const double distance_m = (network_.positions_m[spring.b] - network_.positions_m[spring.a]).norm();
      spring.rest_length_m = distance_m * (1 + options_.prestrain * (2 * share() - 1));
    }
  }

  std::mt19937 random_;
  GraphOptions options_;
  SpringNetwork network_;
  std::vector<Piece> pieces_;
};

inline Body graphBody(size_t nodes, size_t springs, uint32_t seed, const GraphOptions& options = {}) {
  return RandomGraph(nodes, springs, seed, options).body();
}

}  // namespace viscera::test
