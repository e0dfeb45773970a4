// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/surface.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "gpu/gl.h"
#include "gpu/stage_clock.h"
#include "layout/bindings.h"
#include "surface/network_surface.h"
#include "surface/skins/joined_skins.h"
#include "surface/skins/part_colors.h"
#include "surface/skins/skin_fits.h"
#include "surface/skins/skin_paint.h"
#include "surface/surface_kernels.h"

namespace viscera {

namespace {

/// Binds what shaders/solver/tissue/lattice.glsl reads.
void bindNodes(const StateView& state) {
  bindStorage(layout::kBindBricks, state.bricks);
  bindStorage(layout::kBindBodies, state.bodies);
  bindStorage(layout::kBindNodes, state.nodes);
}

/// Returns the features that map_skin.comp is compiled for.
std::vector<std::string> mapFeatures(const JoinedSkins& skins) {
  std::vector<std::string> features;
  if (skins.any_one_to_one) features.push_back("MIXED");
  if (skins.kinds & layout::kInterpolatedBit) features.push_back("CURVED");
  if (skins.kinds & layout::kInCellBit) features.push_back("IN_CELL");
  if (skins.kinds & layout::kOneNodeBit) features.push_back("ONE_NODE");
  if (skins.kinds & layout::kAlongNormalBit) features.push_back("ALONG_NORMAL");
  if (!skins.carried_nodes.empty() || !skins.summed_nodes.empty()) features.push_back("NORMALS");
  return features;
}

using Ranges = std::vector<BodyItems::Range>;

/// Returns the range of each body [bodies] in nodes that are ordered by slot.
Ranges rangesOf(const std::vector<layout::SurfaceNode>& nodes, const Model& model) {
  Ranges out;
  uint32_t first = 0, end = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const size_t last_slot = model.slotOffset(b) + model.bodies[b].lattice.nodes.size();
    while (end < nodes.size() && nodes[end].slot < last_slot) ++end;
    out.push_back({first, end});
    first = end;
  }
  return out;
}

/// Returns the ranges of vertices bound to lattices [bodies + 1]; those of networks are empty. The last range is that
/// of wounds.
Ranges vertexRanges(const Model& model) {
  Ranges out;
  uint32_t first = 0;
  for (const Body& body : model.bodies) {
    const auto end = static_cast<uint32_t>(first + body.skin.bindings.size() + 2 * body.skin.split_edges.size());
    out.push_back({first, isOneToOne(body) ? first : end});
    first = end;
  }
  out.push_back({first, first});
  return out;
}

/// Makes written data visible to drawing, copying and publishing.
void publish() {
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_ELEMENT_ARRAY_BARRIER_BIT |
                  GL_BUFFER_UPDATE_BARRIER_BIT);
}

/// Returns the charts of all triangles, then room for those drawn in place of split ones (split_triangles.comp).
std::vector<uint32_t> chartsOfPieces(const JoinedSkins& skins) {
  std::vector<uint32_t> charts = skins.charts;
  if (charts.empty()) return charts;
  for (const layout::SplitTriangle& split : skins.networks.triangles)
    charts.insert(charts.end(), 2, charts[split.triangle]);
  return charts;
}

}  // namespace

Surface::Surface(const Model& model) : model_(model) {
  JoinedSkins skins = joinSkins(model);
  vertices_ = whole_vertices_ = skins.bindings.size();
  requireSkinFits(vertices_, Wounds::possible(model));
  const size_t triangles = skins.triangles.size() / 3;
  carried_nodes_ = gpu::Buffer<layout::SurfaceNode>(skins.carried_nodes, "surface nodes");
  summed_nodes_ = gpu::Buffer<layout::SurfaceNode>(skins.summed_nodes, "surface nodes");
  const bool normals = carried_nodes_.size() + summed_nodes_.size() > 0;
  node_normals_ = gpu::Buffer<layout::vec4>(normals ? model.slots() : 0, "node normals");
  bindings_ = gpu::Buffer<layout::SkinBinding>(skins.bindings, "bindings");
  positions_ = gpu::Buffer<float>(3 * vertices_, "positions");
  normals_ = gpu::Buffer<uint32_t>(vertices_, "normals");
  colors_ = gpu::Buffer<uint32_t>(skins.colors, "colors");
  rests_ = gpu::Buffer<layout::vec4>(skins.rests, "rests");
  triangle_buffer_ = gpu::Buffer<uint32_t>(skins.triangles, "triangle buffer");
  alive_ = gpu::Buffer<uint32_t>(triangles, "alive");
  live_count_ = first_wound_index_ = 3 * (triangles + 2 * skins.networks.triangles.size());
  live_ = gpu::Buffer<uint32_t>(live_count_, "live");
  charts_ = chartsOfPieces(skins);
  if (!charts_.empty()) {
    live_charts_ = gpu::Buffer<uint32_t>(charts_, "live charts");
    live_charts_view_ = gpu::TexelView(live_charts_.raw(), gpu::TexelFormat::kR32ui);
  }
  boxes_ = SkinBoxes(model, skins.bindings);
  vertex_items_ = BodyItems(vertexRanges(model));
  carried_items_ = BodyItems(rangesOf(skins.carried_nodes, model));
  summed_items_ = BodyItems(rangesOf(skins.summed_nodes, model));
  for (const Body& body : model.bodies) {
    has_part_colors_ = has_part_colors_ || hasPartColors(body);
    one_to_one_.push_back(isOneToOne(body));
    split_indices_.push_back(2 * 3 * body.skin.triangle_edges.size());
  }
  beyond_indices_.resize(model.bodies.size());
  if (Wounds::possible(model)) wounds_ = std::make_unique<Wounds>(model, skins);
  was_wounded_.resize(model.bodies.size());
  std::vector<uint32_t> splits = splitsOf(skins);
  shown_ = VisibleTriangles(model, vertices_, std::move(skins.triangles), std::move(splits));
  if (skins.any_bound) {
    if (carried_nodes_.size() > 0) carried_normal_ = surfaceKernel("node_normal.comp");
    if (summed_nodes_.size() > 0) summed_normal_ = surfaceKernel("node_normal.comp", {"SUMMED"});
    map_ = surfaceKernel("map_skin.comp", mapFeatures(skins));
  }
  if (skins.any_one_to_one) networks_ = std::make_unique<NetworkSurface>(skins.networks);
  whole_rests_ = std::move(skins.rests);
  if (!wounds_) {
    whole_colors_ = std::move(skins.colors);
    whole_bindings_ = std::move(skins.bindings);
  }
  if (wounds_) makeRoom(kRoomForWounds * vertices_, live_count_ + 3 * kRoomForWounds * triangles);
  reset();
}

Surface::~Surface() = default;

void Surface::follow(const StateView& state, const std::vector<uint8_t>* asked) {
  const gpu::TimedStage timed(gpu::Stage::kSurface);
  bindStorage(layout::kBindStaleBricks, state.stale_bricks ? state.stale_bricks : unknown_.id());
  bindNodes(state);
  bindStorage(layout::kBindDisplacementIn, state.displacement);
  positions_.bindStorage(layout::kBindSkinPositions);
  normals_.bindStorage(layout::kBindSkinNormals);
  bool any = map_ && followLattices(state, asked);
  const auto isAsked = [&](size_t body) { return !asked || (*asked)[body]; };
  bool any_network = false;
  for (size_t b = 0; b < one_to_one_.size(); ++b) any_network = any_network || (one_to_one_[b] && isAsked(b));
  if (any_network) any = followNetworks(state) || any;
  if (!any) return;
  publish();
  ++mappings_;
}

/// Updates vertices bound to lattices. @returns whether any were out of date
bool Surface::followLattices(const StateView& state, const std::vector<uint8_t>* asked) {
  bindings_.bindStorage(layout::kBindSkinBindings);
  node_normals_.bindStorage(layout::kBindNodeNormals);
  std::vector<uint8_t> bodies;  // and wounds, which are mapped all together
  if (asked) {
    bool any_wound = false;
    for (size_t b = 0; b < asked->size(); ++b) any_wound = any_wound || ((*asked)[b] && was_wounded_[b]);
    for (size_t b = 0; b < asked->size(); ++b) bodies.push_back((*asked)[b] || (any_wound && was_wounded_[b]));
    bodies.push_back(any_wound);
    asked = &bodies;
  }
  followNormals(state, asked);
  const gpu::TimedStage timed(gpu::Stage::kMapping);
  return vertex_items_.run(map_, state, asked);
}

void Surface::followNormals(const StateView& state, const std::vector<uint8_t>* asked) {
  const gpu::TimedStage timed(gpu::Stage::kNormals);
  if (carried_normal_) {
    carried_nodes_.bindStorage(layout::kBindSurfaceNodes);
    carried_items_.run(carried_normal_, state, asked);
  }
  if (summed_normal_) {
    summed_nodes_.bindStorage(layout::kBindSurfaceNodes);
    summed_items_.run(summed_normal_, state, asked);
  }
  gpu::Program::storageBarrier();
}

/// Updates all networks or none: a split vertex needs both ends of its edge.
bool Surface::followNetworks(const StateView& state) {
  const bool known = state.stale_bricks != 0;
  if (known && state.moved_revision <= followed_networks_) return false;
  const uint32_t since = known ? followed_networks_ : 0;
  followed_networks_ = known ? state.revision : 0;
  alive_.bindStorage(layout::kBindSkinAlive);
  networks_->follow(state, since);
  return true;
}

/// Marks everything as out of date.
void Surface::clear() {
  vertex_items_.clear();
  carried_items_.clear();
  summed_items_.clear();
  followed_networks_ = 0;
}

void Surface::split(const StateView& state) {
  if (!networks_ || state.cut_revision == cut_revision_) return;
  cut_revision_ = state.cut_revision;
  const gpu::TimedStage timed(gpu::Stage::kSurface);
  bindNodes(state);
  triangle_buffer_.bindStorage(layout::kBindSkinTriangles);
  alive_.bindStorage(layout::kBindSkinAlive);
  live_.bindStorage(layout::kBindSkinLive);
  networks_->split(state, triangles());
  followed_networks_ = 0;  // normals depend on which triangles are whole
  ++live_revision_;
  publish();
}

void Surface::makeRoom(size_t vertices, size_t indices) {
  if (vertices > capacity()) {
    bindings_ = gpu::Buffer<layout::SkinBinding>(vertices, "bindings");
    positions_ = gpu::Buffer<float>(3 * vertices, "positions");
    normals_ = gpu::Buffer<uint32_t>(vertices, "normals");
    colors_ = gpu::Buffer<uint32_t>(vertices, "colors");
    gpu::Buffer<layout::vec4> rests(vertices, "rests");
    rests.copyFrom(rests_);
    rests_ = std::move(rests);
  }
  if (indices <= live_.size()) return;
  gpu::Buffer<uint32_t> more(indices, "live");
  more.copyFrom(live_);
  live_ = std::move(more);
  if (charts_.empty()) return;
  gpu::Buffer<uint32_t> more_charts(indices / 3, "live charts");
  more_charts.copyFrom(live_charts_);
  live_charts_ = std::move(more_charts);
  live_charts_view_ = gpu::TexelView(live_charts_.raw(), gpu::TexelFormat::kR32ui);
}

/// Writes the charts in the order in which showWounds() has placed the triangles.
void Surface::showWoundedCharts() {
  if (charts_.empty()) return;
  const VisibleWounds& shown = *wounds_->shown();
  std::vector<uint32_t> charts = charts_;
  wound_charts_.clear();
  size_t first = 0;
  for (size_t b = 0; b < shown.bodies.size(); ++b) {
    const size_t count = shown_.trianglesOf(b);
    const VisibleWounds::OfBody& body = shown.bodies[b];
    for (size_t t = 0; t < body.skin_sources.size(); ++t) {
      const uint32_t chart = charts_[first + body.skin_sources[t]];
      if (t < count) {
        charts[first + t] = chart;
      } else {
        wound_charts_.push_back(chart);
      }
    }
    wound_charts_.insert(wound_charts_.end(), body.walls.size() / 3, kNoChart);
    first += count;
  }
  live_charts_.write(charts);
  live_charts_.write(wound_charts_, first_wound_index_ / 3);
}

/// Replaces the whole triangles of wounded bodies; those that do not fit there follow all others.
void Surface::showWounds() {
  const VisibleWounds& shown = *wounds_->shown();
  vertices_ = shown.vertices;
  size_t beyond = 0;
  for (const VisibleWounds::OfBody& body : shown.bodies) beyond += body.skin.size() + body.walls.size();
  const auto roomFor = [](size_t needed, size_t there) { return needed > there ? needed + needed / 2 : there; };
  makeRoom(roomFor(vertices_, capacity()), roomFor(first_wound_index_ + beyond, live_.size()));
  bindings_.write(wounds_->bindings());
  writeColors();
  wound_indices_.clear();
  size_t first = 0;
  for (size_t b = 0; b < shown.bodies.size(); ++b) {
    const size_t count = 3 * shown_.trianglesOf(b);
    const VisibleWounds::OfBody& body = shown.bodies[b];
    if (body.wounded) {
      const size_t inside = std::min(count, body.skin.size());
      live_.write(body.skin.data(), inside, first);
      if (inside < count) live_.write(std::vector<uint32_t>(count - inside), first + inside);
      wound_indices_.insert(wound_indices_.end(), body.skin.begin() + static_cast<ptrdiff_t>(inside), body.skin.end());
      wound_indices_.insert(wound_indices_.end(), body.walls.begin(), body.walls.end());
    } else if (was_wounded_[b]) {
      live_.write(shown_.indices().data() + first, count, first);
    }
    was_wounded_[b] = body.wounded;
    beyond_indices_[b] = body.wounded ? body.skin.size() - std::min(count, body.skin.size()) + body.walls.size() : 0;
    first += count;
  }
  live_.write(wound_indices_, first_wound_index_);
  live_count_ = first_wound_index_ + wound_indices_.size();
  showWoundedCharts();
  boxes_.add(wounds_->bindings());
  vertex_items_.setLast({static_cast<uint32_t>(whole_vertices_), static_cast<uint32_t>(vertices_)});
  clear();  // vertices are bound again
  ++live_revision_;
}

IndexRuns Surface::runsOf(const std::vector<uint8_t>& bodies) const {
  IndexRuns runs;
  size_t first = 0;
  const auto add = [&](uint8_t drawn, size_t count) {
    if (drawn && count > 0) {
      if (runs.empty() || runs.back().first + runs.back().count != first) runs.push_back({first, 0});
      runs.back().count += count;
    }
    first += count;
  };
  for (size_t b = 0; b < bodies.size(); ++b) add(bodies[b], 3 * shown_.trianglesOf(b));
  for (size_t b = 0; b < bodies.size(); ++b) add(bodies[b], split_indices_[b]);
  for (size_t b = 0; b < bodies.size(); ++b) add(bodies[b], beyond_indices_[b]);
  return runs;
}

void Surface::wound(const CutSprings& cuts, uint64_t revision) {
  if (!wounds_ || revision == wound_revision_) return;
  wound_revision_ = revision;
  const gpu::TimedStage timed(gpu::Stage::kSurface);
  if (!wounds_->update(cuts)) return;
  showWounds();
  publish();
}

/// Writes the colours of surface meshes and walls.
void Surface::writeColors() {
  if (isPainted()) return writePaintedColors();
  colors_.write(wounds_->colors());
  rests_.write(wounds_->addedRests(), whole_vertices_);
}

void Surface::writePaintedColors() {
  SkinPaint skin{wounds_ ? wounds_->colors() : whole_colors_, whole_rests_};
  if (wounds_) skin.rests.insert(skin.rests.end(), wounds_->addedRests().begin(), wounds_->addedRests().end());
  paintSkin(model_, paints_, wounds_ ? wounds_->bindings() : whole_bindings_, skin);
  colors_.write(skin.colors);
  rests_.write(skin.rests);
}

void Surface::paint(const std::vector<std::shared_ptr<const NodePaint>>& paints) {
  if (paints == paints_) return;
  paints_ = paints;
  writePaintedColors();
  publish();
}

void Surface::reset() {
  alive_.write(std::vector<uint32_t>(triangles(), layout::kShownWhole));
  live_.clear();
  live_.write(shown_.indices());
  cut_revision_ = wound_revision_ = 0;
  live_count_ = first_wound_index_;
  ++live_revision_;
  if (wounds_) {
    wounds_->reset();
    showWounds();
  }
  if (!networks_) return;
  networks_->reset();
  clear();
}

}  // namespace viscera
