// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "model/fracture/toughness.h"
#include "solver/processes/rest_grid.h"
#include "viscera/model/model.h"

namespace viscera {

/// Toughness that a body can carry at a rest position: that of its part, or of a layer below its surface.
class RestToughness {
 public:
  struct Carried {
    double inside_j_per_m2 = 0, at_surface_j_per_m2 = 0;
    /// Returns the carried toughness. @param ahead  1 at a surface through which the edge enters, 0 inside
    double with(double ahead) const { return inside_j_per_m2 + ahead * (at_surface_j_per_m2 - inside_j_per_m2); }
  };
  RestToughness(const Body& body, const RestGrid& nodes);
  const Carried& at(const Vector3d& at_m) const;
  /// Returns the radius within which nodes share the force of an edge, and its friction [m].
  double kernel_m(double friction_n_per_m) const { return kernelOf(by_layer_, friction_n_per_m); }
  /// Returns the friction that is carried everywhere.
  double carriedFriction_n_per_m(double friction_n_per_m) const;
  /// Returns the largest radius of the kernel of a point.
  double pointKernel_m(double width_m) const;
  /// Returns the force of a point there at which it advances.
  double ofPoint_n(const Vector3d& at_m, double width_m, double kernel_m) const;
  double spacing_m() const { return spacing_m_; }  ///< Toughness::spacing_m

 private:
  void findLabels(const Lattice& lattice);
  void findDepths(const Skin& skin);
  double depthAt(const Vector3d& at_m) const;
  struct Layer {
    size_t label, layer;
  };
  Layer layerOf(const Vector3d& at_m) const;

  RestGrid cells_;                                ///< a node of it is the lowest corner of a cell
  std::vector<std::vector<Toughness>> by_layer_;  ///< toughnesses() of the body
  std::vector<std::vector<Carried>> carried_;     ///< carried part of by_layer_
  std::vector<double> layers_m_;                  ///< depths at which layers end
  std::vector<uint16_t> labels_;                  ///< [cells]; empty: there are no parts
  std::vector<float> depths_m_;  ///< [nodes] depth below the surface, negative outside; empty: no layer matters
  double spacing_m_;
};

}  // namespace viscera
