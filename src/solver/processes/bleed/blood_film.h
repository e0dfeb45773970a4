// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "math/archive.h"
#include "solver/processes/burn/heat_graph.h"
#include "viscera/math/state_hash.h"
#include "viscera/model/model.h"

namespace viscera {

constexpr double kBloodViscosity_m2_per_s = 3.3e-6;  // whole blood at a high shear rate, 3.5 mPa s over 1060 kg/m3

/// Blood, or another fluid, on the surface of tissue at rest, as a film that flows down it
/// (docs/lessons/instruments.md, The film). All that was given is on the tissue, was taken, or has dripped off.
class BloodFilm {
 public:
  /// @param model, graph  as of Vessels; must outlive it   @param gravity_m_per_s2  tissue frame
  /// @param viscosity_m2_per_s  kinematic
  BloodFilm(const Model& model, const HeatGraph& graph, const Vector3d& gravity_m_per_s2,
            double viscosity_m2_per_s = kBloodViscosity_m2_per_s);

  /// Sets the cut links. @param is_cut  [links of the graph] their ends are exposed
  void setCuts(const std::vector<uint8_t>& is_cut);
  void give(uint32_t slot, double m3);
  /// Takes a share of a node's fluid away, 0 .. 1. @returns its volume [m3]
  double take(uint32_t slot, double share);
  void step(double dt_s);

  double volume_m3(uint32_t slot) const { return volume_m3_[slot]; }
  double onTissue_m3() const;
  double dripped_m3() const { return dripped_m3_; }
  double thickness_m(uint32_t slot) const;
  /// Returns slots that ever had some of it, in that order.
  const std::vector<uint32_t>& wet() const { return wet_; }

  void reset();
  void persist(Archive& archive);
  void addTo(StateHash& hash) const;

 private:
  struct Surface {
    double area_m2 = 0;  ///< 0: inside tissue
    double width_m = 0;  ///< sum of width times length of the links to neighbours
    bool drips = false;  ///< whether it faces down and no neighbour is lower
  };
  void lookAround(uint32_t slot);
  void substep(double dt_s);
  void run(uint32_t slot, double dt_s);
  void wetten(uint32_t slot);
  template <class Visit>
  void forEachLink(uint32_t slot, const Visit& visit) const;

  const HeatGraph& graph_;
  double speed_per_m2_s_;         ///< speed of a vertical film over the square of its thickness
  std::vector<Vector3d> rest_m_;  ///< [slots]
  std::vector<double> height_m_;  ///< [slots]
  std::vector<double> drip_cos_;  ///< [slots] blood drips from surfaces that face down by more than this cosine
  Vector3d down_;
  std::vector<uint8_t> is_cut_;              ///< [links]
  std::vector<Surface> surface_;             ///< [slots]
  std::vector<double> volume_m3_, gain_m3_;  ///< [slots]
  std::vector<uint8_t> is_wet_;              ///< [slots]
  std::vector<uint32_t> wet_;
  std::vector<std::pair<uint32_t, double>> flows_;  ///< flows from a node: target, amount
  double dripped_m3_ = 0;
};

}  // namespace viscera
