// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "viscera/model/model.h"
#include "viscera/solver/state.h"

namespace viscera {

/// A spring of the tissue, of any structure.
struct BurntSpring {
  static constexpr uint32_t kOfLattice = ~0U;
  uint32_t a = 0, b = 0;  ///< slots in the solver's buffers
  uint32_t number = 0;    ///< index in CutSprings::spring_cut, or kOfLattice: a's spring of that lattice
  uint32_t of_a = 0;      ///< index of the spring at a, in an implicit lattice
  double stiffness_n_per_m = 0;
  double rest_length_m = 0;
  /// Ratio of the resistance of the cells' volumes to isotropic shrinkage to that of the springs.
  double volume_ratio = 0;

  bool isCut(const CutSprings& cuts) const;
};

/// Returns all springs of a model that carry tissue, without those against bending.
std::vector<BurntSpring> springsOf(const Model& model);

/// Conduction of heat through tissue at rest, by finite volumes around the nodes (docs/lessons/instruments.md, Heat).
struct HeatGraph {
  struct Link {
    uint32_t a = 0, b = 0;  ///< slots in the solver's buffers
    uint32_t spring = 0;    ///< spring along which it conducts
    double w_per_k = 0;
  };
  HeatGraph(const Model& model, double conductivity_w_per_m_k);

  std::vector<BurntSpring> springs;
  std::vector<Link> links;
  std::vector<uint32_t> starts, links_of;           ///< [slots + 1], [2 * links]: the links of each slot
  std::vector<uint32_t> spring_starts, springs_of;  ///< springs of each slot, in the same form
  std::vector<double> mass_kg;                      ///< [slots] 0 in slots without a node
  std::vector<double> volume_m3;                    ///< [slots]
  std::vector<double> exposed_m2;                   ///< [slots] area on the surface of whole tissue
  std::vector<double> spacing_m;                    ///< [bodies] spacing of lattices, else mean length of springs

 private:
  void addMasses(const Body& body, uint32_t offset);
  void addCells(const Lattice& lattice, uint32_t offset, size_t first, size_t end, double conductivity);
  void addNetwork(const SpringNetwork& network, double young_modulus_pa, uint32_t offset, size_t first, size_t end,
                  double conductivity);
};

}  // namespace viscera
