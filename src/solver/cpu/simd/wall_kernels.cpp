// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "solver/cpu/simd/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/cpu/simd/wall_kernels.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "solver/cpu/simd/law_measure-inl.h"
#include "solver/cpu/simd/law_walls-inl.h"
#include "solver/cpu/simd/targets.h"
#include "solver/cpu/simd/wall_nodes.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

/// Displacements over 4 h of the nodes of a group, and forces on them: x, y, z, 0 of each. Adding up the forces of its
/// cells here takes half the time of writing the force of each cell on each of its nodes.
struct alignas(64) GroupNodes {
  float positions[4 * kWallNodes * kWallLanes], forces[4 * kWallNodes * kWallLanes];
};

HWY_INLINE void readGroup(const WallJob& job, size_t group, GroupNodes& out) {
  const Row row;
  const uint32_t* listed = job.walls.listed + job.walls.first[group];
  const uint32_t count = job.walls.first[group + 1] - job.walls.first[group];
  for (uint32_t n = 0; n < count; ++n) {
    hn::Store(hn::Load(row, job.walls.positions + listed[n]), row, out.positions + 4 * n);
    hn::Store(hn::Zero(row), row, out.forces + 4 * n);
  }
}

HWY_INLINE void writeGroup(const WallJob& job, size_t group, const GroupNodes& nodes) {
  const Row row;
  float* to = job.walls.forces + size_t{4} * job.walls.first[group];
  const size_t count = size_t{4} * (job.walls.first[group + 1] - job.walls.first[group]);
  for (size_t i = 0; i < count; i += 4) hn::Store(hn::Load(row, nodes.forces + i), row, to + i);
}

/// The cells of a group from `lane` on.
struct WallVector {
  const WallJob& job;
  size_t group;
  size_t lane;
  GroupNodes& nodes;

  const float* at(const float* numbers, uint32_t count) const { return numbers + group * count * kWallLanes + lane; }
};

/// Inputs of a vector of cells.
struct WallMotion {
  CellModes cell;
  RowMotion rows;
};

/// Vectors by node, for some cells: x, y, z of each.
struct alignas(64) NodeVectors {
  float values[kWallNodes][3][hn::MaxLanes(Tag())];

  HWY_INLINE Vec3 at(uint32_t node) const {
    return {hn::Load(Tag(), values[node][0]), hn::Load(Tag(), values[node][1]), hn::Load(Tag(), values[node][2])};
  }
  HWY_INLINE void set(uint32_t node, const Vec3& v) {
    hn::Store(v.x, Tag(), values[node][0]);
    hn::Store(v.y, Tag(), values[node][1]);
    hn::Store(v.z, Tag(), values[node][2]);
  }
};

/// Loads the displacements of the nodes of a vector of cells over 4 h. Each is four numbers in memory: loading rows and
/// transposing them takes half the time of gathering single numbers.
HWY_INLINE void loadNodes(const WallVector& of, NodeVectors& out) {
  const Row row;
  const uint16_t* nodes = of.job.walls.nodes + of.group * kWallNodes * kWallLanes + of.lane;
  const float* positions = of.nodes.positions;
  for (uint32_t node = 0; node < kWallNodes; ++node) {
    for (size_t lane = 0; lane < hn::MaxLanes(Tag()); lane += 4) {
      const uint16_t* at = nodes + node * kWallLanes + lane;
      const auto a = hn::Load(row, positions + at[0]), b = hn::Load(row, positions + at[1]);
      const auto c = hn::Load(row, positions + at[2]), d = hn::Load(row, positions + at[3]);
      const auto xy_ab = hn::InterleaveLower(row, a, b), xy_cd = hn::InterleaveLower(row, c, d);
      const auto z_ab = hn::InterleaveUpper(row, a, b), z_cd = hn::InterleaveUpper(row, c, d);
      hn::Store(hn::ConcatLowerLower(row, xy_cd, xy_ab), row, out.values[node][0] + lane);
      hn::Store(hn::ConcatUpperUpper(row, xy_cd, xy_ab), row, out.values[node][1] + lane);
      hn::Store(hn::ConcatLowerLower(row, z_cd, z_ab), row, out.values[node][2] + lane);
    }
  }
}

/// Adds forces to those on the nodes of a vector of cells.
HWY_INLINE void addForces(const WallVector& of, const NodeVectors& forces) {
  const Row row;
  const uint16_t* nodes = of.job.walls.nodes + of.group * kWallNodes * kWallLanes + of.lane;
  const auto add = [&](uint32_t at, hn::Vec<Row> force) HWY_ATTR {
    float* to = of.nodes.forces + at;
    hn::Store(hn::Add(hn::Load(row, to), force), row, to);
  };
  for (uint32_t node = 0; node < kWallNodes; ++node) {
    for (size_t lane = 0; lane < hn::MaxLanes(Tag()); lane += 4) {
      const uint16_t* at = nodes + node * kWallLanes + lane;
      const auto x = hn::Load(row, forces.values[node][0] + lane), y = hn::Load(row, forces.values[node][1] + lane);
      const auto z = hn::Load(row, forces.values[node][2] + lane), none = hn::Zero(row);
      const auto xy_ab = hn::InterleaveLower(row, x, y), xy_cd = hn::InterleaveUpper(row, x, y);
      const auto z_ab = hn::InterleaveLower(row, z, none), z_cd = hn::InterleaveUpper(row, z, none);
      add(at[0], hn::ConcatLowerLower(row, z_ab, xy_ab));
      add(at[1], hn::ConcatUpperUpper(row, z_ab, xy_ab));
      add(at[2], hn::ConcatLowerLower(row, z_cd, xy_cd));
      add(at[3], hn::ConcatUpperUpper(row, z_cd, xy_cd));
    }
  }
}

HWY_INLINE WallMotion wallMotion(const WallVector& of) {
  NodeVectors positions;
  loadNodes(of, positions);
  Vec3 n[8];
  for (uint32_t c = 0; c < 8; ++c) n[c] = positions.at(c);
  WallMotion out;
  out.cell = motionOf4(faceOf(n[0], n[1], n[2], n[3]), faceOf(n[4], n[5], n[6], n[7]));
  const float* ends = of.at(of.job.walls.ends, kWallEnds);
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 edges[2][2];
    for (int side = 0; side < 2; ++side) {
      for (int other = 0; other < 2; ++other) {
        const uint32_t a = lowerCorner(axis, side, other), b = upperCorner(axis, side, other);
        const float* weights = ends + endsAt(axis, side, other) * kWallLanes;
        const Vec3 edge = n[b] - n[a], before = n[a] - positions.at(nodeBeyond(a, axis)),
                   after = positions.at(nodeBeyond(b, axis)) - n[b];
        edges[side][other] = mulAdd(load(weights), edge - before, load(weights + kWallLanes) * (after - edge));
      }
    }
    addRowMotion(edges, axis, out.rows);
  }
  return out;
}

HWY_INLINE LawBody bodyOf(const WallVector& of) {
  const layout::BodyParams& params = of.job.bodies[of.job.walls.bodies[of.group]];
  return lawBodyOf(params, load(of.at(of.job.walls.strengths, 2) + kWallLanes), false);
}
HWY_INLINE const float* laminateOf(const WallVector& of) {
  const float* numbers = of.job.walls.laminates[of.group];
  return HWY_UNLIKELY(numbers != nullptr) ? numbers + of.lane : nullptr;
}

/// Converts derivatives by modes and rows into forces on nodes, and adds them.
HWY_INLINE void addForces(const WallVector& of, const CellModes& out, const RowMotion& pull) {
  const CellModes none = {zero3(), zero3(), zero3(), zero3(), zero3(), zero3(), zero3()};
  const Corners low = gathered(none, out), high = gathered(out, none);
  Vec3 f[8] = {low.n00, low.n10, low.n01, low.n11, high.n00, high.n10, high.n01, high.n11};
  NodeVectors forces;
  const float* ends = of.at(of.job.walls.ends, kWallEnds);
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      for (int other = 0; other < 2; ++other) {
        const uint32_t a = lowerCorner(axis, side, other), b = upperCorner(axis, side, other);
        const float* weights = ends + endsAt(axis, side, other) * kWallLanes;
        const Vec3 edge = pullOfEdge(pull, axis, 2 * side - 1, 2 * other - 1);
        const Vec3 lower = load(weights) * edge, upper = load(weights + kWallLanes) * edge;
        forces.set(nodeBeyond(a, axis), lower);
        forces.set(nodeBeyond(b, axis), upper);
        f[a] = f[a] + (upper - (lower + lower));
        f[b] = f[b] + (lower - (upper + upper));
      }
    }
  }
  for (uint32_t c = 0; c < 8; ++c) forces.set(c, f[c]);
  addForces(of, forces);
}

/// Adds the forces of a vector of cells.
HWY_INLINE void addCells(const WallVector& of) {
  const LawBody body = bodyOf(of);
  const V mu = hn::Mul(load(of.at(of.job.walls.strengths, 2)), body.per_4h);
  if (hn::AllFalse(Tag(), hn::Gt(mu, hn::Zero(Tag())))) return;
  const WallMotion motion = wallMotion(of);
  const LawWall wall = loadWall(of.at(of.job.walls.numbers, kWallNumbers));
  CellModes out;
  RowMotion pull;
  wallForces(body, loadLawMoments(of.at(of.job.walls.moments, kMomentNumbers), 0), wall, laminateOf(of), mu,
             motion.cell, motion.rows, out, pull);
  addForces(of, out, pull);
}

void wallsOf(const WallJob& job, const uint32_t* groups, size_t count) {
  GroupNodes nodes;
  for (size_t n = 0; n < count; ++n) {
    readGroup(job, groups[n], nodes);
    for (size_t lane = 0; lane < kWallLanes; lane += hn::MaxLanes(Tag())) addCells({job, groups[n], lane, nodes});
    writeGroup(job, groups[n], nodes);
  }
}

/// Measures a vector of cells: energy over rigidity, and stiffness over that at rest.
HWY_INLINE LawMeasured measuredOf(const LawBody& body, const LawMoments& m, const LawWall& wall, const float* laminate,
                                  M there, const WallMotion& motion) {
  const WallPoint at = wallPoint<true>(body, m, wall, there, motion.cell, motion.rows);
  Symmetric g[3], sigma[3];
  gradientsOf(body.poisson, at.s, at.v, g);
  momentsOf(body, m, wall, g, sigma);
  V twice = hn::Zero(Tag());
  for (int k = 0; k < 3; ++k)
    twice = hn::Add(twice, hn::Add(dot(g[k].pulled, sigma[k].pulled), dot(g[k].sheared, sigma[k].sheared)));
  const Columns d = {motion.cell.da, motion.cell.db, motion.cell.dc}, of_star = cofactorsOf(at.star);
  const V e_star = hn::IfThenElseZero(there, dilationOf(at.star, of_star)), none = hn::Zero(Tag());
  LawMeasured out = {lawDensity(body, body.bulk, sizeOf(at.star), e_star), none};
  if (HWY_UNLIKELY(laminate != nullptr)) {
    const LaminateMeasured layers = measureLaminate(body, laminate, at.star, of_star, e_star, none);
    out = {layers.density, layers.stiffening};
  }
  out.energy = hn::MulAdd(set(0.5f), twice, out.energy);
  out.energy = hn::MulAdd(set(kLawAlternating), dot(motion.cell.hxyz, motion.cell.hxyz), out.energy);
  out.stiffening = hn::Max(out.stiffening, hn::Max(stiffeningOf(body, body.bulk, d, at.c, at.e, none),
                                                   stiffeningOf(body, body.bulk, at.star, of_star, e_star, none)));
  return out;
}

void measureWallsOf(const WallJob& job, const uint32_t* groups, size_t count) {
  GroupNodes nodes;
  for (size_t n = 0; n < count; ++n) {
    readGroup(job, groups[n], nodes);
    for (size_t lane = 0; lane < kWallLanes; lane += hn::MaxLanes(Tag())) {
      const WallVector of = {job, groups[n], lane, nodes};
      const LawBody body = bodyOf(of);
      const V rigidity = load(of.at(job.walls.strengths, 2));
      const M there = hn::Gt(rigidity, hn::Zero(Tag()));
      const LawMeasured found =
          measuredOf(body, loadLawMoments(of.at(job.walls.moments, kMomentNumbers), 0),
                     loadWall(of.at(job.walls.numbers, kWallNumbers)), laminateOf(of), there, wallMotion(of));
      float* to = job.walls.measured + 2 * kWallLanes * of.group + lane;
      hn::StoreU(hn::IfThenElseZero(there, hn::Mul(rigidity, found.energy)), Tag(), to);
      hn::StoreU(hn::IfThenElseZero(there, found.stiffening), Tag(), to + kWallLanes);
    }
  }
}

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viscera::simd {

HWY_EXPORT(wallsOf);
HWY_EXPORT(measureWallsOf);

WallForces wallsFor(int64_t target) {
  return VISCERA_KERNEL_FOR(wallsOf, target);
}

WallForces measureWallsFor(int64_t target) {
  return VISCERA_KERNEL_FOR(measureWallsOf, target);
}

}  // namespace viscera::simd
#endif  // HWY_ONCE
