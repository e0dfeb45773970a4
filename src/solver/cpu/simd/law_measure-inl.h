// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Energy and stiffening of cells that obey a hyperelastic law (shaders/solver/tissue/law.glsl). Included once per
// instruction set (Highway).
#if defined(VISCERA_SOLVER_CPU_LAW_MEASURE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VISCERA_SOLVER_CPU_LAW_MEASURE_INL_H
#undef VISCERA_SOLVER_CPU_LAW_MEASURE_INL_H
#else
#define VISCERA_SOLVER_CPU_LAW_MEASURE_INL_H
#endif

#include <cmath>

#include "hwy/contrib/math/math-inl.h"
#include "hwy/highway.h"
#include "solver/cpu/simd/law_bricks-inl.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

/// Returns (exp(b x) - 1) / b, linear in x from b x = kMostExponent on; x without stiffening.
HWY_INLINE V shearEnergy(const LawBody& body, V x) {
  if (!body.stiffens) return x;
  const V y = hn::Mul(body.stiffening, x), least = hn::Min(y, set(kMostExponent));
  const V straight = hn::Mul(hn::Exp(Tag(), least), hn::Sub(y, least));
  return hn::Div(hn::Add(hn::Expm1(Tag(), least), straight), body.stiffening);
}

/// Returns W over mu.
/// @param bulk  K/mu
/// @param size  |F|^2 - 3
HWY_INLINE V lawDensity(const LawBody& body, V bulk, V size, V e) {
  const V one = set(1), two = set(2), least = set(kLeastVolume), j = hn::Add(one, e);
  const V above = hn::Max(e, set(kLeastVolume - 1)), logarithm = hn::Log1p(Tag(), above);
  const V less = hn::Expm1(Tag(), hn::Mul(set(-2.0f / 3), logarithm));  // phi - 1
  const V shape = hn::MulAdd(set(3), less, hn::Mul(hn::Add(one, less), size));
  const V squeezed = hn::MulSub(volumeOf<true>(e).phi, hn::Add(size, set(3)), set(3));
  const M below = hn::Lt(j, least);
  // J^2 - 1 - 2 ln J, with a linear continuation of the logarithm below kLeastVolume
  const V straight = hn::Add(logarithm, hn::Div(hn::Sub(j, hn::Max(j, least)), least));
  const V volume = hn::NegMulAdd(two, straight, hn::Mul(e, hn::Add(e, two)));
  return hn::MulAdd(hn::Mul(set(0.25f), bulk), volume,
                    hn::Mul(set(0.5f), shearEnergy(body, hn::IfThenElse(below, squeezed, shape))));
}

/// Returns the largest row sum of |M|^T |M| for M = 1 + m: at least the square of its largest stretch.
HWY_INLINE V largestOf(const Columns& m) {
  const V one = set(1);
  const Vec3 a = {hn::Add(m.a.x, one), m.a.y, m.a.z}, b = {m.b.x, hn::Add(m.b.y, one), m.b.z};
  const Vec3 c = {m.c.x, m.c.y, hn::Add(m.c.z, one)};
  const V ab = hn::Abs(dot(a, b)), bc = hn::Abs(dot(b, c)), ca = hn::Abs(dot(c, a));
  const V x = hn::Add(dot(a, a), hn::Add(ab, ca)), y = hn::Add(dot(b, b), hn::Add(ab, bc));
  return hn::Max(x, hn::Max(y, hn::Add(dot(c, c), hn::Add(bc, ca))));
}

/// Returns S : (F^T F - 1) / 2.
HWY_INLINE V tensionEnergy(const LawTension& t, const Columns& d) {
  const Columns f = tensionAt(t, d), zero = {zero3(), zero3(), zero3()}, s = tensionAt(t, zero);
  const auto of = [](const Vec3& at, const Vec3& at_rest, const Vec3& by) HWY_ATTR { return dot(at + at_rest, by); };
  return hn::Mul(set(0.5f), hn::Add(of(f.a, s.a, d.a), hn::Add(of(f.b, s.b, d.b), of(f.c, s.c, d.c))));
}
/// Returns the largest row sum of a stress.
HWY_INLINE V largestOf(const LawTension& t) {
  const V x = hn::Abs(t.sheared.x), y = hn::Abs(t.sheared.y), z = hn::Abs(t.sheared.z);
  return hn::Max(hn::Add(hn::Abs(t.pulled.x), hn::Add(y, z)),
                 hn::Max(hn::Add(hn::Abs(t.pulled.y), hn::Add(z, x)), hn::Add(hn::Abs(t.pulled.z), hn::Add(x, y))));
}

/// Computes lawStiffening() of law.glsl.
/// @param tension  largest row sum of the prestress
HWY_INLINE V stiffeningOf(const LawBody& body, V bulk, const Columns& d, const Columns& c, V e, V tension) {
  const V one = set(1), zero = hn::Zero(Tag()), j = hn::Add(e, one);
  const Volume v = volumeOf<true>(e);
  const V size = hn::Add(set(3), sizeOf(d)), x = hn::MulSub(v.phi, size, set(3)), across = largestOf(c);
  const V shear = body.stiffens ? hn::Mul(v.phi, stifferAt(body, x)) : v.phi, slope = hn::Mul(shear, v.slope);
  const V pressing = hn::MulAdd(hn::Mul(set(5.0f / 9), hn::Mul(slope, v.slope)), size,
                                hn::Mul(hn::Mul(set(0.5f), bulk), hn::MulAdd(v.inverse, v.inverse, one)));
  V waves = hn::Add(tension, hn::MulAdd(pressing, across, shear));
  waves = hn::NegMulAdd(hn::Mul(set(4.0f / 3), slope), hn::Max(j, zero), waves);
  const V turned = hn::MulAdd(set(2.0f / 3), slope, hn::Mul(hn::Mul(set(0.5f), bulk), v.inverse));
  waves = hn::IfThenElse(hn::Lt(j, set(kLeastVolume)), hn::MulAdd(turned, hn::Sqrt(size), waves), waves);
  if (body.stiffens) {  // along dx/dF = 2 phi (F - size/(3 J) C)
    const V y = hn::Mul(body.stiffening, x), third = hn::Mul(set(1.0f / 3), hn::Mul(size, v.inverse));
    const V longest = hn::Max(largestOf(d), hn::Mul(hn::Mul(third, third), across));
    const V more = hn::Mul(hn::Mul(set(2), hn::Mul(body.stiffening, v.phi)), hn::Mul(shear, longest));
    const M grows = hn::And(hn::Gt(y, zero), hn::Lt(y, set(kMostExponent)));
    waves = hn::Add(waves, hn::IfThenElseZero(grows, more));
  }
  // lambda/mu + 2 = K/mu + 4/3
  return hn::Max(one, hn::Div(waves, hn::Add(bulk, set(4.0f / 3))));
}

/// Energy of cells with two materials over mu, and lawLaminateStiffening() of laminate.glsl: the mean of the layers',
/// weighted by their part in the fastest wave at rest.
struct LaminateMeasured {
  V density, stiffening;
};
inline HWY_NOINLINE LaminateMeasured measureLaminate(const LawBody& body, const float* numbers, const Columns& d,
                                                     const Columns& c, V e, V tension) {
  LawLaminate l = loadLaminate(numbers);
  findJump(body, d, c, e, l);
  const Columns by = jumpColumns(l), turn = jumpCofactors(l, d);
  LaminateMeasured out = {hn::Zero(Tag()), hn::Zero(Tag())};
  for (const LawLayer* y : {&l.a, &l.b}) {
    const auto moved = [&](const Columns& from, const Columns& jump) HWY_ATTR {
      return Columns{mulAdd(y->s, jump.a, from.a), mulAdd(y->s, jump.b, from.b), mulAdd(y->s, jump.c, from.c)};
    };
    const V of_waves = hn::Mul(y->weight, hn::Add(y->bulk, set(4.0f / 3)));
    out.density = hn::MulAdd(y->weight, lawDensity(body, y->bulk, y->size, y->e), out.density);
    out.stiffening =
        hn::MulAdd(of_waves, stiffeningOf(body, y->bulk, moved(d, by), moved(c, turn), y->e, tension), out.stiffening);
  }
  out.stiffening = hn::Div(out.stiffening, hn::Add(body.bulk, set(4.0f / 3)));
  return out;
}

/// Energy of full cells [J], and the largest stiffness over that at rest.
struct LawMeasured {
  V energy, stiffening;
};
/// Measures the cells of a law above a vector's nodes.
/// @param n  displacements of the corners of these cells [m]
inline HWY_NOINLINE LawMeasured measureLaw(const CellJob& job, const layout::BodyParams& params, size_t slot,
                                           const Vec3 (&n)[8]) {
  const V rigidity = load(job.rigidity + slot), none = hn::Zero(Tag());
  const M there = hn::Gt(rigidity, none);
  if (hn::AllFalse(Tag(), there)) return {none, none};
  const V ratio = hn::IfThenElseZero(there, hn::Div(load(job.bulk + slot), hn::Max(rigidity, set(1e-30f))));
  const LawBody body = lawBodyOf(params, ratio, false);
  const V scale = hn::IfThenElseZero(there, set(body.scale));
  const auto scaled = [&](const Vec3& v) HWY_ATTR { return scale * v; };
  const Face low = faceOf(scaled(n[0]), scaled(n[1]), scaled(n[2]), scaled(n[3]));
  const Face high = faceOf(scaled(n[4]), scaled(n[5]), scaled(n[6]), scaled(n[7]));
  const CellModes q = motionOf4(low, high);
  const float* numbers = job.moments[slot / 64];
  const V twelfth4 = set(4.0f / 12);
  LawMoments m = {zero3(), {twelfth4, twelfth4, twelfth4}, zero3()};
  if (numbers != nullptr) m = loadLawMoments(numbers, static_cast<int>(slot % 64));
  const Columns d = {q.da, q.db, q.dc}, c = cofactorsOf(d);
  const V e = dilationOf(d, c), r = hn::Div(set(1), hn::Max(hn::Add(e, set(1)), set(kLeastVolume)));
  const Curvatures s = {r * transposedOf(c, q.hx), r * transposedOf(c, q.hy), r * transposedOf(c, q.hz)};
  const Curvatures k = lawBends<false>(body, m, s);
  const Columns g = atCentroid(body.poisson, s, m.centroid2);
  const Columns star = {timesOf(d, g.a) + d.a, timesOf(d, g.b) + d.b, timesOf(d, g.c) + d.c};
  const Columns of_star = cofactorsOf(star);
  const V e_star = dilationOf(star, of_star);
  V tension = none, of_tension = none;
  if (job.tension[slot / 64] != nullptr) {
    const float* at = job.tension[slot / 64] + cellNumberAt(static_cast<uint32_t>(slot % 64), 0, kTensionNumbers);
    const LawTension t = loadTension(at);
    of_tension = tensionEnergy(t, star);
    tension = largestOf(t);
  }
  V energy = lawDensity(body, body.bulk, sizeOf(star), e_star);
  const float* laminate = job.laminates[slot / 64];
  V of_layers = none;
  if (HWY_UNLIKELY(laminate != nullptr)) {
    laminate += cellNumberAt(static_cast<uint32_t>(slot % 64), 0, kLaminateNumbers);
    const LaminateMeasured layers = measureLaminate(body, laminate, star, of_star, e_star, tension);
    energy = layers.density;
    of_layers = layers.stiffening;
  }
  energy = hn::MulAdd(set(0.5f), hn::Add(dot(k.x, s.x), hn::Add(dot(k.y, s.y), dot(k.z, s.z))), energy);
  energy = hn::MulAdd(set(kLawAlternating), dot(q.hxyz, q.hxyz), energy);
  energy = hn::Add(energy, of_tension);
  const V stiffening = hn::Max(stiffeningOf(body, body.bulk, d, c, e, tension),
                               hn::Max(of_layers, stiffeningOf(body, body.bulk, star, of_star, e_star, tension)));
  return {hn::Mul(rigidity, energy), hn::IfThenElseZero(there, stiffening)};
}

/// Returns the energy of the remaining springs of broken cells minus that of the rest shape, scaled to full cells [J].
/// @param k  as for addBroken()
/// @param n  displacements [m]
inline HWY_NOINLINE V brokenEnergy(const float* k, const Material& m, float h, const Vec3 (&n)[8]) {
  V energy = hn::Zero(Tag());
  const V eighth = set(0.125f / h);  // half of k, which is stored times 4 h
#define VISCERA_STORED(number, near, far, X, Y, Z)                                                       \
  {                                                                                                      \
    constexpr int kKind = X * X + Y * Y + Z * Z - 1;                                                     \
    const Vec3 w = n[far] - n[near];                                                                     \
    const V more = load(k + 16 * shorterAt(number)), q = growthOf<X, Y, Z>(m, more, w);                  \
    const V per2 = hn::Mul(m.per_length2[kKind], hn::Add(set(1), more));                                 \
    const V ratio = hn::Div(q, hn::Add(set(1), hn::Sqrt(hn::Max(hn::Add(set(1), q), hn::Zero(Tag()))))); \
    const V half = hn::Mul(eighth, load(k + 16 * (number)));                                             \
    const V at_rest = hn::Sub(hn::Sqrt(hn::Add(set(1), more)), set(1));                                  \
    const V squares = hn::Mul(hn::Sub(ratio, at_rest), hn::Add(ratio, at_rest));                         \
    energy = hn::MulAdd(hn::Div(half, per2), squares, energy);                                           \
  }
  VISCERA_SPRINGS_WITHIN(VISCERA_STORED)
#undef VISCERA_STORED
  return energy;
}

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
