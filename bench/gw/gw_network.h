// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "solver/reference/reference_lattice.h"

namespace viscera::bench {

/// What Georgii & Westermann's experiments run on: a model of one body with explicit connections, without dashpot.
struct GwNetwork {
  std::string name;
  Model model;

  const Body& body() const { return model.bodies[0]; }
  const SpringNetwork& network() const { return *body().network; }
  size_t nodes() const { return model.activeNodes(); }
  size_t slots() const { return model.slots(); }
  size_t springs() const { return network().springs.size(); }
};

/// The fewest and most springs of a node, and how many.
struct Valences {
  uint32_t least = 0, most = 0;
  double mean = 0;
};
Valences valencesOf(const GwNetwork& network);

/// Square sheet of equilateral triangles in the plane z = 0 (GW Table 2): valence 6 but at its border. A membrane 1 mm
/// thick with 10 mm between nodes; nothing is fixed.
GwNetwork regularSheet(uint32_t nodes_per_edge);
/// The same nodes, jittered, in an irregular triangulation: edges of convex quadrangles were flipped at random while
/// valences stayed within 3 and 12 (GW 5) and edges within five spacings. The same for the same size, always.
GwNetwork irregularSheet(uint32_t nodes_per_edge);
/// A sheet held at its four corners (GW figure 2).
GwNetwork hangingCloth(uint32_t nodes_per_edge);
/// The built-in heart as an explicit lattice (VR05 2.5.1), its top held.
GwNetwork hangingHeart(int nodes);

/// A smooth displacement with strains of some tenths. [slots]
Field deformed(const GwNetwork& network);

/// Largest sum over a node's springs of their forces' magnitudes [N]: what an accumulation must be able to hold.
/// @param u_m  [slots]
double largestSum_n(const GwNetwork& network, const Field& u_m);

}  // namespace viscera::bench
