// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "solver/cpu/glsl_kernel.h"
#include "solver/cpu/tool_passes.h"

namespace viscera {

namespace glsl {

namespace {

struct CutStats {
  uint springs_cut = 0;
};

struct CutKernel : Kernel {
  explicit CutKernel(CpuLattice& lattice)
      : Kernel(lattice), axial_cut(lattice.axial_cut.data()), cut_sides(lattice.cut_sides) {}
  float* axial_cut;
  Vectors cut_sides;
  uint stylus = 0;
  CutStats stats;
  const uint8_t* outside = nullptr;  ///< [slots] sides of the box around the sweep that a node is beyond
  /// Two nodes beyond the same side have none of the box between them.
  bool mayCross(uint slot, uint other) const { return (outside[slot] & outside[other]) == 0; }
};

/// May a node lose a spring? Not if none of them may cross the box.
#define LOOK(spring, offset) may |= mayCross(slot, neighborSlot(slot, offset));
#define MAY_LOSE            \
  bool mayLose(uint slot) { \
    bool may = false;       \
    FOR_EACH_SPRING(LOOK)   \
    return may;             \
  }

#define VARIANT_NAME CutSprings
#define VARIANT_BASE CutKernel
#define VARIANT_TEXT "shaders/solver/cut.comp"
#define VARIANT_FEATURES WITH_RECORD
#define VARIANT_MEMBERS MAY_LOSE
#include "solver/cpu/glsl_variant.inc"

#define VARIANT_NAME CutSpringsForgetting
#define VARIANT_BASE CutKernel
#define VARIANT_TEXT "shaders/solver/cut.comp"
#define VARIANT_MEMBERS MAY_LOSE
#include "solver/cpu/glsl_variant.inc"

#define VARIANT_NAME CutParticlesForgetting
#define VARIANT_BASE CutKernel
#define VARIANT_TEXT "shaders/solver/cut.comp"
#define VARIANT_FEATURES WITH_PARTICLES
#define VARIANT_MEMBERS MAY_LOSE
#include "solver/cpu/glsl_variant.inc"

#define VARIANT_NAME CutParticles
#define VARIANT_BASE CutKernel
#define VARIANT_TEXT "shaders/solver/cut.comp"
#define VARIANT_FEATURES WITH_PARTICLES | WITH_RECORD
#define VARIANT_MEMBERS MAY_LOSE
#include "solver/cpu/glsl_variant.inc"
#undef MAY_LOSE
#undef LOOK

struct NoKernel {};

#define VARIANT_NAME Blade
#define VARIANT_BASE NoKernel
#define VARIANT_TEXT "shaders/solver/blade.glsl"
#include "solver/cpu/glsl_variant.inc"

struct CellKernel : Kernel {
  using Kernel::Kernel;
  uint cell_count = 0;
};

#define VARIANT_NAME TearCell
#define VARIANT_BASE CellKernel
#define VARIANT_TEXT "shaders/solver/volume.comp"
#define VARIANT_FEATURES WITH_CUT | WITH_VOLUME
#include "solver/cpu/glsl_variant.inc"

}  // namespace

}  // namespace glsl

namespace {

/// A brick's places relative to a point [m]: rest position of the first one, spacing, displacements [192].
struct Places {
  float first[3];
  float h;
  const float* u;
};

Places placesOf(const CpuLattice& lattice, uint32_t b, const layout::vec4& from) {
  const layout::Brick& brick = lattice.store.bricks[b];
  const layout::vec4& origin = lattice.store.bodies[brick.body].origin_spacing;
  const float edge = static_cast<float>(layout::kBrickEdge) * origin.w;
  return {{origin.x + edge * static_cast<float>(brick.coord_x) - from.x,
           origin.y + edge * static_cast<float>(brick.coord_y) - from.y,
           origin.z + edge * static_cast<float>(brick.coord_z) - from.z},
          origin.w,
          &lattice.state.displacement[lattice.state.current][vectorAt(b * layout::kBrickSlots)]};
}

/// Calls visit(slot within the brick, x, y, z) for all 64 places, in a form that compilers turn into vectors.
template <class Visit>
void forEachPlace(const Places& p, Visit visit) {
  for (int i = 0; i < static_cast<int>(layout::kBrickSlots); ++i) {
    visit(i, p.first[0] + p.h * static_cast<float>(i & 3) + p.u[i],
          p.first[1] + p.h * static_cast<float>(i >> 2 & 3) + p.u[i + 64],
          p.first[2] + p.h * static_cast<float>(i >> 4) + p.u[i + 128]);
  }
}

/// Positions are rounded otherwise in these loops than in cut.comp, which has the last word: by 1e-6 of the sizes at
/// hand, so this is far beyond.
constexpr float kMargin = 1e-4f;

/// Tissue of a node outside is that many cells away at most: a cell's diagonal, and as much again where its edges are
/// stretched or turned (shaders/solver/surface_way.glsl).
constexpr float kFarthestTissue = 3.5f;

/// In cells: a node may be seen that far from where it is (kSway and kBeside in shaders/solver/cut_sides.glsl).
constexpr float kFarthestSway = 0.51f;

/// How far from a node the cut may look for it [m].
float tissueReach(const CpuLattice& lattice, float h) {
  return lattice.strengths.surface_ways.empty() ? 0 : kFarthestTissue * h;
}

/// [slots] how far from each node its tissue is at most, whatever moves [m]: the way at rest, and as much along every
/// axis where its edge is stretched or turned (shaders/solver/surface_way.glsl).
std::vector<float> tissueReaches(CpuLattice& lattice) {
  std::vector<float> out(lattice.slotCount());
  glsl::CutSprings kernel(lattice);
  for (const uint32_t slot : lattice.store.active) {
    const uint32_t way = kernel.surfaceWay(slot);
    if (way == 0) continue;
    const glsl::vec3 cells = kernel.wayInCells(way);
    const float along_axes = std::abs(cells.x) + std::abs(cells.y) + std::abs(cells.z);
    out[slot] = lattice.store.bodyOf(slot).origin_spacing.w * (glsl::length(cells) + along_axes);
  }
  return out;
}

/// A box around the swept blade, along the blade and its way. All vectors are from the blade's first tip [m].
struct SweepBox {
  glsl::vec3 axes[3];
  float low[3], high[3];
};

/// Part of v that is at right angles to the unit vector n, as a unit vector; any such vector where nothing is left.
glsl::vec3 acrossOf(const glsl::vec3& n, const glsl::vec3& v) {
  const glsl::vec3 across = v - glsl::dot(n, v) * n;
  if (glsl::dot(across, across) > 1e-12f * glsl::dot(v, v)) return glsl::normalize(across);
  const glsl::vec3 other = glsl::abs(n.x) < 0.5f ? glsl::vec3(1, 0, 0) : glsl::vec3(0, 1, 0);
  return glsl::normalize(glsl::cross(n, other));
}

SweepBox boxAround(const layout::ToolMotion& m, float grown_m) {
  const glsl::vec3 from = glsl::xyz(m.from), tip = glsl::xyz(m.to) - from;
  const glsl::vec3 far_from = glsl::xyz(m.blade_from) - from, far_to = glsl::xyz(m.blade_to) - from;
  SweepBox box;
  box.axes[0] = glsl::dot(far_from, far_from) > 0 ? glsl::normalize(far_from) : glsl::vec3(0, 0, 1);
  box.axes[1] = acrossOf(box.axes[0], tip + (far_to - far_from));
  box.axes[2] = glsl::cross(box.axes[0], box.axes[1]);
  for (int k = 0; k < 3; ++k) {
    const float a = glsl::dot(box.axes[k], tip), b = glsl::dot(box.axes[k], far_from);
    const float c = glsl::dot(box.axes[k], far_to);
    box.low[k] = glsl::min(glsl::min(0.0f, a), glsl::min(b, c)) - grown_m;
    box.high[k] = glsl::max(glsl::max(0.0f, a), glsl::max(b, c)) + grown_m;
  }
  return box;
}

/// Sides of the box beyond which all is that lies within `reach` of a point. Where two have one in common, no point of
/// the box is between them.
uint8_t sidesBeyond(const SweepBox& box, float x, float y, float z, float reach) {
  int sides = 0;  // what is not finite is beyond none
  for (int k = 0; k < 3; ++k) {
    const float along = box.axes[k].x * x + box.axes[k].y * y + box.axes[k].z * z;
    sides |= (along < box.low[k] - reach) << (2 * k) | (along > box.high[k] + reach) << (2 * k + 1);
  }
  return static_cast<uint8_t>(sides);
}

constexpr uint8_t kNotNear = 255;

}  // namespace

CpuCut::CpuCut(CpuLattice& lattice)
    : reach_m_(tissueReaches(lattice)),
      outside_(lattice.slotCount(), kNotNear),
      common_(lattice.brickCount(), kNotNear) {
  near_.reserve(lattice.brickCount());
  changed_.reserve(lattice.store.active.size());
}

void CpuCut::findBricks(const CpuLattice& lattice, const layout::ToolMotion& motion) {
  near_.clear();
  glsl::vec4 sphere(0);
  for (uint32_t b = 0; b < lattice.brickCount(); ++b) {
    Places places = placesOf(lattice, b, motion.from);
    if (b == 0 || lattice.store.bricks[b].body != lattice.store.bricks[b - 1].body)
      sphere = glsl::Blade().bladeSphere(motion, places.h);
    float size = 0;
    for (int k = 0; k < 3; ++k) size += glsl::abs(places.first[k] -= sphere[k]);
    const float reach = sphere.w + tissueReach(lattice, places.h);
    const float radius = reach + kMargin * (reach + size), radius2 = radius * radius;
    int near = 0;
    // Written so that what is not finite is looked at more closely.
    forEachPlace(places, [&](int, float x, float y, float z) { near |= !(x * x + y * y + z * z > radius2); });
    if (near) near_.push_back(b);
  }
}

/// How far the start of the sweep may be from where some spring of the near bricks sees it [m] (startOffset in
/// blade.glsl).
float CpuCut::farthestOffset(const CpuLattice& lattice, const layout::ToolMotion& motion) const {
  const float* const velocity = lattice.state.velocity[lattice.state.current].data();
  float most2 = 0;  // what is not finite crosses nothing
  for (uint32_t b : near_) {
    const float* const v = velocity + vectorAt(b * layout::kBrickSlots);
    for (uint32_t i = 0; i < layout::kBrickSlots; ++i) {
      most2 = std::max(most2, v[i] * v[i] + v[i + 64] * v[i + 64] + v[i + 128] * v[i + 128]);
    }
  }
  const float overlap = glsl::Blade().kOverlap * glsl::distance(glsl::xyz(motion.to), glsl::xyz(motion.from));
  return (1 + kMargin) * (motion.timing.x * std::sqrt(most2) + overlap);
}

void CpuCut::placeNodes(const CpuLattice& lattice, const layout::ToolMotion& motion, float grown_m) {
  for (uint32_t b : near_) {
    const Places places = placesOf(lattice, b, motion.from);
    const float size = glsl::Blade().bladeSphere(motion, places.h).w;
    const SweepBox box = boxAround(motion, grown_m + kFarthestSway * places.h + kMargin * size);
    uint8_t* const out = &outside_[b * layout::kBrickSlots];
    const float* const reach = &reach_m_[b * layout::kBrickSlots];
    forEachPlace(places, [&](int i, float x, float y, float z) { out[i] = sidesBeyond(box, x, y, z, reach[i]); });
    uint8_t common = 255;
    for (uint32_t i = 0; i < layout::kBrickSlots; ++i) common &= out[i];
    common_[b] = common;
  }
}

/// May a spring of the brick's nodes cross the box? Not if all places of it and around it are beyond the same side.
bool CpuCut::mayCross(const layout::Brick& brick) const {
  uint8_t common = 255;
  for (uint32_t neighbor : brick.neighbors) common &= common_[neighbor];
  return common == 0;
}

template <class Kernel>
uint32_t CpuCut::cutWith(CpuLattice& lattice, const layout::ToolMotion& motion) {
  Kernel kernel(lattice);
  kernel.tool_motions = &motion;
  kernel.outside = outside_.data();
  for (uint32_t brick : near_) {
    if (!mayCross(lattice.store.bricks[brick])) continue;
    for (uint32_t i = lattice.store.first_active[brick]; i < lattice.store.first_active[brick + 1]; ++i) {
      const uint32_t slot = lattice.store.active[i];
      if (!kernel.mayLose(slot)) continue;
      const layout::NodeBits before = lattice.store.nodes[slot];
      kernel.index = i;
      kernel.main();
      const layout::NodeBits& now = lattice.store.nodes[slot];
      if (now.lo == before.lo && now.hi == before.hi) continue;
      lattice.refresh(slot);
      changed_.push_back(slot);
    }
  }
  return kernel.stats.springs_cut;
}

template <class Springs, class Particles>
uint32_t CpuCut::cutAll(CpuLattice& lattice, const layout::ToolMotion& motion, bool particles) {
  return particles ? cutWith<Particles>(lattice, motion) : cutWith<Springs>(lattice, motion);
}

/// Drops the volumes of cells that have lost a spring: they have a corner that has.
void CpuCut::tearCells(CpuLattice& lattice) const {
  glsl::TearCell kernel(lattice);
  kernel.cell_count = 1;
  for (uint32_t slot : changed_) {
    for (int c = 0; c < 8; ++c) {
      bool exists;
      const uint32_t cell = kernel.cellAt(slot, 2 * glsl::ivec3(c & 1, c >> 1 & 1, c >> 2 & 1) - 1, exists);
      if (!exists || !(lattice.store.nodes[cell].lo & layout::kCellBit)) continue;
      kernel.cells = &cell;
      kernel.main();
      lattice.refresh(cell);
    }
  }
}

uint32_t CpuCut::run(CpuLattice& lattice, const layout::ToolMotion& motion, bool particles) {
  findBricks(lattice, motion);
  placeNodes(lattice, motion, particles ? motion.blade_from.w : farthestOffset(lattice, motion));
  changed_.clear();
  const bool records = !lattice.axial_cut.empty();
  const uint32_t springs =
      records ? cutAll<glsl::CutSprings, glsl::CutParticles>(lattice, motion, particles)
              : cutAll<glsl::CutSpringsForgetting, glsl::CutParticlesForgetting>(lattice, motion, particles);
  if (!lattice.strengths.bulk.empty()) tearCells(lattice);
  for (uint32_t b : near_) {  // as if nothing had been near
    common_[b] = kNotNear;
    std::fill_n(&outside_[b * layout::kBrickSlots], layout::kBrickSlots, kNotNear);
  }
  return springs;
}

}  // namespace viscera
