// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/surface.h"

#include <memory>
#include <string>
#include <utility>

#include "gpu/gl.h"
#include "gpu/stage_clock.h"
#include "layout/bindings.h"
#include "surface/joined_skins.h"
#include "surface/network_surface.h"

namespace viscera {

namespace {

void bind(uint32_t binding, uint32_t buffer) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer);
}

/// What shaders/solver/lattice.glsl asks for.
void bindNodes(const StateView& state) {
  bind(layout::kBindBricks, state.bricks);
  bind(layout::kBindBodies, state.bodies);
  bind(layout::kBindNodes, state.nodes);
}

gpu::Program kernel(const std::string& name, const std::vector<std::string>& features = {}) {
  std::vector<std::string> defines = features;
  defines.push_back("GROUP_SIZE " + std::to_string(layout::kGroupSize));
  return gpu::Program::compute(name, defines);
}

void run(const gpu::Program& kernel, size_t count) {
  kernel.use();
  kernel.set("count", static_cast<uint32_t>(count));
  gpu::Program::dispatch(count, layout::kGroupSize);
}

void runSince(const gpu::Program& kernel, size_t count, uint32_t followed_revision) {
  kernel.set("followed_revision", followed_revision);
  run(kernel, count);
}

/// Whoever draws, copies or publishes next must see what was written.
void publish() {
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_ELEMENT_ARRAY_BARRIER_BIT |
                  GL_BUFFER_UPDATE_BARRIER_BIT);
}

}  // namespace

Surface::Surface(const Model& model) {
  JoinedSkins skins = joinSkins(model);
  vertices_ = skins.bindings.size();
  const size_t triangles = skins.triangles.size() / 3;
  surface_nodes_ = gpu::Buffer<uint32_t>(skins.surface_nodes, "surface nodes");
  node_normals_ = gpu::Buffer<layout::vec4>(skins.any_bound ? model.slots() : 0, "node normals");
  bindings_ = gpu::Buffer<layout::SkinBinding>(skins.bindings, "bindings");
  positions_ = gpu::Buffer<float>(3 * vertices_, "positions");
  normals_ = gpu::Buffer<uint32_t>(vertices_, "normals");
  colors_ = gpu::Buffer<uint32_t>(skins.colors, "colors");
  triangle_buffer_ = gpu::Buffer<uint32_t>(skins.triangles, "triangle buffer");
  ties_ = gpu::Buffer<layout::Tie>(skins.ties, "ties");
  tie_starts_ = gpu::Buffer<uint32_t>(skins.tie_starts, "tie starts");
  alive_ = gpu::Buffer<uint32_t>(triangles, "alive");
  live_ = gpu::Buffer<uint32_t>(3 * (triangles + 2 * skins.networks.triangles.size()), "live");
  std::vector<uint32_t> splits = splitsOf(skins);
  shown_ = ShownTriangles(model, vertices_, std::move(skins.triangles), std::move(splits));
  if (skins.any_bound) {
    const std::vector<std::string> features(skins.any_one_to_one ? 1 : 0, "MIXED");
    node_normal_ = kernel("node_normal.comp");
    map_ = kernel("map_skin.comp", features);
    tear_ = kernel("tear_skin.comp", features);
  }
  if (skins.any_one_to_one) networks_ = std::make_unique<NetworkSurface>(skins.networks);
  reset();
}

Surface::~Surface() = default;

void Surface::follow(const StateView& state) {
  const bool known = state.stale_bricks != 0;
  if (known && state.moved_revision <= followed_revision_) return;
  const gpu::TimedStage timed(gpu::Stage::kSurface);
  const uint32_t since = known ? followed_revision_ : 0;
  followed_revision_ = known ? state.revision : 0;
  bind(layout::kBindStaleBricks, known ? state.stale_bricks : unknown_.id());
  bindNodes(state);
  bind(layout::kBindDisplacementIn, state.displacement);
  positions_.bindStorage(layout::kBindSkinPositions);
  normals_.bindStorage(layout::kBindSkinNormals);
  if (map_) followLattices(since);
  if (networks_) {
    alive_.bindStorage(layout::kBindSkinAlive);
    networks_->follow(state, since);
  }
  publish();
  ++mappings_;
}

void Surface::followLattices(uint32_t since) {
  surface_nodes_.bindStorage(layout::kBindSurfaceNodes);
  node_normals_.bindStorage(layout::kBindNodeNormals);
  bindings_.bindStorage(layout::kBindSkinBindings);
  runSince(node_normal_, surface_nodes_.size(), since);
  gpu::Program::storageBarrier();
  runSince(map_, vertices_, since);
}

void Surface::tear(const StateView& state) {
  if (state.cut_revision == cut_revision_) return;
  cut_revision_ = state.cut_revision;
  const gpu::TimedStage timed(gpu::Stage::kSurface);
  bindNodes(state);
  triangle_buffer_.bindStorage(layout::kBindSkinTriangles);
  alive_.bindStorage(layout::kBindSkinAlive);
  live_.bindStorage(layout::kBindSkinLive);
  if (tear_) {
    bindings_.bindStorage(layout::kBindSkinBindings);
    ties_.bindStorage(layout::kBindSkinTies);
    tie_starts_.bindStorage(layout::kBindSkinTieStarts);
    run(tear_, triangles());
  }
  if (networks_) {
    networks_->split(state, triangles());
    followed_revision_ = 0;  // normals depend on what is whole
  }
  publish();
}

void Surface::reset() {
  alive_.write(std::vector<uint32_t>(triangles(), layout::kShownWhole));
  live_.clear();
  live_.write(shown_.indices());
  cut_revision_ = 0;
  if (!networks_) return;
  networks_->reset();
  followed_revision_ = 0;
}

}  // namespace viscera
