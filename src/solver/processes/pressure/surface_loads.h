// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "solver/processes/node_masses.h"
#include "solver/processes/port.h"
#include "solver/processes/pressure/cavities.h"
#include "solver/processes/rest_elements.h"
#include "viscera/model/model.h"

namespace viscera {

/// Forces of pressures on triangles, as they are now, on the nodes that carry their vertices: leapfrog's, of the
/// positions before the substep that the tissue has just made. Forces of one pressure on a closed surface sum to zero,
/// and are the slope of the pressure times the volume within.
class SurfaceLoads {
 public:
  /// @param surfaces  must outlive them
  SurfaceLoads(const Model& model, const std::vector<Cavities>& surfaces);

  /// Returns the first vertex of a surface; the centres of its rims follow its own.
  uint32_t firstVertex(size_t surface) const { return first_vertex_[surface]; }
  uint32_t firstTriangle(size_t surface) const { return first_triangle_[surface]; }
  /// Sets the point that carries a vertex. @param vertex  among those of all surfaces, not a centre
  void carry(uint32_t vertex, const TissuePoint& by);
  /// Ends changes of carry().
  void gatherNodes();
  void setPressure(uint32_t triangle, double pressure_pa) { pressure_pa_[triangle] = static_cast<float>(pressure_pa); }

  /// Reads the nodes and moves the vertices. @param undone_s  substep that is undone; 0: none
  void read(const TissuePort& port, double undone_s);
  void atRest();  ///< moves the vertices to where they are at rest
  /// Writes the impulses of a substep. @returns  work on the tissue [J]
  double apply(TissuePort& port, double dt_s);

  Vector3d position_m(uint32_t vertex) const { return at_m_[vertex].head<3>().cast<double>(); }
  const std::array<uint32_t, 3>& triangle(uint32_t t) const { return triangles_[t]; }
  /// Returns the area vector of a triangle, from the fluid into the tissue [m2].
  Vector3d area_m2(uint32_t triangle) const;
  /// Returns the forces of the last apply() on nodes, with those on fixed ones [N]: slots and forces.
  const std::vector<uint32_t>& slots() const { return slots_; }
  Vector3d force_n(size_t node) const { return force_n_[node].head<3>().cast<double>(); }

 private:
  void move();
  using Vectors = std::vector<Eigen::Array4f, Eigen::aligned_allocator<Eigen::Array4f>>;
  struct Rim {
    uint32_t centre;
    std::vector<uint32_t> vertices;
  };
  struct Carrier {
    std::array<uint32_t, TissuePoint::kMost> slots{}, nodes{};  ///< nodes: index into slots_
    std::array<float, TissuePoint::kMost> weights{};
  };
  void loadTriangles();

  const NodeMasses masses_;
  std::vector<uint32_t> first_vertex_, first_triangle_;
  std::vector<Carrier> carriers_;  ///< [vertices]
  std::vector<Rim> rims_;
  std::vector<std::array<uint32_t, 3>> triangles_;
  std::vector<float> pressure_pa_;       ///< [triangles]
  std::vector<uint32_t> slots_;          ///< slots of the nodes, ascending
  Vectors rest_m_, at_m_, on_vertex_n_;  ///< [vertices]
  Vectors u_m_, force_n_;                ///< [nodes]
  std::vector<Vector3f> read_u_, read_v_;
};

}  // namespace viscera
