// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "solver/processes/attach/fibres.h"
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
    for (size_t f = 0; f < count(); ++f) {
      if (secant_n_per_m_[f] == 0) continue;
      const Eigen::Array4f gap = gapOf(f);
      const float squared = gap.matrix().squaredNorm();
      if (squared > grows_m2_[f]) grow(f, Vector3d(gap.head<3>().cast<double>()));
      stored_j_ += 0.5 * static_cast<double>(secant_n_per_m_[f] * squared);
      const Eigen::Array4f force = secant_n_per_m_[f] * gap;
      for (uint32_t t = starts_[f]; t < starts_[f + 1]; ++t) impulse_[terms_[t].node] -= terms_[t].weight * force;
    }
  }
  /// Writes the impulses. @returns  work on the tissue [J]
  double apply(TissuePort& port, double dt_s);
  double stored_j() const { return stored_j_; }  ///< elastic energy at the last pull()

 private:
  struct Term {
    uint32_t node;  ///< index into slots_
    float weight;   ///< negative in the first body
  };
  Eigen::Array4f gapOf(size_t fibre) const {
    Eigen::Array4f out = Eigen::Array4f::Zero();
    for (uint32_t t = starts_[fibre]; t < starts_[fibre + 1]; ++t) out += terms_[t].weight * u_m_[terms_[t].node];
    return out;
  }

  std::vector<float> inverse_mass_, mass_kg_;  ///< [slots of the model]; inverse 0 for fixed and missing nodes
  std::vector<uint32_t> node_of_;              ///< [slots of the model] index into slots_, valid for those in it
  std::vector<uint32_t> slots_;                ///< slots of the nodes, ascending
  std::vector<uint32_t> starts_;               ///< [fibres + 1]
  std::vector<Term> terms_;
  std::vector<uint32_t> first_ends_;              ///< [fibres] index of the first term of the second body
  std::vector<float> secant_n_per_m_, grows_m2_;  ///< [fibres]
  double stored_j_ = 0;
  // Data of a substep, by node; the fourth number is 0.
  std::vector<Eigen::Array4f, Eigen::aligned_allocator<Eigen::Array4f>> u_m_, impulse_;
  std::vector<Vector3f> read_u_, read_v_;
};

}  // namespace viscera
