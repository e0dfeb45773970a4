// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "solver/processes/attach/fibres.h"
#include "solver/processes/node_masses.h"
#include "solver/processes/port.h"
#include "viscera/model/model.h"

namespace viscera {

/// Forces of fibres on the nodes that carry them, as leapfrog's: those of the positions before the substep that the
/// tissue has just made.
class FibreForces {
 public:
  explicit FibreForces(const Model& model);

  /// Takes the ends of all fibres. Their secants must be set afterwards.
  void embed(const std::vector<Fibre>& fibres);
  size_t count() const { return secant_n_per_m_.size(); }
  /// @param secant_n_per_m  force over opening; 0: the fibre is parted   @param grows_m  opening above which it changes
  void setSecant(size_t fibre, double secant_n_per_m, double grows_m);

  /// Reads the nodes. @param undone_s  substep that is undone: displacements are those at its start; 0: none
  void read(const TissuePort& port, double undone_s);
  Vector3d gap_m(size_t fibre) const;            ///< from the first end to the second
  Vector3d firstEnd_m(size_t fibre) const;       ///< displacement of the first end
  Vector3d displacement_m(uint32_t slot) const;  ///< displacement of a node that carries an end

  /// Adds the impulses of a substep on the nodes.
  /// @param grow  called with the index of a fibre and its gap if the gap exceeds the opening at which it changes;
  /// sets its secant
  template <class Grow>
  void pull(const Grow& grow) {
    impulse_.assign(slots_.size(), Eigen::Array4f::Zero());
    stored_j_ = 0;
    largest_m2_ = 0;
    Nodal u_m, force_n;
    for (const Patch& patch : patches_) {
      for (uint32_t i = 0; i < patch.nodes; ++i) {
        u_m[i] = u_m_[nodes_[patch.first_node + i]];
        force_n[i].setZero();
      }
      const float* weights = &weights_[patch.first_weight];
      for (uint32_t f = patch.first; f < patch.last; ++f, weights += patch.nodes) {
        if (secant_n_per_m_[f] == 0) continue;
        const Eigen::Array4f gap = weighted(patch.nodes, weights, u_m);
        const float squared = gap.matrix().squaredNorm();
        largest_m2_ = std::max(largest_m2_, squared);
        if (squared > grows_m2_[f]) grow(f, Vector3d(gap.head<3>().cast<double>()));
        stored_j_ += 0.5 * static_cast<double>(secant_n_per_m_[f] * squared);
        const Eigen::Array4f force = secant_n_per_m_[f] * gap;
        for (uint32_t i = 0; i < patch.nodes; ++i) force_n[i] -= weights[i] * force;
      }
      for (uint32_t i = 0; i < patch.nodes; ++i) impulse_[nodes_[patch.first_node + i]] += force_n[i];
    }
  }
  /// Writes the impulses. @returns  work on the tissue [J]
  double apply(TissuePort& port, double dt_s);
  double stored_j() const { return stored_j_; }  ///< elastic energy at the last pull()
  /// Returns the largest gap of a fibre at the last pull() [m].
  double largestGap_m() const { return std::sqrt(static_cast<double>(largest_m2_)); }

 private:
  using Nodal = std::array<Eigen::Array4f, 2 * TissuePoint::kMost>;
  /// Fibres that follow each other with the same nodes.
  struct Patch {
    uint32_t first, last;                    ///< fibres, without the last
    uint32_t first_node, nodes, first_ends;  ///< index into nodes_; number of nodes, and of those in the first body
    uint32_t first_weight;                   ///< index into weights_
  };
  /// Returns the sum of weights times vectors.
  static Eigen::Array4f weighted(uint32_t count, const float* weights, const Nodal& vectors) {
    Eigen::Array4f even = Eigen::Array4f::Zero(), odd = Eigen::Array4f::Zero();
    uint32_t i = 0;
    for (; i + 1 < count; i += 2) {
      even += weights[i] * vectors[i];
      odd += weights[i + 1] * vectors[i + 1];
    }
    if (i < count) even += weights[i] * vectors[i];
    return even + odd;
  }
  Vector3d sumOver(size_t fibre, uint32_t first_node, uint32_t last_node) const;
  bool addToPatch(uint32_t fibre, const std::vector<uint32_t>& nodes);

  const NodeMasses masses_;
  std::vector<uint32_t> node_of_;  ///< [slots of the model] index into slots_, valid for those in it
  std::vector<uint32_t> slots_;    ///< slots of the nodes, ascending
  std::vector<Patch> patches_;
  std::vector<uint32_t> patch_of_;                ///< [fibres]
  std::vector<uint32_t> nodes_;                   ///< of patches: indices into slots_
  std::vector<float> weights_;                    ///< of fibres: one per node of the patch, negative in the first body
  std::vector<float> secant_n_per_m_, grows_m2_;  ///< [fibres]
  double stored_j_ = 0;
  float largest_m2_ = 0;
  // Data of a substep, by node; the fourth number is 0.
  std::vector<Eigen::Array4f, Eigen::aligned_allocator<Eigen::Array4f>> u_m_, impulse_;
  std::vector<Vector3f> read_u_, read_v_;
};

}  // namespace viscera
