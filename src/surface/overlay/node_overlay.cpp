// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/overlay/node_overlay.h"

#include <algorithm>
#include <string>
#include <unordered_set>
#include <utility>

#include "gpu/gl.h"
#include "layout/bindings.h"
#include "surface/skins/joined_skins.h"
#include "surface/surface_kernels.h"
#include "viscera/model/body/neighbors.h"

namespace viscera {

namespace {

constexpr double kNormalInSpacings = 0.6;  // length of a drawn normal
constexpr double kForceInSpacings = 2;     // length of the drawn force on a body, which shows only its direction

}  // namespace

NodeOverlay::NodeOverlay(const Model& model)
    : normal_lengths_(size_t{4} * layout::kMaxBodies),
      force_spikes_(size_t{4} * layout::kMaxBodies),
      network_(model.hasNetwork()),
      strains_(model, NodeStrains::Mean::kOfSquares) {
  uint32_t springs = 0, vertices = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (isOneToOne(body)) {
      addNetwork(body, model.slotOffset(b), springs, vertices);
    } else {
      addLattice(body, model.slotOffset(b));
    }
    const double spacing = isOneToOne(body) ? body.network->meanLength() : body.lattice.spacing_m;
    normal_lengths_[4 * b] = static_cast<float>(kNormalInSpacings * spacing);
    if (!body.force_n.isZero()) {
      any_forces_ = true;
      const Vector3d spike = kForceInSpacings * spacing * body.force_n.normalized();
      for (size_t i = 0; i < 3; ++i) force_spikes_[4 * b + i] = static_cast<float>(spike[static_cast<Eigen::Index>(i)]);
    }
    if (body.network) springs += static_cast<uint32_t>(body.network->springs.size());
    vertices += static_cast<uint32_t>(body.skin.bindings.size() + 2 * body.skin.split_edges.size());
  }
  axial_count_ = axial_.size();
  axial_.insert(axial_.end(), diagonal_.begin(), diagonal_.end());
  lines_ = gpu::Buffer<layout::OverlayLine>(axial_, "overlay lines");
  indices_ = gpu::Buffer<uint32_t>(2 * axial_.size(), "overlay indices");
  spikes_ = gpu::Buffer<layout::OverlaySpike>(spike_list_, "overlay spikes");
  normal_ends_ = gpu::Buffer<layout::vec4>(2 * spike_list_.size(), "overlay normals");
  force_ends_ = gpu::Buffer<layout::vec4>(any_forces_ ? 2 * spike_list_.size() : 0, "overlay forces");
  axial_ = {};
  diagonal_ = {};
  const std::vector<std::string> features(network_ ? 1 : 0, "NETWORK");
  draw_lines_ = surfaceKernel("overlay_lines.comp", features);
  draw_spikes_ = surfaceKernel("overlay_spikes.comp");
  color_ = surfaceKernel("overlay_colors.comp");
  std::vector<layout::SurfaceNode> bound;
  for (const layout::OverlaySpike& spike : spike_list_) {
    if (spike.vertex == 0) bound.push_back({spike.slot, 0, 0, 0});
  }
  if (bound.empty()) return;
  bound_nodes_ = gpu::Buffer<layout::SurfaceNode>(bound, "overlay bound nodes");
  node_normals_ = gpu::Buffer<layout::vec4>(model.slots(), "overlay node normals");
  sum_normals_ = surfaceKernel("node_normal.comp", {"SUMMED"});
}

/// Adds springs between nodes that the surface mesh is bound to, each once, and normals of these nodes.
void NodeOverlay::addLattice(const Body& body, uint32_t slot) {
  const std::unordered_set<uint32_t> bound(body.skin.bound_slots.begin(), body.skin.bound_slots.end());
  for (const uint32_t node : body.skin.bound_slots) {
    spike_list_.push_back({slot + node, 0});
    for (uint32_t spring = 0; spring < layout::kSpringsPerNode; spring += 2) {
      const int64_t other = body.lattice.neighborSlot(node, spring);
      if (springCount(body.lattice.nodes[node], spring) == 0 || bound.count(static_cast<uint32_t>(other)) == 0)
        continue;
      const layout::OverlayLine line = {slot + node, slot + static_cast<uint32_t>(other), spring, 0};
      (spring < layout::kAxialSprings ? axial_ : diagonal_).push_back(line);
    }
  }
}

void NodeOverlay::addNetwork(const Body& body, uint32_t slot, uint32_t first_spring, uint32_t first_vertex) {
  const std::vector<NetworkSpring>& springs = body.network->springs;
  for (uint32_t s = 0; s < springs.size(); ++s) {
    const layout::OverlayLine line = {slot + springs[s].a, slot + springs[s].b, first_spring + s, 1};
    (springs[s].against_bending ? diagonal_ : axial_).push_back(line);
  }
  for (uint32_t v = 0; v < body.skin.bindings.size(); ++v)
    spike_list_.push_back({slot + body.skin.bindings[v].slot0, 1 + first_vertex + v});
}

void NodeOverlay::follow(const StateView& state, const Surface& surface) {
  made_ = {};
  strains_.follow(state);
  surface.bindings().bindStorage(layout::kBindSkinBindings);
}

size_t NodeOverlay::makeLines(const StateView& state, bool all) {
  const size_t count = all ? lines_.size() : axial_count_;
  if (made_.lines >= count) return 2 * count;
  made_.lines = count;
  bindStorage(layout::kBindNodes, state.nodes);
  if (network_) bindStorage(layout::kBindSpringCut, state.spring_cut);
  lines_.bindStorage(layout::kBindOverlayLines);
  indices_.bindStorage(layout::kBindOverlayIndices);
  runOver(draw_lines_, count);
  return 2 * count;
}

void NodeOverlay::makeNormals(const StateView& state, const Surface& surface) {
  if (std::exchange(made_.normals, true)) return;
  if (sum_normals_) {
    bindStorage(layout::kBindBricks, state.bricks);
    bindStorage(layout::kBindBodies, state.bodies);
    bindStorage(layout::kBindNodes, state.nodes);
    bindStorage(layout::kBindDisplacementIn, state.displacement);
    bindStorage(layout::kBindStaleBricks, bound_nodes_.id());  // never read: every node is summed
    bound_nodes_.bindStorage(layout::kBindSurfaceNodes);
    node_normals_.bindStorage(layout::kBindNodeNormals);
    sum_normals_.set("followed_revision", 0U);
    runOver(sum_normals_, bound_nodes_.size());
    gpu::Program::storageBarrier();
  }
  makeSpikes(surface, layout::kSpikesAreNormals, normal_lengths_, normal_ends_);
}

void NodeOverlay::makeForces(const Surface& surface) {
  if (!std::exchange(made_.forces, true)) makeSpikes(surface, layout::kSpikesAreForces, force_spikes_, force_ends_);
}

void NodeOverlay::makeSpikes(const Surface& surface, uint32_t kind, const std::vector<float>& of_bodies,
                             const gpu::Buffer<layout::vec4>& ends) {
  const bool lattices = node_normals_.size() > 0;
  bindStorage(layout::kBindNodeNormals, lattices ? node_normals_.id() : nodes().id());  // the latter is never read
  surface.normals().bindStorage(layout::kBindSkinNormals);
  spikes_.bindStorage(layout::kBindOverlaySpikes);
  ends.bindStorage(layout::kBindOverlayEnds);
  draw_spikes_.set("kind", kind);
  draw_spikes_.setVectors("body_spikes", of_bodies.data(), 4, layout::kMaxBodies);
  runOver(draw_spikes_, spikes_.size());
}

void NodeOverlay::makeColors(const Surface& surface, double strain_range) {
  if (std::exchange(made_.colors, true) && made_.strain_range == strain_range) return;
  made_.strain_range = strain_range;
  if (colors_.size() < surface.capacity()) colors_ = gpu::Buffer<uint32_t>(surface.capacity(), "strain colors");
  surface.bindings().bindStorage(layout::kBindSkinBindings);
  colors_.bindStorage(layout::kBindStrainColors);
  color_.set("strain_range", static_cast<float>(strain_range));
  runOver(color_, surface.vertices());
}

}  // namespace viscera
