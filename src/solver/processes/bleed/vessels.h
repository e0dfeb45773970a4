// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "solver/processes/burn/heat_graph.h"
#include "viscera/model/model.h"

namespace viscera {

/// Parts of bodies that one fluid leaves where they are cut, as graphs of their nodes (docs/lessons/instruments.md,
/// Which cuts bleed).
class Vessels {
 public:
  /// @param model, graph  must outlive them; the graph is for a conductivity of 1, so the conductance of a link is its
  /// area over its length
  Vessels(const Model& model, const HeatGraph& graph, Fluid fluid = Fluid::kBlood);

  const std::vector<uint32_t>& nodes() const { return nodes_; }          ///< slots in the solver's buffers
  const Vector3d& rest_m(uint32_t slot) const { return rest_m_[slot]; }  ///< tissue frame

  /// Returns the connected component of uncut vessels that a node is in; outside of vessels none.
  std::optional<uint32_t> groupOf(uint32_t slot) const;

  /// Flow out of a node.
  struct Leak {
    uint32_t slot = 0;
    double m3_per_s = 0;
    std::optional<uint32_t> group;  ///< connected component of uncut vessels; none: of any amount of fluid
  };
  struct Leaks {
    std::vector<Leak> of_nodes;
    uint64_t stumps = 0;  ///< number of pieces that they belong to
  };
  /// Returns [groups] the fluid of each connected component of uncut vessels [m3]; 0: any amount.
  const std::vector<double>& supplies_m3() const { return supplies_m3_; }
  /// Finds the leaks. @param is_cut  [links of the graph]   @param is_closed  [slots] blood does not pass these
  Leaks find(const std::vector<uint8_t>& is_cut, const std::vector<uint8_t>& is_closed) const;

 private:
  struct Node {
    double flow_m3_per_s = 0;  ///< out of a stump of its part; 0: not in a vessel
    double section_m2 = 0;     ///< cross-section of that stump
    uint32_t group = 0;        ///< connected component while nothing is cut
    uint32_t part = 0;         ///< number of its part, [part_volumes_m3_]
    bool is_held = false;
  };
  struct Piece {
    std::vector<uint32_t> slots;
    bool is_held = false;
  };
  void addCells(const Body& body, uint32_t offset, Fluid fluid);
  void addNetwork(const Body& body, uint32_t offset, Fluid fluid);
  void addPart(const Body& body, uint32_t offset, const std::vector<uint32_t>& slots, double volume_m3,
               const BleedingConfig& bleeding);
  std::vector<Piece> pieces(const std::vector<uint8_t>& is_cut, const std::vector<uint8_t>& is_closed) const;
  void sumSupplies();
  Vector3d open_m2(uint32_t slot, const std::vector<uint8_t>& is_cut) const;
  template <class Visit>
  void forEachLink(uint32_t slot, const Visit& visit) const;

  const HeatGraph& graph_;
  std::vector<Vector3d> rest_m_;  ///< [slots]
  std::vector<Node> of_slots_;    ///< [slots]
  std::vector<double> area_m2_;   ///< [links] cross-section of the vessel at the link; 0: not in a vessel
  std::vector<uint32_t> nodes_;
  std::vector<uint8_t> group_is_held_;
  std::vector<double> part_volumes_m3_, supplies_m3_;
};

}  // namespace viscera
