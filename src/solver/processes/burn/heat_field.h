// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "math/archive.h"
#include "solver/processes/burn/heat_graph.h"
#include "viscera/math/state_hash.h"
#include "viscera/solver/burn_report.h"

namespace viscera {

/// Constants of soft tissue, with their sources in docs/lessons/instruments.md, Constants of heat.
struct HeatConstants {
  double body_c = 37;
  double conductivity_w_per_m_k = 0.52;
  double heat_j_per_kg_k = 3540;
  double water_share = 0.74;  ///< share of the mass that is water
  double water_j_per_kg_k = 4180;
  double boiling_c = 100;
  double boiling_j_per_kg = 2.257e6;
  double perfusion_per_s = 6.4e-3;  ///< volume of blood per volume of tissue
  double blood_j_per_m3_k = 3.8e6;
  double air_w_per_m2_k = 15;   ///< heat transfer to air, of surfaces warmer than the body
  double dose_per_s = 7.39e39;  ///< Arrhenius factor
  double dose_j_per_mol = 2.577e5;
  double dose_above_c = 43;  ///< below it the fit of the two would coagulate living tissue
};

/// Heat, boiled water and dose of every node: Pennes' equation, stepped explicitly, for the nodes near burns only.
class HeatField {
 public:
  explicit HeatField(const Model& model, const HeatConstants& constants = {});

  /// Sets the cut springs: links along them carry no heat.
  void setCuts(const CutSprings& cuts);
  void give(uint32_t slot, double joule);
  void step(double dt_s);

  double temperature_c(uint32_t slot) const;
  double coagulated(uint32_t slot) const;                                   ///< coagulated share, by the dose
  bool isCoagulated(uint32_t slot) const { return nodes_[slot].dose > 1; }  ///< more than 63 % of it
  double boiled(uint32_t slot) const;                                       ///< share of the water that has boiled
  /// Returns slots that were ever heated, in that order.
  const std::vector<uint32_t>& touched() const { return touched_; }
  bool isWarm() const { return !active_.empty(); }  ///< some node is warmer than the body
  BurnReport seen() const;                          ///< state without the separated tissue
  const HeatGraph& graph() const { return graph_; }
  const HeatConstants& constants() const { return constants_; }

  void reset();
  void persist(Archive& archive);
  void addTo(StateHash& hash) const;

 private:
  struct Node {
    double heat_j = 0;     ///< heat above body temperature, without that of steam
    double boiled_kg = 0;  ///< boiled part of its water
    double dose = 0;       ///< Arrhenius' integral
  };
  double capacity_j_per_k(uint32_t slot) const;
  double rise_k(uint32_t slot) const;  ///< above body temperature
  double lossRate_w_per_k(uint32_t slot) const;
  void touch(uint32_t slot);
  void widen();
  void narrow();
  double fastest_per_s() const;
  void substep(double dt_s);
  void boil(uint32_t slot);
  bool isOpen(const HeatGraph::Link& link) const { return closed_.empty() || !closed_[link.spring]; }
  template <class Visit>
  void forEachNeighbor(uint32_t slot, const Visit& visit) const;

  HeatConstants constants_;
  HeatGraph graph_;
  std::vector<uint8_t> closed_;                  ///< [springs] cut; empty: no spring is
  std::vector<Node> nodes_;                      ///< [slots]
  std::vector<uint8_t> is_touched_, is_active_;  ///< [slots]
  std::vector<uint32_t> touched_, active_;       ///< all heated ones; the warm ones and those near them
  std::vector<double> rise_k_, gain_j_;          ///< [slots] data of a substep
  BurnReport sums_;
};

}  // namespace viscera
