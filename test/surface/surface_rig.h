// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A surface over a state that the test writes itself: no solver.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "model/body/network_skin.h"
#include "model/skin_shapes.h"
#include "solver/gpu/buffers/lattice_buffers.h"
#include "surface/surface.h"
#include "viscera/solver/solver.h"

namespace viscera::testing {

inline Body makeBody(const Solid& solid, const TriangleMesh& mesh, Weights weights = Weights::kCell) {
  Body body;
  body.lattice = buildLattice(solid, weights);
  body.skin = bindSkin(mesh, body.lattice, solid);
  return body;
}

/// Returns a ball with partially filled cells at the surface.
inline Body filledBallBody(const Vector3d& center_m, double radius_m, double spacing_m, int n = 10) {
  const TriangleMesh mesh = weldedSphereMesh(center_m, radius_m, n);
  return makeBody(voxeliseByMoments(mesh, spacing_m), mesh);
}

/// Returns the body, which has a network, with the surface mesh that shows it.
inline Body withNetworkSkin(Body body, bool can_be_cut = true) {
  body.skin = bindNetworkSkin(*body.network, can_be_cut);
  return body;
}

/// Bodies with nodes moved by a function of (body, rest position).
class SurfaceRig {
 public:
  explicit SurfaceRig(std::vector<Body> bodies)
      : model{std::move(bodies)}, surface(model), buffers_(model, paramsOf(model), featuresOf(model)) {
    displacement_m.assign(model.slots(), layout::vec4{0, 0, 0, 0});
    nodes = buffers_.store.nodes.read();
    spring_cut = buffers_.links.spring_cut.read();
  }
  explicit SurfaceRig(Body body) : SurfaceRig(one(std::move(body))) {}

  /// @param moved  rest position [m] -> position [m]
  template <class Moved>
  void moveNodes(Moved moved) {
    for (size_t b = 0; b < model.bodies.size(); ++b) {
      const Lattice& lattice = model.bodies[b].lattice;
      for (uint32_t slot : lattice.active_slots) {
        const Vector3d rest = restPosition(model.bodies[b], slot);
        const Vector3f u = (moved(rest) - rest).template cast<float>();
        displacement_m[model.slotOffset(b) + slot] = {u.x(), u.y(), u.z(), 0};
      }
    }
  }
  void follow() {
    upload();
    surface.follow(state());
  }
  void split() {
    upload();
    ++revision;
    surface.split(state());
  }
  /// Uploads displacement_m, nodes and spring_cut.
  void upload() {
    buffers_.state.displacement[0].write(displacement_m);
    buffers_.store.nodes.write(nodes);
    buffers_.links.spring_cut.write(spring_cut);
  }
  StateView state() const {
    StateView view;
    view.displacement = buffers_.state.displacement[0].id();
    view.velocity = buffers_.state.velocity[0].id();
    view.nodes = buffers_.store.nodes.id();
    view.bricks = buffers_.store.bricks.id();
    view.bodies = buffers_.store.bodies.id();
    view.rest = buffers_.links.rest.id();
    view.spring_cut = buffers_.links.spring_cut.id();
    view.cut_revision = revision;
    return view;
  }
  /// Returns the part of displacement_m or nodes of one body, by its own slots.
  template <class T>
  std::vector<T> ofBody(const std::vector<T>& all, size_t body) const {
    const auto first = all.begin() + model.slotOffset(body);
    return std::vector<T>(first, first + static_cast<long>(model.bodies[body].lattice.nodes.size()));
  }
  std::vector<Vector3d> positions() const {
    const std::vector<float> flat = surface.positions().read();
    std::vector<Vector3d> out;
    for (size_t v = 0; v < surface.vertices(); ++v) out.emplace_back(flat[3 * v], flat[3 * v + 1], flat[3 * v + 2]);
    return out;
  }
  std::vector<Vector3d> normals() const {
    std::vector<Vector3d> out;
    for (uint32_t packed : surface.normals().read()) out.push_back(unpackNormal(packed).cast<double>());
    return out;
  }

  Model model;
  Surface surface;
  std::vector<layout::vec4> displacement_m;  ///< [slots]
  std::vector<layout::NodeBits> nodes;       ///< [slots]
  std::vector<float> spring_cut;             ///< [springs] of networks
  uint64_t revision = 0;

 private:
  static FeatureSet featuresOf(const Model& model) {
    FeatureSet features;
    features.network = model.hasNetwork();
    return features;
  }
  static std::vector<Body> one(Body body) {
    std::vector<Body> bodies;
    bodies.push_back(std::move(body));
    return bodies;
  }
  static std::vector<layout::BodyParams> paramsOf(const Model& model) {
    std::vector<layout::BodyParams> params;
    for (const Body& body : model.bodies) params.push_back(bodyParams(body, 0));
    return params;
  }
  LatticeBuffers buffers_;
};

}  // namespace viscera::testing
