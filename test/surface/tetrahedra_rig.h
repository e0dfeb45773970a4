// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Bodies of tetrahedra that planes cut, with the wounds that this leaves.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "model/body/network_builder.h"
#include "model/body/network_skin.h"
#include "model/shape/solid/tetrahedra_mesh.h"
#include "model/skin_shapes.h"
#include "surface/wounds/tetrahedra_wound.h"
#include "viscera/layout/links.h"

namespace viscera::testing {

inline Body tetrahedraBody(const TetrahedraMesh& mesh) {
  Body body;
  body.name = "tetrahedra";
  adoptNetwork(tetrahedraNetwork(mesh, body.material), body);
  body.skin = bindNetworkSkin(*body.network, true);
  body.skin.can_be_cut = true;
  return body;
}
inline Body tetrahedraBox(const Vector3i& cells, double spacing_m) {
  return tetrahedraBody(tetrahedraOf(blockSolid(cells, spacing_m)));
}

/// Springs that cuts have taken, as a solver records it. Stays where it was made: its wound refers to the body.
struct WoundedTetrahedra {
  Body body;
  std::vector<layout::NodeBits> nodes;
  std::vector<float> spring_cut;
  TetrahedraWound wound;

  explicit WoundedTetrahedra(Body of)
      : body(std::move(of)),
        nodes(body.lattice.nodes),
        spring_cut(body.network->springs.size()),
        wound(body.skin, *body.network) {}
  WoundedTetrahedra(const WoundedTetrahedra&) = delete;
  WoundedTetrahedra& operator=(const WoundedTetrahedra&) = delete;

  void cutSpring(size_t spring, double share) {
    if (spring_cut[spring] != 0) return;
    spring_cut[spring] = static_cast<float>(share);
    --nodes[body.network->springs[spring].a].lo;
    --nodes[body.network->springs[spring].b].lo;
  }
  /// Cuts every spring that crosses a plane where `within(point)` holds. All in metres.
  template <class Within>
  void cut(const Vector3d& on_plane, const Vector3d& normal, Within within) {
    const SpringNetwork& network = *body.network;
    for (size_t s = 0; s < network.springs.size(); ++s) {
      const Vector3d &a = network.positions_m[network.springs[s].a], &b = network.positions_m[network.springs[s].b];
      const double da = normal.dot(a - on_plane), db = normal.dot(b - on_plane);
      if ((da >= 0) == (db >= 0)) continue;
      const double share = da / (da - db);
      if (within(Vector3d(a + share * (b - a)))) cutSpring(s, std::clamp(share, 0.02, 0.98));
    }
  }
  void cut(const Vector3d& on_plane, const Vector3d& normal) {
    cut(on_plane, normal, [](const Vector3d&) { return true; });
  }
  /// As cut_particles does.
  template <class Within>
  void erase(Within within) {
    const SpringNetwork& network = *body.network;
    for (size_t s = 0; s < network.springs.size(); ++s) {
      const NetworkSpring& ends = network.springs[s];
      if (within(network.positions_m[ends.a]) || within(network.positions_m[ends.b]))
        cutSpring(s, static_cast<double>(layout::kErasedShare));
    }
  }
  void update() { wound.update(nodes.data(), spring_cut.data()); }
  void makeWhole() {
    nodes = body.lattice.nodes;
    std::fill(spring_cut.begin(), spring_cut.end(), 0.0F);
    update();
  }

  using Moves = std::vector<Vector3d>;  ///< [slots] displacements [m]
  Moves still() const { return Moves(nodes.size(), Vector3d::Zero()); }
  Moves shaken(double size_m) const {
    Moves out = still();
    std::mt19937 random(1);
    std::uniform_real_distribution<double> any(-size_m, size_m);
    for (Vector3d& u : out) u = Vector3d(any(random), any(random), any(random));
    return out;
  }
  /// Where the nodes go that lie beyond a plane.
  Moves movedBeyond(const Vector3d& on_plane, const Vector3d& normal, const Eigen::Isometry3d& motion) const {
    Moves out = still();
    for (size_t slot = 0; slot < out.size(); ++slot) {
      const Vector3d& rest = body.network->positions_m[slot];
      if (normal.dot(rest - on_plane) >= 0) out[slot] = motion * rest - rest;
    }
    return out;
  }
  /// An incision held open, as Wounded::heldOpen.
  Moves heldOpen(const Vector3d& middle, const Vector3d& normal, double reach_m, double pull_m) const {
    Moves out = still();
    for (size_t slot = 0; slot < out.size(); ++slot) {
      const Vector3d from = body.network->positions_m[slot] - middle;
      const double near = std::max(0.0, 1 - from.norm() / reach_m), side = normal.dot(from) >= 0 ? 1 : -1;
      out[slot] = pull_m * near * side * normal;
    }
    return out;
  }

  /// What shaders/surface/wound_skin.comp does, in float64.
  Vector3d place(const layout::SkinBinding& s, const Moves& u) const {
    const auto rest = [&](uint32_t slot) { return body.network->positions_m[slot]; };
    const auto now = [&](uint32_t slot) -> Vector3d { return rest(slot) + u[slot]; };
    const Eigen::Matrix3d before = basisOf(rest(s.slot1) - rest(s.slot0), rest(s.slot2) - rest(s.slot0));
    const Eigen::Matrix3d after = basisOf(now(s.slot1) - now(s.slot0), now(s.slot2) - now(s.slot0));
    const Vector3d offset(s.offset_constant.x, s.offset_constant.y, s.offset_constant.z);
    return s.weights.x * now(s.slot0) + s.weights.y * now(s.slot1) + s.weights.z * now(s.slot2) +
           after * (before.transpose() * offset);
  }
  static Eigen::Matrix3d basisOf(const Vector3d& u, const Vector3d& v) {
    Eigen::Matrix3d out = Eigen::Matrix3d::Identity();
    if (u.cross(v).norm() < 1e-9 * u.norm() * v.norm() || u.norm() == 0) return out;  // turns with nothing
    out.col(0) = u.normalized();
    out.col(1) = u.cross(v).normalized();
    out.col(2) = out.col(1).cross(out.col(0));
    return out;
  }
  std::vector<Vector3d> positions(const Moves& u) const {
    std::vector<Vector3d> out;
    for (const layout::SkinBinding& b : body.skin.bindings)
      out.push_back(body.network->positions_m[b.slot0] + u[b.slot0]);
    for (const TetrahedraWound::Vertex& v : wound.added()) out.push_back(place(v.binding, u));
    return out;
  }
  std::vector<uint32_t> triangles() const {
    std::vector<uint32_t> all = wound.skinTriangles();
    all.insert(all.end(), wound.wallTriangles().begin(), wound.wallTriangles().end());
    return all;
  }
  /// Triangles with walls sewn to the skin: by points.
  std::vector<uint32_t> sewn() const {
    std::vector<uint32_t> all = triangles();
    std::map<uint32_t, uint32_t> first;
    for (uint32_t& v : all) {
      if (v < wound.ownVertices()) continue;
      v = first.emplace(wound.added()[v - wound.ownVertices()].point, v).first->second;
    }
    return all;
  }
};

}  // namespace viscera::testing
