// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Cells of multigrid's finest level, a vector of cells at a time: their forces, and what a change of displacement makes
// of these. Included once per instruction set (Highway).
#if defined(VISCERA_SOLVER_MULTIGRID_FINE_CELLS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VISCERA_SOLVER_MULTIGRID_FINE_CELLS_INL_H
#undef VISCERA_SOLVER_MULTIGRID_FINE_CELLS_INL_H
#else
#define VISCERA_SOLVER_MULTIGRID_FINE_CELLS_INL_H
#endif

#include "hwy/highway.h"
#include "solver/cpu/simd/crushed-inl.h"
#include "solver/cpu/simd/moments-inl.h"
#include "solver/cpu/simd/tiles-inl.h"
#include "solver/multigrid/levels/fine_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

HWY_INLINE Vec3 loadOf(const float* x, size_t places, size_t at) {
  return {load(x + at), load(x + places + at), load(x + 2 * places + at)};
}
HWY_INLINE void storeTo(const Vec3& value, float* x, size_t places, size_t at) {
  hn::StoreU(value.x, Tag(), x + at);
  hn::StoreU(value.y, Tag(), x + places + at);
  hn::StoreU(value.z, Tag(), x + 2 * places + at);
}

/// The upper half of a float32, rounded: tangents are read often, and three digits are enough.
HWY_INLINE void storeShort(V value, uint16_t* to) {
  const hn::RebindToSigned<Tag> words;
  const auto bits = hn::BitCast(words, hn::ShiftRight<16>(hn::Add(hn::BitCast(hn::RebindToUnsigned<Tag>(), value),
                                                                  hn::Set(hn::RebindToUnsigned<Tag>(), 0x8000u))));
  hn::StoreU(hn::DemoteTo(hn::Rebind<uint16_t, Tag>(), bits), hn::Rebind<uint16_t, Tag>(), to);
}
HWY_INLINE V loadShort(const uint16_t* from) {
  const hn::RebindToUnsigned<Tag> words;
  return hn::BitCast(Tag(), hn::ShiftLeft<16>(hn::PromoteTo(words, hn::LoadU(hn::Rebind<uint16_t, Tag>(), from))));
}

/// T d of a spring. @param of_pair  its pair's tangents
HWY_INLINE Vec3 springTimes(const uint16_t* of_pair, size_t places, size_t at, const Vec3& d) {
  const Vec3 s = {loadShort(of_pair + at), loadShort(of_pair + places + at), loadShort(of_pair + 2 * places + at)};
  return mulAdd(dot(s, d), s, loadShort(of_pair + 3 * places + at) * d);
}

/// Place of corner c (bits x, y, z) of a cell, from that of its lowest one.
HWY_INLINE ptrdiff_t toCorner(const multigrid::Box& box, size_t c) {
  return static_cast<ptrdiff_t>(c & 1) + static_cast<ptrdiff_t>(c >> 1 & 1) * box.row +
         static_cast<ptrdiff_t>(c >> 2) * box.layer;
}

/// What the cells around nodes do to these.
HWY_INLINE Vec3 gatherCorners(const multigrid::FineArrays& a, const multigrid::Box& box, size_t i) {
  Vec3 sum = zero3();
  for (size_t c = 0; c < 8; ++c)
    sum = sum + loadOf(a.corners + 3 * c * a.places, a.places, i - static_cast<size_t>(toCorner(box, c)));
  return sum;
}

/// Writes the forces of cells on their corners. @param q  pulls by their motion, see cellPull()
HWY_INLINE void writeCorners(const multigrid::FineArrays& a, size_t i, const CellMotion& q) {
  for (int upper = 0; upper < 2; ++upper) {
    Vec3 ss = q.dc, sd = q.hx - q.db, ds = q.hy - q.da, dd = q.hxyz - q.hz;
    if (upper) {
      ss = zero3() - q.dc;
      sd = zero3() - (q.hx + q.db);
      ds = zero3() - (q.hy + q.da);
      dd = zero3() - (q.hxyz + q.hz);
    }
    const Vec3 even = ss + dd, odd = ss - dd, sum = sd + ds, difference = sd - ds;
    const Vec3 forces[4] = {even - sum, odd - difference, odd + difference, even + sum};
    for (size_t c = 0; c < 4; ++c)
      storeTo(forces[c], a.corners + 3 * (c + 4 * static_cast<size_t>(upper)) * a.places, a.places, i);
  }
}

HWY_INLINE CellMotion motionAt(const float* x, size_t places, const multigrid::Box& box, size_t i, V per_4h) {
  Vec3 n[8];
  for (size_t c = 0; c < 8; ++c) n[c] = loadOf(x, places, i + static_cast<size_t>(toCorner(box, c)));
  return motionBetween(faceOf(n[0], n[1], n[2], n[3]), faceOf(n[4], n[5], n[6], n[7]), per_4h);
}

HWY_INLINE Moments momentsAt(const multigrid::FineArrays& a, size_t i) {
  return {loadOf(a.moments, a.places, i), loadOf(a.moments + 3 * a.places, a.places, i),
          loadOf(a.moments + 6 * a.places, a.places, i)};
}

HWY_INLINE ThinWalls thinWallsAt(const multigrid::FineArrays& a, size_t i) {
  constexpr size_t kBlock = multigrid::kBlock;
  const uint32_t block = a.bend_block == nullptr ? 0 : a.bend_block[i / kBlock];
  if (block == 0) return {};
  return {a.bends + (block - 1) * layout::kBendNumbers * kBlock + i % kBlock, kBlock};
}

/// lambda/mu - 1 of cells.
HWY_INLINE V ratioOf(V bulk, V rigidity) {
  const M there = hn::Gt(rigidity, hn::Zero(Tag()));
  return hn::IfThenElseZero(there, hn::Div(bulk, hn::IfThenElse(there, rigidity, set(1))));
}

/// W(e) (shaders/solver/tissue/volume.glsl).
HWY_INLINE V volumeEnergyOf(V bulk, V e) {
  const V one = set(1), size = hn::Abs(e), half = set(0.5f), e2 = hn::Mul(e, e);
  const V linear = hn::IfThenElse(hn::Lt(size, one), hn::Mul(half, e2), hn::Sub(size, half));
  const V g = hn::IfThenElseZero(hn::Gt(e, set(-1)), hn::Div(hn::Add(e, e2), hn::Add(one, e2)));
  return hn::Mul(bulk, hn::IfThenElse(hn::Gt(bulk, hn::Zero(Tag())), linear, hn::Mul(half, hn::Mul(g, g))));
}
/// W''(e); of negative bulk what is left without the curvature of g, which is the same at rest.
HWY_INLINE V volumeCurvatureOf(V bulk, V e) {
  const V one = set(1), q = hn::MulAdd(e, e, one);
  const V slope = hn::Div(hn::NegMulAdd(e, e, hn::MulAdd(set(2), e, one)), hn::Mul(q, q));
  const V soft = hn::IfThenElseZero(hn::Gt(e, set(-1)), hn::Mul(slope, slope));
  const V hard = hn::IfThenElseZero(hn::Lt(hn::Abs(e), one), one);
  return hn::Mul(bulk, hn::IfThenElse(hn::Gt(bulk, hn::Zero(Tag())), hard, soft));
}

/// Of a crushed cell (shaders/solver/tissue/crushed.glsl), as if all its corners had the mean volume.
HWY_INLINE V crushedCurvatureOf(V rigidity, V e) {
  const V lacks = hn::Sub(set(kCrushed - 1), e);
  const M crushed = hn::And(hn::Gt(lacks, hn::Zero(Tag())), hn::Lt(lacks, set(kMostCrushed)));
  return hn::IfThenElseZero(crushed, hn::Mul(set(kCrushing), rigidity));
}

/// Part of cellPull() that its scale has at constant directions.
HWY_INLINE V momentScale(const CellMotion& q, V rigidity, const CellScale& of) {
  CellMotion copy = q;
  CellEdges e;
  const bool fades = cellEdges<false>(copy, e);
  V size = hn::Zero(Tag());
  for (const CellEdge* edge : {&e.a, &e.b, &e.c}) {
    const Vec3 s = {dot(edge->direction, q.hx), dot(edge->direction, q.hy), dot(edge->direction, q.hz)};
    size = hn::Add(size, dot(s, s));
  }
  const V bent = hn::Mul(of.bent, size);
  V scale = hn::Div(hn::Mul(rigidity, of.per_4h2), hn::MulAdd(bent, bent, set(1)));
  if (fades) scale = hn::Mul(scale, hn::Mul(hn::Mul(e.a.fade, e.b.fade), e.c.fade));
  return scale;
}

/// How much of what moments take off the stiffness of springs counts in tangents. At rest the two fit, and all of it
/// does. In a strained cell springs point elsewhere than its mean edges; where little tissue fills the cell, the
/// difference of the two, which is all that there is, would be negative.
HWY_INLINE V surenessOf(const CellMotion& q, const CellScale& of) {
  const float kUnsure = 0.5f;  // per strain, shear or bend
  CellMotion copy = q;
  CellEdges e;
  cellEdges<false>(copy, e);
  V sum = hn::Zero(Tag());
  const CellEdge* const edges[4] = {&e.a, &e.b, &e.c, &e.a};
  for (int i = 0; i < 3; ++i) {
    const Vec3 &a = edges[i]->direction, &b = edges[i + 1]->direction;
    const V longer = hn::Sub(edges[i]->shrink, set(1)), shear = dot(a, b);
    const Vec3 bend = {dot(a, q.hx), dot(a, q.hy), dot(a, q.hz)};
    sum = hn::MulAdd(longer, longer, hn::MulAdd(shear, shear, hn::MulAdd(of.per_4h2, dot(bend, bend), sum)));
  }
  return hn::Max(hn::NegMulAdd(set(kUnsure), hn::Sqrt(sum), set(1)), hn::Zero(Tag()));
}

/// @return energy   kTangent: with what its tangent needs, else forces alone
template <bool kTangent, bool kMoments, bool kFull>
HWY_INLINE V evaluateCell(const multigrid::FineArrays& a, const multigrid::Box& box, const CellScale& scale, size_t i) {
  const size_t n = a.places;
  const V none = hn::Zero(Tag()), bulk = load(a.bulk + i), rigidity = kMoments ? load(a.rigidity + i) : none;
  const M absent = hn::And(hn::Eq(rigidity, none), hn::Eq(bulk, none));
  CellMotion q = motionAt(a.displacement, n, box, i, hn::IfThenZeroElse(absent, scale.per_4h));
  const Shape shape = shapeOfEdges(q.da, q.db, q.dc);
  if (kTangent) {
    storeTo(q.da, a.edges, n, i);
    storeTo(q.db, a.edges + 3 * n, n, i);
    storeTo(q.dc, a.edges + 6 * n, n, i);
    hn::StoreU(hn::Add(volumeCurvatureOf(bulk, shape.e), crushedCurvatureOf(rigidity, shape.e)), Tag(), a.resists + i);
  }
  V energy = volumeEnergyOf(bulk, shape.e);
  const V p = hn::Mul(scale.per_4h, pressureOf(bulk, shape.e));
  if (kMoments) {
    if (kTangent) {
      hn::StoreU(momentScale(q, rigidity, scale), Tag(), a.resists + n + i);
      hn::StoreU(surenessOf(q, scale), Tag(), a.resists + 2 * n + i);
    }
    const Moments moments = kFull ? Moments{zero3(), zero3(), zero3()} : momentsAt(a, i);
    const ThinWalls walls = kFull ? ThinWalls{} : thinWallsAt(a, i);
    const PlaneStress<kFull> stress = planeStress<kFull>(ratioOf(bulk, rigidity));
    const CellMotion motion = q;
    energy = hn::Add(energy, cellPull<kFull>(q, moments, walls, rigidity, stress, scale));
    if (mayBeCrushed(motion, hn::Gt(rigidity, hn::Zero(Tag())), scale.per_4h2))
      energy = hn::Add(energy, addCrushed(motion, rigidity, scale.per_4h, q));
    q.da = mulAdd(p, shape.bc, q.da);
    q.db = mulAdd(p, shape.ca, q.db);
    q.dc = mulAdd(p, shape.ab, q.dc);
  } else {
    q = {p * shape.bc, p * shape.ca, p * shape.ab, zero3(), zero3(), zero3(), zero3()};
  }
  writeCorners(a, i, q);
  return energy;
}

/// A cell's share of moments in the change of its pulls, for a change `x` of its motion, at constant directions.
/// @param sure  see surenessOf()
template <bool kFull>
HWY_INLINE CellMotion momentTimes(const CellEdges& e, const Moments& t, const ThinWalls& walls,
                                  const PlaneStress<kFull>& stress, V scale, V sure, V per_4h, const CellMotion& x) {
  const Vec3 &a = e.a.direction, &b = e.b.direction, &c = e.c.direction;
  const Vec3 sa = {dot(a, x.hx), dot(a, x.hy), dot(a, x.hz)}, sb = {dot(b, x.hx), dot(b, x.hy), dot(b, x.hz)};
  const Vec3 sc = {dot(c, x.hx), dot(c, x.hy), dot(c, x.hz)};
  const Vec3 gx = {sb.z, sc.y, hn::Add(sb.y, sc.z)}, gy = {sc.x, sa.z, hn::Add(sc.z, sa.x)};
  const Vec3 gz = {sa.y, sb.x, hn::Add(sa.x, sb.y)};
  SolidPull solid;
  Bend thin = {zero3(), zero3(), zero3()};
  if constexpr (kFull) {
    solid = solidPull(e, t, stress, gx, gy, gz);
  } else {
    const Vec3 strain = {hn::Mul(e.a.strain_slope, dot(a, x.da)), hn::Mul(e.b.strain_slope, dot(b, x.db)),
                         hn::Mul(e.c.strain_slope, dot(c, x.dc))};
    const V none = hn::Zero(Tag()), one = set(1);
    const Vec3 ta = edgePull(e.a, one, x.da, none), tb = edgePull(e.b, one, x.db, none);
    const Vec3 tc = edgePull(e.c, one, x.dc, none);
    const Vec3 shear = {hn::Add(dot(b, tc), dot(c, tb)), hn::Add(dot(c, ta), dot(a, tc)),
                        hn::Add(dot(a, tb), dot(b, ta))};
    solid = solidPullOf(strain, shear, t, stress, gx, gy, gz);
    if (walls.numbers != nullptr) {
      SolidPull of_walls = {};
      of_walls.strains = of_walls.shears = zero3();
      of_walls.coupled = none;
      addThinWalls(walls, {sa, sb, sc}, sure * strain, sure * shear, thin, of_walls);
      solid.strains = solid.strains + sure * of_walls.strains;
      solid.shears = solid.shears + sure * of_walls.shears;
    }
  }
  const V minus = hn::Mul(set(-0.25f), sure), trace4 = hn::Mul(minus, hn::Add(sa.x, hn::Add(sb.y, sc.z)));
  const Vec3 pair4 = minus * Vec3{hn::Add(sb.z, sc.y), hn::Add(sc.x, sa.z), hn::Add(sa.y, sb.x)};
  const Vec3 &bx = solid.bx, &by = solid.by, &bz = solid.bz;
  const Vec3 ra =
      scale * (thin.a + mulAdd(minus, sa,
                               {hn::Add(hn::Add(by.z, bz.z), trace4), hn::Add(bz.x, pair4.z), hn::Add(by.y, pair4.y)}));
  const Vec3 rb =
      scale * (thin.b + mulAdd(minus, sb,
                               {hn::Add(bz.y, pair4.z), hn::Add(hn::Add(bz.z, bx.z), trace4), hn::Add(bx.x, pair4.x)}));
  const Vec3 rc =
      scale * (thin.c + mulAdd(minus, sc,
                               {hn::Add(by.x, pair4.y), hn::Add(bx.y, pair4.x), hn::Add(hn::Add(bx.z, by.z), trace4)}));
  CellMotion out = {zero3(),
                    zero3(),
                    zero3(),
                    weighted(ra.x, a, rb.x, b, rc.x, c),
                    weighted(ra.y, a, rb.y, b, rc.y, c),
                    weighted(ra.z, a, rb.z, b, rc.z, c),
                    hn::Mul(scale, hn::MulAdd(set(-0.25f), sure, set(0.5f * kAlternating + 0.25f))) * x.hxyz};
  if constexpr (!kFull) {
    const Vec3 shears = scale * solid.shears, strains = scale * solid.strains;
    const auto pull = [&](const CellEdge& edge, V strain, V y, const Vec3& of_y, V z, const Vec3& of_z) HWY_ATTR {
      return edgePull(edge, per_4h, mulAdd(y, of_y, z * of_z), hn::Mul(strain, edge.strain_slope));
    };
    out.da = pull(e.a, strains.x, shears.y, c, shears.z, b);
    out.db = pull(e.b, strains.y, shears.z, a, shears.x, c);
    out.dc = pull(e.c, strains.z, shears.x, b, shears.y, a);
  }
  return out;
}

template <bool kMoments, bool kFull>
HWY_INLINE void applyCell(const multigrid::FineArrays& a, const float* x, const multigrid::Box& box,
                          const CellScale& scale, size_t i) {
  const size_t n = a.places;
  const V none = hn::Zero(Tag()), curvature = load(a.resists + i),
          moment_scale = kMoments ? load(a.resists + n + i) : none;
  const M absent = hn::And(hn::Eq(curvature, none), hn::Eq(moment_scale, none));
  CellMotion at = {loadOf(a.edges, n, i),
                   loadOf(a.edges + 3 * n, n, i),
                   loadOf(a.edges + 6 * n, n, i),
                   zero3(),
                   zero3(),
                   zero3(),
                   zero3()};
  const CellMotion dx = motionAt(x, n, box, i, hn::IfThenZeroElse(absent, scale.per_4h));
  CellMotion out = {zero3(), zero3(), zero3(), zero3(), zero3(), zero3(), zero3()};
  if (kMoments) {
    CellEdges e;
    cellEdges<!kFull>(at, e);
    const V sure = load(a.resists + 2 * n + i);
    Moments moments = kFull ? Moments{zero3(), zero3(), zero3()} : momentsAt(a, i);
    if (!kFull) moments.first = sure * moments.first;
    const V ratio = ratioOf(load(a.bulk + i), load(a.rigidity + i));
    const ThinWalls walls = kFull ? ThinWalls{} : thinWallsAt(a, i);
    out = momentTimes<kFull>(e, moments, walls, planeStress<kFull>(ratio), moment_scale, sure, scale.per_4h, dx);
  }
  if (!hn::AllTrue(Tag(), hn::Eq(curvature, none))) {
    const Shape shape = shapeOfEdges(at.da, at.db, at.dc);
    const V change = hn::Add(dot(shape.bc, dx.da), hn::Add(dot(shape.ca, dx.db), dot(shape.ab, dx.dc)));
    const V p = hn::Mul(scale.per_4h, hn::Mul(curvature, change));
    out.da = mulAdd(p, shape.bc, out.da);
    out.db = mulAdd(p, shape.ca, out.db);
    out.dc = mulAdd(p, shape.ab, out.dc);
  }
  writeCorners(a, i, out);
}

/// Runs `each` for the vectors of blocks, by the kind of their cells.
template <class Each>
HWY_INLINE void forCells(const multigrid::FineArrays& a, const multigrid::Block* blocks, size_t count,
                         const Each& each) {
  for (size_t b = 0; b < count; ++b) {
    const multigrid::Box& box = a.boxes[blocks[b].body];
    const CellScale scale = cellScale(box.params.origin_spacing.w);
    for (size_t i = blocks[b].at; i < blocks[b].at + multigrid::kBlock; i += hn::MaxLanes(Tag())) each(box, scale, i);
  }
}

template <bool kTangent>
HWY_INLINE void evaluateCellsOf(const multigrid::FineArrays& a, const multigrid::Block* blocks, size_t count,
                                double* energy_j) {
  forCells(a, blocks, count, [&](const multigrid::Box& box, const CellScale& scale, size_t i) HWY_ATTR {
    V energy;
    if (a.cells == multigrid::CellKind::kVolumes)
      energy = evaluateCell<kTangent, false, true>(a, box, scale, i);
    else if (a.cells == multigrid::CellKind::kMoments)
      energy = evaluateCell<kTangent, true, true>(a, box, scale, i);
    else
      energy = evaluateCell<kTangent, true, false>(a, box, scale, i);
    *energy_j += static_cast<double>(hn::GetLane(hn::SumOfLanes(Tag(), energy)));
  });
}

void lineariseCells(const multigrid::FineArrays& a, const multigrid::Block* blocks, size_t count, double* energy_j) {
  evaluateCellsOf<true>(a, blocks, count, energy_j);
}
void evaluateCells(const multigrid::FineArrays& a, const multigrid::Block* blocks, size_t count, double* energy_j) {
  evaluateCellsOf<false>(a, blocks, count, energy_j);
}

void applyCells(const multigrid::FineArrays& a, const float* x, const multigrid::Block* blocks, size_t count) {
  forCells(a, blocks, count, [&](const multigrid::Box& box, const CellScale& scale, size_t i) HWY_ATTR {
    if (a.cells == multigrid::CellKind::kVolumes)
      applyCell<false, true>(a, x, box, scale, i);
    else if (a.cells == multigrid::CellKind::kMoments)
      applyCell<true, true>(a, x, box, scale, i);
    else
      applyCell<true, false>(a, x, box, scale, i);
  });
}

/// Calls add(s) with s s^T what volumes of cells around nodes add to their block diagonal, where positive.
template <class Add>
HWY_INLINE void addVolumes(const multigrid::FineArrays& a, const multigrid::Box& box, size_t i, const Add& add) {
  const size_t n = a.places;
  const V quarter = set(0.25f / box.params.origin_spacing.w);
  for (size_t c = 0; c < 8; ++c) {
    const size_t cell = i - static_cast<size_t>(toCorner(box, c));
    const V curvature = hn::Max(load(a.resists + cell), hn::Zero(Tag()));
    if (hn::AllTrue(Tag(), hn::Eq(curvature, hn::Zero(Tag())))) continue;
    const Shape shape =
        shapeOfEdges(loadOf(a.edges, n, cell), loadOf(a.edges + 3 * n, n, cell), loadOf(a.edges + 6 * n, n, cell));
    const Vec3 x = c & 1 ? shape.bc : zero3() - shape.bc, y = c & 2 ? shape.ca : zero3() - shape.ca;
    const Vec3 g = (c & 4 ? shape.ab : zero3() - shape.ab) + (x + y);
    add(hn::Mul(quarter, hn::Sqrt(curvature)) * g);
  }
}

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
