// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/surface.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <string>
#include <utility>

#include "gpu/gl.h"
#include "gpu/stage_clock.h"
#include "layout/bindings.h"
#include "surface/network_surface.h"
#include "surface/part_colors.h"

namespace viscera {

namespace {

void bind(uint32_t binding, uint32_t buffer) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer);
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

/// The skins of all bodies as one: slots and vertices numbered through. Split vertices of a network follow its own.
struct JoinedSkins {
  std::vector<uint32_t> surface_nodes, triangles, tie_starts = {0}, colors;
  std::vector<layout::SkinBinding> bindings;
  std::vector<layout::Tie> ties;
  NetworkSkins networks;
  bool any_bound = false, any_one_to_one = false;

  void append(const Body& body, const NetworkSkins::Place& place) {
    const Skin& skin = body.skin;
    if (isOneToOne(body)) {
      any_one_to_one = true;
      networks.append(body, place);
    } else {
      any_bound = true;
      for (uint32_t slot : skin.bound_slots) surface_nodes.push_back(slot + place.slot);
    }
    appendBindings(skin, place.slot);
    appendTriangles(skin, place);
    const std::vector<uint32_t> own_colors = vertexColors(skin.mesh, body.color, skin.two_sided);
    colors.insert(colors.end(), own_colors.begin(), own_colors.end());
    for (const SplitEdge& edge : skin.split_edges) {
      colors.push_back(own_colors[edge.a]);
      colors.push_back(own_colors[edge.b]);
    }
  }

 private:
  void appendBindings(const Skin& skin, uint32_t slot_offset) {
    for (layout::SkinBinding binding : skin.bindings) {
      binding.slot0 += slot_offset;
      binding.slot1 += slot_offset;
      binding.slot2 += slot_offset;
      bindings.push_back(binding);
    }
    layout::SkinBinding split{};  // only says that none of the kernels for lattices may touch it
    split.springs = layout::kOneToOneBit;
    bindings.insert(bindings.end(), 2 * skin.split_edges.size(), split);
  }

  void appendTriangles(const Skin& skin, const NetworkSkins::Place& place) {
    const auto first_tie = static_cast<uint32_t>(ties.size());
    for (layout::Tie tie : skin.ties) ties.push_back({tie.slot + place.slot, tie.spring});
    for (size_t t = 0; t < skin.mesh.triangles.size(); ++t) {
      for (uint32_t v : skin.mesh.triangles[t]) triangles.push_back(v + place.vertex);
      tie_starts.push_back(skin.tie_starts[t + 1] + first_tie);
    }
  }
};

JoinedSkins join(const Model& model) {
  JoinedSkins joined;
  uint32_t springs = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const auto vertices = static_cast<uint32_t>(joined.bindings.size());
    const auto triangles = static_cast<uint32_t>(joined.triangles.size() / 3);
    joined.append(body, {model.slotOffset(b), vertices, triangles, springs});
    if (body.network) springs += static_cast<uint32_t>(body.network->springs.size());
  }
  return joined;
}

/// [6 * triangles]; empty where no triangle can split.
std::vector<uint32_t> splitsOf(const NetworkSkins& networks, size_t triangles) {
  std::vector<uint32_t> out;
  if (!networks.triangles.empty()) out.assign(6 * triangles, 0);
  for (const layout::SplitTriangle& t : networks.triangles) {
    std::copy(std::begin(t.vertices), std::end(t.vertices), out.begin() + 6 * size_t{t.triangle});
  }
  return out;
}

}  // namespace

Surface::Surface(const Model& model) {
  JoinedSkins skins = join(model);
  vertices_ = skins.bindings.size();
  const size_t triangles = skins.triangles.size() / 3;
  surface_nodes_ = gpu::Buffer<uint32_t>(skins.surface_nodes);
  node_normals_ = gpu::Buffer<layout::vec4>(skins.any_bound ? model.slots() : 0);
  bindings_ = gpu::Buffer<layout::SkinBinding>(skins.bindings);
  positions_ = gpu::Buffer<float>(3 * vertices_);
  normals_ = gpu::Buffer<uint32_t>(vertices_);
  colors_ = gpu::Buffer<uint32_t>(skins.colors);
  triangle_buffer_ = gpu::Buffer<uint32_t>(skins.triangles);
  ties_ = gpu::Buffer<layout::Tie>(skins.ties);
  tie_starts_ = gpu::Buffer<uint32_t>(skins.tie_starts);
  alive_ = gpu::Buffer<uint32_t>(triangles);
  live_ = gpu::Buffer<uint32_t>(3 * (triangles + 2 * skins.networks.triangles.size()));
  shown_ = ShownTriangles(model, vertices_, std::move(skins.triangles), splitsOf(skins.networks, triangles));
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
  bind(layout::kBindBricks, state.bricks);
  bind(layout::kBindBodies, state.bodies);
  bind(layout::kBindNodes, state.nodes);
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
  bind(layout::kBindNodes, state.nodes);
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
