// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The neo-Hookean law of a cell (physics.md 1, Law): W(F*) + s.K.s/2 + 5/36 mu |H_xyz|^2 over its volume, with W = mu/2 (J^(-2/3)
// |F|^2 - 3) + K/4 (J^2 - 1 - 2 ln J). s = F^-1 H are its hourglass modes in the material's frame. F* is the deformation gradient
// at the centroid of the tissue part of the cell. Everything is computed from D = F - 1, so nothing cancels near rest. With a
// stiffening b the first term is mu/(2 b) (exp(b x) - 1), x = J^(-2/3) |F|^2 - 3, continued linearly from b x = kMostExponent. A
// cell that is stressed at rest has in addition S : (F^T F - 1) / 2, of F* (physics.md 1, Prestress).
// After cell_modes.glsl.

/// Columns of a 3x3 matrix.
struct LawColumns {
  vec3 a, b, c;
};

LawColumns lawColumns(vec3 a, vec3 b, vec3 c) {
  LawColumns out_ = {a, b, c};
  return out_;
}

/// Returns cof(1 + D) - 1.
LawColumns lawCofactors(LawColumns d) {
  vec3 a = d.a, b = d.b, c = d.c;
  return lawColumns(vec3(b.y + c.z + (b.y * c.z - b.z * c.y), b.z * c.x - (b.x * c.z + b.x), b.x * c.y - (b.y * c.x + c.x)),
                    vec3(c.y * a.z - (c.z * a.y + a.y), c.z + a.x + (c.z * a.x - c.x * a.z), c.x * a.y - (c.y * a.x + c.y)),
                    vec3(a.y * b.z - (a.z * b.y + a.z), a.z * b.x - (a.x * b.z + b.z), a.x + b.y + (a.x * b.y - a.y * b.x)));
}

/// Returns det(1 + D) - 1. @param c  lawCofactors(d)
float lawDilation(LawColumns d, LawColumns c) { return d.a.x + c.a.x + dot(d.a, c.a); }

/// Return (1 + M) v and (1 + M)^T v.
vec3 lawTimes(LawColumns m, vec3 v) { return v + v.x * m.a + v.y * m.b + v.z * m.c; }
vec3 lawTransposed(LawColumns m, vec3 v) { return v + vec3(dot(m.a, v), dot(m.b, v), dot(m.c, v)); }

/// Functions of J = 1 + e in W: phi = J^(-2/3), its slope as -3/2 phi'/phi, and 1/J. Below kLeastVolume phi levels off and 1/J is
/// constant.
struct LawVolume {
  float phi, slope, inverse;
};
LawVolume lawVolume(float e) {
  LawVolume v;
  float j = 1.0f + e, least = max(j, kLeastVolume);
  v.inverse = 1.0f / least;
  float t = pow(least, -1.0f / 3.0f);
  v.phi = t * t;
  v.slope = v.inverse;
  if (j < kLeastVolume) {
    float rest = 2.0f * kLeastVolume - j, grown = 1.0f + (2.0f / 3.0f) * (kLeastVolume - j) / rest;
    v.phi *= grown;
    v.slope = kLeastVolume / (rest * rest * grown);
  }
  return v;
}

/// Returns |1 + D|^2 - 3.
float lawSize(LawColumns d) { return 2.0f * (d.a.x + d.b.y + d.c.z) + dot(d.a, d.a) + dot(d.b, d.b) + dot(d.c, d.c); }

/// Returns the factor by which shear stiffens at x.
float lawStiffer(float x, float stiffening) { return stiffening == 0.0f ? 1.0f : exp(min(stiffening * x, kMostExponent)); }

/// Terms of dW/dF = shear (F - C) + kappa C over mu, C = cof F; `off` is the part of kappa due to shear, over shear.
struct LawLayer {
  float e, shear, kappa, off, inverse, slope;
};
/// @param e  J - 1   @param size  |F|^2 - 3   @param bulk  K/mu
LawLayer lawLayer(float e, float size, float bulk, float stiffening) {
  LawVolume v = lawVolume(e);
  LawLayer y;
  y.e = e;
  y.inverse = v.inverse;
  y.slope = v.slope;
  y.off = 1.0f + e >= kLeastVolume ? (size / 3.0f - e) * v.inverse : v.slope * (1.0f + size / 3.0f) - 1.0f;
  float pressure = 0.5f * bulk * (e + (1.0f + e >= kLeastVolume ? e * v.inverse : 1.0f - v.inverse));
  y.shear = v.phi * lawStiffer(v.phi * (3.0f + size) - 3.0f, stiffening);
  y.kappa = pressure - y.shear * y.off;
  return y;
}

/// Returns dW/dF over mu. @param c, e  cofactors and dilation of d   @param bulk  K/mu
LawColumns lawStress(LawColumns d, LawColumns c, float e, float bulk, float stiffening) {
  LawLayer y = lawLayer(e, lawSize(d), bulk, stiffening);
  float of_c = y.kappa - y.shear;
  LawColumns p = lawColumns(y.shear * d.a + of_c * c.a, y.shear * d.b + of_c * c.b, y.shear * d.c + of_c * c.c);
  p.a.x += y.kappa;
  p.b.y += y.kappa;
  p.c.z += y.kappa;
  return p;
}

/// Return ln(1 + x) and exp(x) - 1, to float rounding also near 0.
float lawLog1(float x) {
  if (abs(x) > 0.1f) return log(1.0f + x);
  float z = x / (2.0f + x), q = z * z;
  return 2.0f * z * (1.0f + q * (1.0f / 3.0f + q * (0.2f + q / 7.0f)));
}
float lawExp1(float x) {
  if (abs(x) > 0.1f) return exp(x) - 1.0f;
  return x * (1.0f + x * (0.5f + x * (1.0f / 6.0f + x * (1.0f / 24.0f + x * (1.0f / 120.0f)))));
}

/// Returns (exp(b x) - 1) / b, continued linearly from b x = kMostExponent; x without stiffening.
float lawShear(float x, float stiffening) {
  if (stiffening == 0.0f) return x;
  float y = stiffening * x, least = min(y, kMostExponent);
  return (lawExp1(least) + exp(least) * (y - least)) / stiffening;
}

/// Returns W over mu. @param size  |F|^2 - 3
float lawDensity(float size, float e, float bulk, float stiffening) {
  float j = 1.0f + e;
  if (j >= kLeastVolume) {
    float log_ = lawLog1(e), less = lawExp1((-2.0f / 3.0f) * log_);  // phi - 1
    float shear = lawShear(3.0f * less + (1.0f + less) * size, stiffening);
    return 0.5f * shear + 0.25f * bulk * (2.0f * e + e * e - 2.0f * log_);
  }
  float log_ = log(kLeastVolume) + (j - kLeastVolume) / kLeastVolume;
  return 0.5f * lawShear(lawVolume(e).phi * (3.0f + size) - 3.0f, stiffening) + 0.25f * bulk * (j * j - 1.0f - 2.0f * log_);
}

/// Second moments of a cell's tissue about its centroid, and constants of its law.
struct LawCell {
  vec3 center, square, mixed;
  float poisson, along, aside;  // lambda / (lambda + 2 mu); plane stress over mu
};
LawCell lawCell(CellMoments t, float ratio) {
  LawCell cell;
  vec3 c = t.first;
  cell.center = c;
  cell.square = t.square - c * c;
  cell.mixed = t.mixed - vec3(c.y * c.z, c.z * c.x, c.x * c.y);
  cell.poisson = (ratio + 1.0f) / (ratio + 3.0f);
  cell.along = 4.0f * (ratio + 2.0f) / (ratio + 3.0f);
  cell.aside = 2.0f * cell.poisson;
  return cell;
}

/// Returns the derivatives of s.K.s/2 by s, over mu: rows are the axes of the frame. @param s  s_al, row by row
LawColumns lawBends(LawCell t, LawColumns s) {
  vec3 gx = vec3(s.b.z, s.c.y, s.b.y + s.c.z);  // yy, zz, 2 yz
  vec3 gy = vec3(s.c.x, s.a.z, s.c.z + s.a.x);  // zz, xx, 2 zx
  vec3 gz = vec3(s.a.y, s.b.x, s.a.x + s.b.y);  // xx, yy, 2 xy
  vec3 dx = vec3(-t.poisson * (gx.x + gx.y), gx.x, gx.y);
  vec3 dy = vec3(gy.y, -t.poisson * (gy.x + gy.y), gy.x);
  vec3 dz = vec3(gz.x, gz.y, -t.poisson * (gz.x + gz.y));
  vec3 mx = t.square.x * dx + t.mixed.z * dy + t.mixed.y * dz;
  vec3 my = t.mixed.z * dx + t.square.y * dy + t.mixed.x * dz;
  vec3 mz = t.mixed.y * dx + t.mixed.x * dy + t.square.z * dz;
#define LAW_PLANE_STRESS(p, o, twist) vec3(t.along * (p) + t.aside * (o), t.along * (o) + t.aside * (p), twist)
  vec3 bx = LAW_PLANE_STRESS(mx.y, mx.z, t.square.x * gx.z), by = LAW_PLANE_STRESS(my.z, my.x, t.square.y * gy.z);
  vec3 bz = LAW_PLANE_STRESS(mz.x, mz.y, t.square.z * gz.z);
#undef LAW_PLANE_STRESS
  return lawColumns(vec3(by.z + bz.z, bz.x, by.y), vec3(bz.y, bz.z + bx.z, bx.x), vec3(by.x, bx.y, bx.z + by.z));
}

/// Returns the columns of G of F* = F (1 + G). @param s  s_al, row by row
LawColumns lawAtCentroid(LawCell t, LawColumns s) {
  vec3 c = t.center;
  float p = t.poisson;
  return lawColumns(vec3(s.a.z * c.y + s.a.y * c.z - p * c.x * (s.b.z + s.c.y), s.b.z * c.y + s.b.y * c.z - c.x * s.a.z,
                         s.c.z * c.y + s.c.y * c.z - c.x * s.a.y),
                    vec3(s.a.x * c.z + s.a.z * c.x - c.y * s.b.z, s.b.x * c.z + s.b.z * c.x - p * c.y * (s.c.x + s.a.z),
                         s.c.x * c.z + s.c.z * c.x - c.y * s.b.x),
                    vec3(s.a.y * c.x + s.a.x * c.y - c.z * s.c.y, s.b.y * c.x + s.b.x * c.y - c.z * s.c.x,
                         s.c.y * c.x + s.c.x * c.y - p * c.z * (s.a.y + s.b.x)));
}

/// Adds to r, the derivatives by s, the contribution of q = F^T dW/dF* through G.
void lawAddCentroid(LawCell t, LawColumns q, INOUT(LawColumns) r) {
  vec3 c = t.center;
  float px = t.poisson * c.x * q.a.x, py = t.poisson * c.y * q.b.y, pz = t.poisson * c.z * q.c.z;
  r.a += vec3(c.z * q.b.x + c.y * q.c.x, c.z * q.a.x + c.x * q.c.x - c.x * q.a.z - pz, c.y * q.a.x + c.x * q.b.x - c.x * q.a.y - py);
  r.b += vec3(c.z * q.b.y + c.y * q.c.y - c.y * q.b.z - pz, c.z * q.a.y + c.x * q.c.y, c.y * q.a.y + c.x * q.b.y - c.y * q.b.x - px);
  r.c += vec3(c.z * q.b.z + c.y * q.c.z - c.z * q.c.y - py, c.z * q.a.z + c.x * q.c.z - c.z * q.c.x - px, c.y * q.a.z + c.x * q.b.z);
}

/// Returns s = F^-1 H, row by row. @param c, e  cofactors and dilation of the mean edges
LawColumns lawFrame(CellModes q, LawColumns c, float e) {
  float inverse = 1.0f / max(1.0f + e, kLeastVolume);
  vec3 gx = lawTransposed(c, q.hx), gy = lawTransposed(c, q.hy), gz = lawTransposed(c, q.hz);
  return lawColumns(inverse * vec3(gx.x, gy.x, gz.x), inverse * vec3(gx.y, gy.y, gz.y), inverse * vec3(gx.z, gy.z, gz.z));
}

#ifdef PRESTRESS
/// Adds F S of the stress at rest S to dW/dF, over mu, and S : (F^T F - 1) / 2 to the density.
void lawAddPrestress(CellMoments t, LawColumns d, INOUT(LawColumns) p, INOUT(float) density) {
  vec3 a = vec3(t.pulled.x, t.sheared.z, t.sheared.y), b = vec3(t.sheared.z, t.pulled.y, t.sheared.x), c = vec3(t.sheared.y, t.sheared.x, t.pulled.z);
  vec3 fa = lawTimes(d, a), fb = lawTimes(d, b), fc = lawTimes(d, c);
  p.a += fa;
  p.b += fb;
  p.c += fc;
  density += 0.5f * (dot(fa, d.a) + dot(fb, d.b) + dot(fc, d.c) + dot(a, d.a) + dot(b, d.b) + dot(c, d.c));
}

/// Returns a bound on its contribution to the fastest wave, over mu: its largest row sum.
float lawTension(CellMoments t) {
  vec3 sheared = abs(t.sheared), rows = abs(t.pulled) + sheared.zxy + sheared.yzx;
  return max(rows.x, max(rows.y, rows.z));
}
#endif

#ifdef LAMINATES
#include "solver/tissue/laminate.glsl"
#endif

/// Returns dW/dF over mu at the centroid of a cell's tissue; sets W over mu. @param c, e  cofactors and dilation of d
LawColumns lawPoint(LawColumns d, LawColumns c, float e, float bulk, float stiffening, CellMoments t, OUT(float) density) {
#ifdef LAMINATES
  if (t.plane.w < 1.0f) return lawLaminateStress(t, d, c, e, stiffening, density);
#endif
  density = lawDensity(lawSize(d), e, bulk, stiffening);
  return lawStress(d, c, e, bulk, stiffening);
}

/// Returns P* (1 + G)^T: the derivative by the mean edges, with the frame held constant.
LawColumns lawByEdges(LawColumns ps, LawColumns g) {
  return lawColumns(ps.a + g.a.x * ps.a + g.b.x * ps.b + g.c.x * ps.c, ps.b + g.a.y * ps.a + g.b.y * ps.b + g.c.y * ps.c,
                    ps.c + g.a.z * ps.a + g.b.z * ps.b + g.c.z * ps.c);
}

/// Writes the derivatives by the modes [J]. @param c, e  cofactors and dilation of d   @param s  row by row
/// @param p  by the mean edges, with the frame held constant   @param r  by s, row by row; both over mu
void lawLeave(CellModes q, LawColumns d, LawColumns c, float e, LawColumns s, LawColumns p, LawColumns r, float rigidity, INOUT(CellForce) pull) {
  float inverse = 1.0f / max(1.0f + e, kLeastVolume);
  pull.hx = inverse * lawTimes(c, vec3(r.a.x, r.b.x, r.c.x));
  pull.hy = inverse * lawTimes(c, vec3(r.a.y, r.b.y, r.c.y));
  pull.hz = inverse * lawTimes(c, vec3(r.a.z, r.b.z, r.c.z));
  if (1.0f + e >= kLeastVolume) {
    pull.a = p.a - s.a.x * pull.hx - s.a.y * pull.hy - s.a.z * pull.hz;
    pull.b = p.b - s.b.x * pull.hx - s.b.y * pull.hy - s.b.z * pull.hz;
    pull.c = p.c - s.c.x * pull.hx - s.c.y * pull.hy - s.c.z * pull.hz;
  } else {  // 1/J is constant there: s = C^T H over kLeastVolume
    vec3 fa = vec3(1.0f, 0.0f, 0.0f) + d.a, fb = vec3(0.0f, 1.0f, 0.0f) + d.b, fc = vec3(0.0f, 0.0f, 1.0f) + d.c;
    vec3 wa = inverse * (r.a.x * q.hx + r.a.y * q.hy + r.a.z * q.hz), wb = inverse * (r.b.x * q.hx + r.b.y * q.hy + r.b.z * q.hz);
    vec3 wc = inverse * (r.c.x * q.hx + r.c.y * q.hy + r.c.z * q.hz);
    pull.a = p.a + cross(wb, fc) + cross(fb, wc);
    pull.b = p.b + cross(wc, fa) + cross(fc, wa);
    pull.c = p.c + cross(wa, fb) + cross(fa, wb);
  }
  pull.energy *= rigidity;
  pull.a *= rigidity;
  pull.b *= rigidity;
  pull.c *= rigidity;
  pull.hx *= rigidity;
  pull.hy *= rigidity;
  pull.hz *= rigidity;
  pull.hxyz = (rigidity * kLawAlternating) * q.hxyz;
}

#ifdef WALLS
#include "solver/tissue/law_walls.glsl"
#endif

/// Returns the law's energy and its derivatives. @param rigidity  mu h^3 times the cell's share [J]   @param bulk_j  (lambda -
/// mu) h^3 times the same [J]
CellForce lawPull(CellModes q, CellMoments moments, float rigidity, float bulk_j, float stiffening) {
#ifdef WALLS
  if (moments.wall.w > 0.0f) return lawWallPull(q, moments, rigidity, bulk_j, stiffening);
#endif
  float ratio = bulk_j / rigidity, bulk = ratio + 5.0f / 3.0f;  // K/mu = lambda/mu + 2/3
  LawCell t = lawCell(moments, ratio);
  LawColumns d = lawColumns(q.da, q.db, q.dc), c = lawCofactors(d);
  float e = lawDilation(d, c);
  LawColumns s = lawFrame(q, c, e), r = lawBends(t, s);
  CellForce pull;
  pull.energy = 0.5f * (dot(r.a, s.a) + dot(r.b, s.b) + dot(r.c, s.c)) + 0.5f * kLawAlternating * dot(q.hxyz, q.hxyz);
  LawColumns p;
  if (dot(t.center, t.center) == 0.0f) {
    float density;
    p = lawPoint(d, c, e, bulk, stiffening, moments, density);
    pull.energy += density;
#ifdef PRESTRESS
    lawAddPrestress(moments, d, p, pull.energy);
#endif
  } else {
    LawColumns g = lawAtCentroid(t, s);
    LawColumns star = lawColumns(d.a + lawTimes(d, g.a), d.b + lawTimes(d, g.b), d.c + lawTimes(d, g.c));
    LawColumns of_star = lawCofactors(star);
    float e_star = lawDilation(star, of_star);
    float density;
    LawColumns ps = lawPoint(star, of_star, e_star, bulk, stiffening, moments, density);
    pull.energy += density;
#ifdef PRESTRESS
    lawAddPrestress(moments, star, ps, pull.energy);
#endif
    lawAddCentroid(t, lawColumns(lawTransposed(d, ps.a), lawTransposed(d, ps.b), lawTransposed(d, ps.c)), r);
    p = lawByEdges(ps, g);
  }
  lawLeave(q, d, c, e, s, p, r, rigidity, pull);
  return pull;
}

/// Returns the largest row sum of |M|^T |M| for M = 1 + m: at least the square of its largest stretch.
float lawLargest(LawColumns m) {
  vec3 a = vec3(1.0f, 0.0f, 0.0f) + m.a, b = vec3(0.0f, 1.0f, 0.0f) + m.b, c = vec3(0.0f, 0.0f, 1.0f) + m.c;
  float ab = abs(dot(a, b)), bc = abs(dot(b, c)), ca = abs(dot(c, a));
  return max(dot(a, a) + ab + ca, max(dot(b, b) + ab + bc, dot(c, c) + bc + ca));
}

/// Returns the square of the fastest wave in a lattice of cells with a gradient 1 + D over that at rest, at least 1 (physics.md
/// 2). It is exact for waves along principal stretches. @param c  lawCofactors(d)   @param ratio  lambda/mu - 1
/// @param tension  lawTension(), or 0
float lawStiffeningAt(LawColumns d, LawColumns c, float ratio, float stiffening, float tension) {
  float e = lawDilation(d, c), bulk = ratio + 5.0f / 3.0f;
  LawVolume v = lawVolume(e);
  float size = 3.0f + lawSize(d), r = v.inverse;
  float x = v.phi * size - 3.0f, shear = v.phi * lawStiffer(x, stiffening), across = lawLargest(c);
  float pressing = (5.0f / 9.0f) * shear * v.slope * v.slope * size + 0.5f * bulk * (1.0f + r * r);
  float waves = tension + shear + pressing * across - (4.0f / 3.0f) * shear * v.slope * max(1.0f + e, 0.0f);
  if (1.0f + e < kLeastVolume) waves += (2.0f / 3.0f * shear * v.slope + 0.5f * bulk * r) * sqrt(size);
  if (stiffening * x > 0.0f && stiffening * x < kMostExponent) {  // along d x / d F = 2 phi (F - size/(3 J) C)
    float longest = max(lawLargest(d), size * size / 9.0f * across * r * r);
    waves += 2.0f * stiffening * v.phi * shear * longest;
  }
  return min(max(1.0f, waves / (ratio + 3.0f)), kMostStiffening);
}

#ifdef LAMINATES
LawColumns lawSum(LawColumns a, float s, LawColumns b) { return lawColumns(a.a + s * b.a, a.b + s * b.b, a.c + s * b.c); }

/// Returns the same for a cell of two materials: the mean over its layers, weighted by their contributions to the fastest wave at
/// rest.
float lawLaminateStiffening(CellMoments t, LawColumns d, LawColumns c, float ratio, float stiffening, float tension) {
  LawLaminate y = lawLaminate(t, d, c, lawDilation(d, c), stiffening);
  LawColumns by = lawJumpColumns(y.jump, t.plane.xyz), turn = lawJumpCofactors(d, y.jump, t.plane.xyz);
  float sa = 1.0f - t.plane.w, sb = -t.plane.w, ratio_a = t.layers.z - 5.0f / 3.0f, ratio_b = t.layers.w - 5.0f / 3.0f;
  float of_a = lawStiffeningAt(lawSum(d, sa, by), lawSum(c, sa, turn), ratio_a, stiffening, tension);
  float of_b = lawStiffeningAt(lawSum(d, sb, by), lawSum(c, sb, turn), ratio_b, stiffening, tension);
  return (t.plane.w * t.layers.x * (ratio_a + 3.0f) * of_a + sa * t.layers.y * (ratio_b + 3.0f) * of_b) / (ratio + 3.0f);
}
#endif

/// Returns the larger of those at the cell's mean gradient and at its tissue's centroid.
float lawStiffening(CellModes q, CellMoments moments, float ratio, float stiffening) {
  LawColumns d = lawColumns(q.da, q.db, q.dc), c = lawCofactors(d);
  LawCell t = lawCell(moments, ratio);
#ifdef PRESTRESS
  float tension = lawTension(moments);
#else
  const float tension = 0.0f;
#endif
  float found = lawStiffeningAt(d, c, ratio, stiffening, tension);
  LawColumns star = d, of_star = c;
#ifdef WALLS
  if (moments.wall.w > 0.0f) {
    float e = lawDilation(d, c);
    LawColumns s = lawFrame(q, c, e);
    LawWall w = lawWall(q, moments, t, c, e, s);
    star = lawWallStar(d, lawWallCentroid(t, s, w), w);
    of_star = lawCofactors(star);
    found = max(found, lawStiffeningAt(star, of_star, ratio, stiffening, tension));
  } else
#endif
  if (dot(t.center, t.center) != 0.0f) {
    LawColumns g = lawAtCentroid(t, lawFrame(q, c, lawDilation(d, c)));
    star = lawColumns(d.a + lawTimes(d, g.a), d.b + lawTimes(d, g.b), d.c + lawTimes(d, g.c));
    of_star = lawCofactors(star);
    found = max(found, lawStiffeningAt(star, of_star, ratio, stiffening, tension));
  }
#ifdef LAMINATES
  if (moments.plane.w < 1.0f) found = max(found, lawLaminateStiffening(moments, star, of_star, ratio, stiffening, tension));
#endif
  return found;
}
