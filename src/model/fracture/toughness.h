// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/model/model.h"

namespace viscera {

struct Scene;

/// Toughness J as the structure of a body represents it (docs/cutting.md).
struct Toughness {
  double asked_j_per_m2 = 0;
  double young_modulus_pa = 0;  ///< Young's modulus E of the part [Pa]
  double spacing_m = 0;         ///< spacing h [m]; mean length of springs where there is no lattice

  /// Returns the toughness that the structure carries: at most 2.5 E h. More would push nodes near the edge through one
  /// another.
  double carried_j_per_m2() const;
  /// Returns the toughness carried at a surface through which the edge enters, with tissue ahead only: at most 0.23 E
  /// times the kernel.
  double carriedAtSurface_j_per_m2(double body_kernel_m) const;
  /// Returns the radius within which nodes share the edge's force; it grows with the force.
  double kernel_m() const;
  /// Returns the same for a point that makes a cut of this width.
  double pointKernel_m(double width_m) const;
  /// Returns the force of a point that is carried: at most 0.4 E times its kernel squared.
  double ofPoint_n(double width_m, double kernel_m) const;
  /// Returns how much is carried, for a person; empty: all of it. @param key  scene key that requests it
  std::string note(const std::string& key) const;
};
/// Returns the toughness of the body's material, away from layers.
Toughness toughnessOf(const Body& body);
/// Returns [1 + parts of the lattice][1 + layers] by the label of a cell, and by layer: the last one is below them.
std::vector<std::vector<Toughness>> toughnesses(const Body& body);
/// Returns the largest kernel of a body: one edge has one kernel. @param friction_n_per_m  carried in addition
double kernelOf(const std::vector<std::vector<Toughness>>& toughnesses, double friction_n_per_m = 0);
std::vector<std::string> toughnessNotes(const Body& body);

/// Returns whether the tissue resists blades.
bool resistsBlades(const Body& body);
bool resistsBlades(const Scene& scene);
/// Returns whether some body does not resist blades.
bool cutsFreely(const Scene& scene);

}  // namespace viscera
