// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Bodies on lattices that planes cut, with the resulting wounds: boxes, balls and organs alike.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "model/shape/mesh/box_surface.h"
#include "model/skin_shapes.h"
#include "surface/reference_mapping.h"
#include "surface/wounds/body_wound.h"
#include "viscera/layout/links.h"
#include "viscera/model/model.h"

namespace viscera::testing {

/// A lattice with cut springs, as a solver records them. It must not move: its wound refers to it.
struct Wounded {
  Lattice lattice;
  Skin skin;
  std::vector<layout::NodeBits> nodes;
  std::vector<float> axial_cut;
  BodyWound wound;

  Wounded(Lattice of, Skin with)
      : lattice(std::move(of)),
        skin(std::move(with)),
        nodes(lattice.nodes),
        axial_cut(3 * nodes.size()),
        wound(skin, lattice) {}
  explicit Wounded(const BoundSkin& bound) : Wounded(bound.lattice, bound.skin) {}
  explicit Wounded(const Body& body) : Wounded(body.lattice, body.skin) {}
  Wounded(const Wounded&) = delete;
  Wounded& operator=(const Wounded&) = delete;

  /// Cuts every spring that crosses a plane where `within(point)` holds. All in metres.
  template <class Within>
  void cut(const Vector3d& on_plane, const Vector3d& normal, Within within) {
    for (const uint32_t slot : lattice.active_slots) {
      for (uint32_t spring = 0; spring < layout::kSpringsPerNode; ++spring) {
        if (springCount(nodes[slot], spring) == 0) continue;
        const int64_t other = lattice.neighborSlot(slot, spring);
        if (other < 0) continue;
        const Vector3d a = lattice.restPosition(slot), b = lattice.restPosition(static_cast<uint32_t>(other));
        const double da = normal.dot(a - on_plane), db = normal.dot(b - on_plane);
        if ((da >= 0) == (db >= 0)) continue;
        const double share = da / (da - db);
        if (!within(Vector3d(a + share * (b - a)))) continue;
        setSpringCount(nodes[slot], spring, 0);
        nodes[slot].lo |= layout::kSeveredBit;
        if (spring < layout::kAxialSprings && spring % 2 == 0)
          axial_cut[3 * slot + spring / 2] = static_cast<float>(share);
      }
    }
  }
  void cut(const Vector3d& on_plane, const Vector3d& normal) {
    cut(on_plane, normal, [](const Vector3d&) { return true; });
  }
  /// Removes all springs of the nodes where `within(point)` holds.
  template <class Within>
  void erase(Within within) {
    for (const uint32_t slot : lattice.active_slots) {
      if (!within(lattice.restPosition(slot))) continue;
      nodes[slot].lo |= layout::kSeveredBit;
      for (uint32_t spring = 0; spring < layout::kSpringsPerNode; ++spring) {
        setSpringCount(nodes[slot], spring, 0);
        const int64_t other = lattice.neighborSlot(slot, spring);
        if (other < 0) continue;
        const auto far = static_cast<size_t>(other);
        setSpringCount(nodes[far], oppositeSpring(spring), 0);
        nodes[far].lo |= layout::kSeveredBit;
        if (spring < layout::kAxialSprings)
          axial_cut[3 * (spring % 2 == 0 ? slot : far) + spring / 2] = layout::kErasedShare;
      }
    }
  }
  void update() { wound.update(nodes.data(), axial_cut.data()); }
  void makeWhole() {
    nodes = lattice.nodes;
    axial_cut.assign(axial_cut.size(), 0);
    update();
  }

  std::vector<Vector3d> positions(const std::vector<layout::vec4>& displacement_m) const {
    const ReferenceMapping mapping(lattice, displacement_m, nodes);
    std::vector<Vector3d> out;
    for (const layout::SkinBinding& binding : wound.bindings()) out.push_back(mapping.map(binding).position_m);
    return out;
  }
  std::vector<layout::vec4> still() const { return std::vector<layout::vec4>(nodes.size(), layout::vec4{0, 0, 0, 0}); }
  std::vector<layout::vec4> shaken(double size_m) const {
    std::vector<layout::vec4> out = still();
    std::mt19937 random(1);
    std::uniform_real_distribution<float> any(-static_cast<float>(size_m), static_cast<float>(size_m));
    for (layout::vec4& u : out) u = {any(random), any(random), any(random), 0};
    return out;
  }
  /// Returns displacements of an incision held open: both sides are pulled away, most in its middle, not at all at its
  /// ends.
  std::vector<layout::vec4> heldOpen(const Vector3d& middle, const Vector3d& normal, double reach_m, double pull_m) {
    std::vector<layout::vec4> out = still();
    for (const uint32_t slot : lattice.active_slots) {
      const Vector3d from = lattice.restPosition(slot) - middle;
      const double near = std::max(0.0, 1 - from.norm() / reach_m), side = normal.dot(from) >= 0 ? 1 : -1;
      const Vector3f u = (pull_m * near * side * normal).cast<float>();
      out[slot] = {u.x(), u.y(), u.z(), 0};
    }
    return out;
  }
  std::vector<uint32_t> triangles() const {
    std::vector<uint32_t> all = wound.skinTriangles();
    all.insert(all.end(), wound.wallTriangles().begin(), wound.wallTriangles().end());
    return all;
  }
};

/// Returns a box of 8 x 7 x 6 cells of a centimetre from the origin, its surface mesh not aligned with the lattice.
/// @param open  without its top
inline Wounded woundedBox(bool open = false) {
  TriangleMesh mesh = boxSurface(Vector3d::Zero(), Vector3d(0.08, 0.07, 0.06), {19, 17, 15});
  const auto on_top = [&](const std::array<uint32_t, 3>& t) {
    return open && std::all_of(t.begin(), t.end(), [&](uint32_t v) { return mesh.positions_m[v].z() > 0.0599F; });
  };
  mesh.triangles.erase(std::remove_if(mesh.triangles.begin(), mesh.triangles.end(), on_top), mesh.triangles.end());
  return Wounded(bindTo(blockSolid({8, 7, 6}, 0.01), mesh));
}

/// Returns ten normals of cuts: along an axis, between two and between three of them, and seven random ones.
inline std::vector<Vector3d> anglesOfCuts() {
  std::vector<Vector3d> out = {Vector3d::UnitX(), Vector3d(1, 1, 0), Vector3d(1, 1, 1)};
  std::mt19937 random(7);
  std::normal_distribution<double> any;
  while (out.size() < 10) out.push_back(Vector3d(any(random), any(random), any(random)));
  for (Vector3d& v : out) v.normalize();
  return out;
}

}  // namespace viscera::testing
