// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "solver/reference/reference_lattice.h"
#include "solver/tissue/fields.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/environment_config.h"

namespace viscera {

struct Scene;

/// Wind, forces on bodies and contacts between nodes in float64, written from physics.md 8.
class ReferenceEnvironment {
 public:
  /// @param model  must outlive this
  ReferenceEnvironment(const Model& model, const Scene& scene);

  /// Returns the change of a node's velocity by wind and force_n in dt [m/s].
  Vector3d kick(const ReferenceLattice& lattice, const Field& u_m, const Vector3d& v_m_per_s,
                const Vector3d& wind_m_per_s, double dt_s, uint32_t slot) const;

  /// Two nodes that touch.
  struct Pair {
    uint32_t a, b;      ///< slots, a < b
    double distance_m;  ///< distance that they keep
  };
  bool collides() const { return collision_.enabled; }
  const CollisionConfig& collision() const { return collision_; }
  /// Returns all pairs nearer than their distance of contact, ascending. @param widened  factor on that distance
  std::vector<Pair> touching(const ReferenceLattice& lattice, const Field& u_m, double widened = 1) const;

 private:
  struct Triangle {
    std::array<uint32_t, 3> slots;
    std::array<int64_t, 3> springs;  ///< springs of its edges, as in spring_cut; -1: none
  };
  Vector3d areaAround(const ReferenceLattice& lattice, const Field& u_m, uint32_t slot) const;
  bool mayTouch(const ReferenceLattice& lattice, uint32_t slot) const;
  double distanceBetween(const ReferenceLattice& lattice, uint32_t a, uint32_t b) const;

  WindConfig wind_;
  CollisionConfig collision_;
  std::vector<Vector3d> acceleration_m_per_s2_;  ///< [bodies] acceleration by force_n
  std::vector<double> distance_m_;               ///< [bodies] distance that their nodes keep
  std::vector<size_t> body_;                     ///< [slots]
  std::vector<float> touch_depths_m_;            ///< touchDepths()
  std::vector<std::vector<Triangle>> around_;    ///< [slots] triangles at the node
};

/// Normals of contacts: each is that of the sheet on which one of the two nodes rests.
class ContactNormals {
 public:
  /// @param before_m, now_m  displacements that give the directions, and the depths
  ContactNormals(const ReferenceLattice& lattice, const std::vector<ReferenceEnvironment::Pair>& pairs,
                 const Field& before_m, const Field& now_m);
  Vector3d of(const ReferenceEnvironment::Pair& pair) const;  ///< unit vector from b to a
  int contacts(uint32_t slot) const { return touched_[slot].contacts; }

 private:
  /// Of a node with contacts: the sum of the directions to it, weighted by depth, and the number of contacts.
  struct Touched {
    Vector3d direction = Vector3d::Zero();
    int contacts = 0;
  };
  Vector3d direction(uint32_t a, uint32_t b) const;

  const ReferenceLattice& lattice_;
  const Field &before_m_, &now_m_;
  std::vector<Touched> touched_;  ///< [slots]
};

}  // namespace viscera
