// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/model/model.h"

namespace viscera {

struct Scene;

/// What a body's structure makes of a toughness J (docs/cutting.md).
struct Toughness {
  double asked_j_per_m2 = 0;
  double young_modulus_pa = 0;  ///< E of the part
  double spacing_m = 0;         ///< h; mean length of springs where there is no lattice

  /// What the structure carries of it: 2.5 E h at most. Nodes near the edge would be pushed through one another by
  /// more.
  double carried_j_per_m2() const;
  /// The same at a surface that the edge comes in by, where there is tissue ahead only: 0.23 E times the kernel at
  /// most.
  double carriedAtSurface_j_per_m2(double body_kernel_m) const;
  /// Within it nodes share the edge's force, more of them where there is more to carry.
  double kernel_m() const;
  /// The same of a point: what it parts is so wide.
  double pointKernel_m(double width_m) const;
  /// The force of a point that is carried: 0.4 E times its kernel squared at most.
  double ofPoint_n(double width_m, double kernel_m) const;
  /// How much is carried, for a person; empty: all of it. @param key  that asks for it
  std::string note(const std::string& key) const;
};
/// That of its material, away from layers.
Toughness toughnessOf(const Body& body);
/// [1 + parts of the lattice][1 + layers] by the label of a cell, and by layer: the last one is below them.
std::vector<std::vector<Toughness>> toughnesses(const Body& body);
/// The largest of a body's: one edge has one. @param friction_n_per_m  that is carried besides
double kernelOf(const std::vector<std::vector<Toughness>>& toughnesses, double friction_n_per_m = 0);
std::vector<std::string> toughnessNotes(const Body& body);

/// Does the tissue resist blades?
bool resistsBlades(const Body& body);
bool resistsBlades(const Scene& scene);
/// Does some of it not?
bool cutsFreely(const Scene& scene);

}  // namespace viscera
