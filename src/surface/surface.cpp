// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/surface/surface.h"

#include <string>
#include <utility>

#include "gpu/gl.h"
#include "surface/part_colors.h"
#include "viscera/gpu/stage_clock.h"

namespace viscera {

namespace {

constexpr GLint kCountUniform = 0;     // layout(location = 0) of all three kernels
constexpr GLint kFollowedUniform = 1;  // of those that follow

void bind(uint32_t binding, uint32_t buffer) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer);
}

gpu::Program kernel(const std::string& name) {
  return gpu::Program::compute(name, {"GROUP_SIZE " + std::to_string(layout::kGroupSize)});
}

void run(const gpu::Program& kernel, size_t count) {
  kernel.use();
  glUniform1ui(kCountUniform, static_cast<GLuint>(count));
  gpu::Program::dispatch(count, layout::kGroupSize);
}

void runSince(const gpu::Program& kernel, size_t count, uint32_t followed_revision) {
  kernel.use();
  glUniform1ui(kFollowedUniform, followed_revision);
  run(kernel, count);
}

/// Whoever draws, copies or publishes next must see what was written.
void publish() {
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_ELEMENT_ARRAY_BARRIER_BIT |
                  GL_BUFFER_UPDATE_BARRIER_BIT);
}

/// The skins of all bodies as one: slots and vertices numbered through.
struct JoinedSkins {
  std::vector<uint32_t> surface_nodes, triangles, tie_starts = {0}, colors;
  std::vector<layout::SkinBinding> bindings;
  std::vector<layout::Tie> ties;

  void append(const Body& body, uint32_t slot_offset) {
    const Skin& skin = body.skin;
    const auto first_vertex = static_cast<uint32_t>(bindings.size());
    const auto first_tie = static_cast<uint32_t>(ties.size());
    for (uint32_t slot : skin.bound_slots) surface_nodes.push_back(slot + slot_offset);
    for (layout::SkinBinding binding : skin.bindings) {
      binding.slot0 += slot_offset;
      binding.slot1 += slot_offset;
      binding.slot2 += slot_offset;
      bindings.push_back(binding);
    }
    for (layout::Tie tie : skin.ties) ties.push_back({tie.slot + slot_offset, tie.spring});
    for (size_t t = 0; t < skin.mesh.triangles.size(); ++t) {
      for (uint32_t v : skin.mesh.triangles[t]) triangles.push_back(v + first_vertex);
      tie_starts.push_back(skin.tie_starts[t + 1] + first_tie);
    }
    const std::vector<uint32_t> own_colors = vertexColors(skin.mesh, body.color);
    colors.insert(colors.end(), own_colors.begin(), own_colors.end());
  }
};

JoinedSkins join(const Model& model) {
  JoinedSkins joined;
  for (size_t b = 0; b < model.bodies.size(); ++b) joined.append(model.bodies[b], model.slotOffset(b));
  return joined;
}

}  // namespace

Surface::Surface(const Model& model) {
  JoinedSkins skins = join(model);
  vertices_ = skins.bindings.size();
  triangles_ = skins.triangles.size() / 3;
  surface_nodes_ = gpu::Buffer<uint32_t>(skins.surface_nodes);
  node_normals_ = gpu::Buffer<layout::vec4>(model.slots());
  bindings_ = gpu::Buffer<layout::SkinBinding>(skins.bindings);
  positions_ = gpu::Buffer<float>(3 * vertices_);
  normals_ = gpu::Buffer<uint32_t>(vertices_);
  colors_ = gpu::Buffer<uint32_t>(skins.colors);
  triangle_buffer_ = gpu::Buffer<uint32_t>(skins.triangles);
  ties_ = gpu::Buffer<layout::Tie>(skins.ties);
  tie_starts_ = gpu::Buffer<uint32_t>(skins.tie_starts);
  alive_ = gpu::Buffer<uint32_t>(triangles_);
  live_ = gpu::Buffer<uint32_t>(3 * triangles_);
  indices_ = std::move(skins.triangles);
  node_normal_ = kernel("node_normal.comp");
  map_ = kernel("map_skin.comp");
  tear_ = kernel("tear_skin.comp");
  reset();
}

void Surface::follow(const StateView& state) {
  const bool known = state.stale_bricks != 0;
  if (known && state.moved_revision <= followed_revision_) return;
  const gpu::TimedStage timed(gpu::Stage::kSurface);
  const uint32_t since = known ? followed_revision_ : 0;
  followed_revision_ = known ? state.revision : 0;
  if (known) bind(layout::kBindStaleBricks, state.stale_bricks);
  bind(layout::kBindBricks, state.bricks);
  bind(layout::kBindBodies, state.bodies);
  bind(layout::kBindNodes, state.nodes);
  bind(layout::kBindDisplacementIn, state.displacement);
  surface_nodes_.bindStorage(layout::kBindSurfaceNodes);
  node_normals_.bindStorage(layout::kBindNodeNormals);
  bindings_.bindStorage(layout::kBindSkinBindings);
  positions_.bindStorage(layout::kBindSkinPositions);
  normals_.bindStorage(layout::kBindSkinNormals);
  runSince(node_normal_, surface_nodes_.size(), since);
  gpu::Program::storageBarrier();
  runSince(map_, vertices_, since);
  publish();
  ++mappings_;
}

void Surface::tear(const StateView& state) {
  if (state.cut_revision == cut_revision_) return;
  cut_revision_ = state.cut_revision;
  const gpu::TimedStage timed(gpu::Stage::kSurface);
  bind(layout::kBindNodes, state.nodes);
  bindings_.bindStorage(layout::kBindSkinBindings);
  triangle_buffer_.bindStorage(layout::kBindSkinTriangles);
  ties_.bindStorage(layout::kBindSkinTies);
  tie_starts_.bindStorage(layout::kBindSkinTieStarts);
  alive_.bindStorage(layout::kBindSkinAlive);
  live_.bindStorage(layout::kBindSkinLive);
  run(tear_, triangles_);
  publish();
}

void Surface::reset() {
  alive_.write(std::vector<uint32_t>(triangles_, 1));
  live_.write(indices_);
  cut_revision_ = 0;
}

}  // namespace viscera
