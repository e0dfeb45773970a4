// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "solver/reference/reference_lattice.h"

namespace viscera::bench {

/// Model of Georgii & Westermann's experiments: one body with explicit connections, without dashpots.
struct GwNetwork {
  std::string name;
  Model model;

  const Body& body() const { return model.bodies[0]; }
  const SpringNetwork& network() const { return *body().network; }
  size_t nodes() const { return model.activeNodes(); }
  size_t slots() const { return model.slots(); }
  size_t springs() const { return network().springs.size(); }
};

/// The smallest, largest and mean number of springs per node.
struct Valences {
  uint32_t least = 0, most = 0;
  double mean = 0;
};
Valences valencesOf(const GwNetwork& network);

/// Creates a square sheet of equilateral triangles in the plane z = 0 (GW Table 2): valence 6 except at its border. It
/// is a membrane 1 mm thick with 10 mm between nodes; nothing is fixed.
GwNetwork regularSheet(uint32_t nodes_per_edge);
/// Creates a sheet with the same nodes, jittered, in an irregular triangulation. Edges of convex quadrangles are
/// flipped at random while valences stay within 3 and 12 (GW 5) and edges within five spacings. The result depends on
/// the size only.
GwNetwork irregularSheet(uint32_t nodes_per_edge);
/// Creates a sheet fixed at its four corners (GW figure 2).
GwNetwork hangingCloth(uint32_t nodes_per_edge);
/// Creates the built-in heart as an explicit lattice (VR05 2.5.1), fixed at its top.
GwNetwork hangingHeart(int nodes);

/// Returns a smooth displacement with strains of some tenths. [slots]
Field deformed(const GwNetwork& network);

/// Returns the largest sum of force magnitudes over a node's springs [N], which an accumulation must be able to
/// represent.
/// @param u_m  [slots]
double largestSum_n(const GwNetwork& network, const Field& u_m);

}  // namespace viscera::bench
