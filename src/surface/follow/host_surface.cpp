// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/follow/host_surface.h"

#include <cassert>
#include <utility>

#include "solver/cpu/kernels/glsl.h"
#include "solver/cpu/kernels/glsl_features.h"
#include "solver/tissue/joined_lattice.h"
#include "solver/tissue/joined_network.h"
#include "viscera/solver/material.h"

namespace viscera {

namespace glsl {

namespace {

using layout::SplitEdge;  // not the model's type

/// Displacements of the bricks of a snapshot, as a shader's buffer of vec4.
struct Shown {
  const float* first = nullptr;
  const uint* positions = nullptr;  ///< [bricks] place of a brick in the snapshot
  vec4 operator[](uint slot) const {
    const float* const at = first + kBrickFloats * positions[slot >> 6] + (slot & 63u);
    return {at[0], at[64], at[128], 0};
  }
};

/// A buffer that only drawing reads.
struct Ignored {
  struct Element {
    void operator=(uint) const {}
  };
  Element operator[](uint) const { return {}; }
};

/// layout::vec4 in memory, as a shader's buffer of vec4.
struct NodeNormals {
  layout::vec4* first = nullptr;
  struct Element {
    layout::vec4* at;
    operator vec4() const { return xyzw(*at); }
    void operator=(const vec4& v) const { *at = {v.x, v.y, v.z, v.w}; }
  };
  Element operator[](uint slot) const { return {first + slot}; }
};

/// Buffers and uniforms of the kernels of the surface mesh, under their names in GLSL.
struct SkinKernel {
  uint index = 0;
  uint globalIndex() const { return index; }
  uint neighborBrick(uint slot, uint direction) const { return bricks[slot >> 6].neighbors[direction]; }
  ivec3 brickCoord(uint slot) const {
    const Brick& brick = bricks[slot >> 6];
    return {brick.coord_x, brick.coord_y, brick.coord_z};
  }
  uint brickBody(uint slot) const { return bricks[slot >> 6].body; }
  vec3 tabulatedRest(uint slot) const { return xyz(rest_m[slot]); }

  const Brick* bricks = nullptr;
  const BodyParams* bodies = nullptr;
  const layout::vec4* rest_m = nullptr;
  const NodeBits* nodes = nullptr;
  const uint* stale_bricks = nullptr;
  uint followed_revision = 0;  // always 0: nothing is up to date
  Shown displacement;
  NodeNormals node_normals;
  const SkinBinding* skin = nullptr;
  const uint* triangles = nullptr;
  const SurfaceNode* surface_nodes = nullptr;
  uint first_item = 0, count = 0;
  uint triangle_count = 0;  // of all bodies
  const RingVertex* ring_vertices = nullptr;
  const RingTriangle* rings = nullptr;
  const SplitEdge* split_edges = nullptr;
  const SplitTriangle* split_triangles = nullptr;
  const float* spring_cut = nullptr;
  const uint* crossed_edges = nullptr;
  uint placed = 0;  // all split vertices are placed each time
  uint* alive = nullptr;
  Ignored live;
  float* positions = nullptr;
  uint* normals = nullptr;
};

#define VARIANT_NAME CarriedNormal
#define VARIANT_BASE SkinKernel
#define VARIANT_TEXT "shaders/surface/node_normal.comp"
#include "solver/cpu/kernels/glsl_variant.inc"

#define VARIANT_NAME SummedNormal
#define VARIANT_BASE SkinKernel
#define VARIANT_TEXT "shaders/surface/node_normal.comp"
#define VARIANT_FEATURES WITH_SUMMED
#include "solver/cpu/kernels/glsl_variant.inc"

#define VARIANT_NAME MapSkin
#define VARIANT_BASE SkinKernel
#define VARIANT_TEXT "shaders/surface/map_skin.comp"
#define VARIANT_FEATURES WITH_MIXED | WITH_SKINS
#include "solver/cpu/kernels/glsl_variant.inc"

#define VARIANT_NAME NetworkSkin
#define VARIANT_BASE SkinKernel
#define VARIANT_TEXT "shaders/surface/network_skin.comp"
#include "solver/cpu/kernels/glsl_variant.inc"

#define VARIANT_NAME SplitEdges
#define VARIANT_BASE SkinKernel
#define VARIANT_TEXT "shaders/surface/split_edges.comp"
#include "solver/cpu/kernels/glsl_variant.inc"

#define VARIANT_NAME SplitTriangles
#define VARIANT_BASE SkinKernel
#define VARIANT_TEXT "shaders/surface/split_triangles.comp"
#include "solver/cpu/kernels/glsl_variant.inc"

template <class Kernel>
void run(const SkinKernel& buffers, size_t count) {
  Kernel kernel;
  static_cast<SkinKernel&>(kernel) = buffers;
  kernel.count = static_cast<uint>(count);
  for (; kernel.index < count; ++kernel.index) kernel.main();
}

}  // namespace

}  // namespace glsl

struct HostSurface::Buffers : glsl::SkinKernel {
  Buffers(HostSurface& of, const StateSnapshot& snapshot) {
    bricks = of.bricks_.data();
    bodies = of.bodies_.data();
    rest_m = of.rest_m_.data();
    nodes = snapshot.nodes.data();
    displacement = {snapshot.displacement_m.data(), of.brick_positions_.data()};
    node_normals = {of.node_normals_.data()};
    skin = of.wounds_ ? of.wounds_->bindings().data() : of.skins_.bindings.data();
    triangles = of.shown_.indices().data();
    triangle_count = static_cast<uint32_t>(of.shown_.count());
    const NetworkSkins& networks = of.skins_.networks;
    ring_vertices = networks.vertices.data();
    rings = networks.rings.data();
    split_edges = networks.edges.data();
    split_triangles = networks.triangles.data();
    spring_cut = snapshot.spring_cut.data();
    alive = of.alive_.data();
  }
};

HostSurface::HostSurface(const Model& model, MovedNormals normals)
    : skins_(joinSkins(model, normals)),
      shown_bricks_(viscera::shownBricks(model)),
      bricks_(allBricks(model)),
      bodies_(bodyParams(model, 0)),  // kernels here read only places and spacings
      node_normals_(skins_.any_bound ? model.slots() : 0) {
  if (model.hasNetwork()) rest_m_ = joinNetworks(model).rest_m;
  if (Wounds::possible(model)) wounds_ = std::make_unique<Wounds>(model, skins_);
  std::vector<uint32_t> splits = splitsOf(skins_);
  shown_ = VisibleTriangles(model, vertices(), std::move(skins_.triangles), std::move(splits));
  alive_.assign(shown_.count(), layout::kShownWhole);
  brick_positions_.resize(bricks_.size());
  for (uint32_t i = 0; i < shown_bricks_.size(); ++i) brick_positions_[shown_bricks_[i]] = i;
}

void HostSurface::reset() {
  alive_.assign(alive_.size(), layout::kShownWhole);
  cut_revision_ = 0;
  if (wounds_) wounds_->reset();
}

void HostSurface::split(const StateSnapshot& snapshot) {
  if (snapshot.cut_revision == cut_revision_) return;
  cut_revision_ = snapshot.cut_revision;
  if (wounds_) wounds_->update(snapshot);
  glsl::run<glsl::SplitTriangles>(Buffers(*this, snapshot), skins_.networks.triangles.size());
}

void HostSurface::show(const StateSnapshot& snapshot, VisibleMesh& out) {
  assert(snapshot.bricks == shown_bricks_ && snapshot.displacement_m.size() == kBrickFloats * shown_bricks_.size());
  split(snapshot);
  out.positions_m.resize(3 * vertices());
  out.normals.resize(vertices());
  Buffers buffers(*this, snapshot);
  buffers.positions = out.positions_m.data();
  buffers.normals = out.normals.data();
  if (skins_.any_bound) {
    buffers.surface_nodes = skins_.carried_nodes.data();
    glsl::run<glsl::CarriedNormal>(buffers, skins_.carried_nodes.size());
    buffers.surface_nodes = skins_.summed_nodes.data();
    glsl::run<glsl::SummedNormal>(buffers, skins_.summed_nodes.size());
    glsl::run<glsl::MapSkin>(buffers, vertices());
  }
  glsl::run<glsl::NetworkSkin>(buffers, skins_.networks.vertices.size());
  glsl::run<glsl::SplitEdges>(buffers, skins_.networks.edges.size());
  out.topology = shown_.shown(alive_.data(), wounds_ ? wounds_->shown().get() : nullptr);
  ++mappings_;
}

}  // namespace viscera
