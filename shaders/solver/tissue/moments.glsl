// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Cells by moments (physics.md 1): what the springs of a cell lack to bend and twist as the part of it does that is tissue.
// A cell moves as x = middle + sum of F_n p_n + H_x p_y p_z + H_y p_z p_x + H_z p_x p_y + ..., p the place in it, -1/2 to 1/2:
// F are its mean edges, H its hourglass motions, all over h. No affine motion has any H.

/// Of the part of a cell that is tissue, over its share: integrals of p and of p p^T.
struct CellMoments {
  vec3 first;
  vec3 square;  // of p_x p_x, p_y p_y, p_z p_z
  vec3 mixed;   // of p_y p_z, p_z p_x, p_x p_y
  uint bend;    // where its bend in a thin wall is (bends.glsl), 0: it has none
};

/// Mean edges less their rest value, and hourglass motions, over h.
struct CellMotion {
  vec3 da, db, dc;
  vec3 hx, hy, hz, hxyz;  // hxyz: sum of s_x s_y s_z u over the corners, over sqrt(8)
};

/// Energy [J], and its derivatives by the motion [J].
struct CellPull {
  float energy;
  vec3 a, b, c, hx, hy, hz, hxyz;
};

#include "solver/tissue/crushed.glsl"

/// One mean edge: what strains are made of.
struct CellEdge {
  vec3 direction;
  float shrink;    // 1 / length
  float strain, strain_slope;  // of its length, saturated; by the length
  float fade, fade_slope;
};

CellEdge cellEdge(vec3 unit, vec3 change) {
  vec3 edge = unit + change;
  float growth = 2.0f * dot(unit, change) + dot(change, change);  // length^2 - 1, without cancellation
  float size = sqrt(max(1.0f + growth, 1e-12f));
  CellEdge e;
  e.direction = edge / size;
  e.shrink = 1.0f / size;
  float stretch = growth / (size + 1.0f), q = 1.0f + stretch * stretch / kFadeStrain2;
  e.strain = stretch / q;
  e.strain_slope = (2.0f - q) / (q * q);
  float t = clamp((size - kFadeNone) / (kFadeFull - kFadeNone), 0.0f, 1.0f);
  e.fade = t * t * (3.0f - 2.0f * t);
  e.fade_slope = 6.0f * t * (1.0f - t) / (kFadeFull - kFadeNone);
  return e;
}

/// dV/dF of an edge from dV/d(direction), dV/d(strain) and dV/d(fade).
vec3 edgePull(CellEdge e, vec3 by_direction, float by_strain, float by_fade) {
  vec3 across = by_direction - dot(e.direction, by_direction) * e.direction;
  return e.shrink * across + (by_strain * e.strain_slope + by_fade * e.fade_slope) * e.direction;
}

/// @param rigidity  mu h^3 times the cell's share [J]   @param bulk  (lambda - mu) h^3 times the same [J]
CellPull cellPull(CellMotion q, CellMoments t, float rigidity, float bulk) {
  CellEdge ea = cellEdge(vec3(1.0f, 0.0f, 0.0f), q.da), eb = cellEdge(vec3(0.0f, 1.0f, 0.0f), q.db);
  CellEdge ec = cellEdge(vec3(0.0f, 0.0f, 1.0f), q.dc);
  // s_mn = direction of edge m . H_n
  vec3 sa = vec3(dot(ea.direction, q.hx), dot(ea.direction, q.hy), dot(ea.direction, q.hz));
  vec3 sb = vec3(dot(eb.direction, q.hx), dot(eb.direction, q.hy), dot(eb.direction, q.hz));
  vec3 sc = vec3(dot(ec.direction, q.hx), dot(ec.direction, q.hy), dot(ec.direction, q.hz));
  // Gradient of strain along n in the plane across it: two strains that bend and one shear that twists.
  vec3 gx = vec3(sb.z, sc.y, sb.y + sc.z);  // yy, zz, 2 yz
  vec3 gy = vec3(sc.x, sa.z, sc.z + sa.x);  // zz, xx, 2 zx
  vec3 gz = vec3(sa.y, sb.x, sa.x + sb.y);  // xx, yy, 2 xy
  // lambda/mu = 1 + ratio. A plate that bends is free to thin: plane stress, strain across -nu/(1 - nu) of the sum.
  float ratio = bulk / rigidity, poisson = (ratio + 1.0f) / (ratio + 3.0f);
  float along = 4.0f * (ratio + 2.0f) / (ratio + 3.0f), aside = 2.0f * poisson;
  vec3 dx = vec3(-poisson * (gx.x + gx.y), gx.x, gx.y);
  vec3 dy = vec3(gy.y, -poisson * (gy.x + gy.y), gy.x);
  vec3 dz = vec3(gz.x, gz.y, -poisson * (gz.x + gz.y));
  // Integrals of the strain times p_n: from its mean, and from its gradient.
  vec3 shear = vec3((q.dc.y + q.db.z + dot(q.db, q.dc)) * eb.shrink * ec.shrink,
                    (q.da.z + q.dc.x + dot(q.dc, q.da)) * ec.shrink * ea.shrink,
                    (q.db.x + q.da.y + dot(q.da, q.db)) * ea.shrink * eb.shrink);
  vec3 mx = t.square.x * dx + t.mixed.z * dy + t.mixed.y * dz;
  vec3 my = t.mixed.z * dx + t.square.y * dy + t.mixed.x * dz;
  vec3 mz = t.mixed.y * dx + t.mixed.x * dy + t.square.z * dz;
  vec3 ix = vec3(mx.y, mx.z, t.square.x * gx.z), iy = vec3(my.z, my.x, t.square.y * gy.z);
  vec3 iz = vec3(mz.x, mz.y, t.square.z * gz.z);
  vec3 wx = t.first.x * vec3(eb.strain, ec.strain, shear.x), wy = t.first.y * vec3(ec.strain, ea.strain, shear.y);
  vec3 wz = t.first.z * vec3(ea.strain, eb.strain, shear.z);
#define PLANE_STRESS(v) vec3(along * (v).x + aside * (v).y, along * (v).y + aside * (v).x, (v).z)
  vec3 tx = PLANE_STRESS(gx), ty = PLANE_STRESS(gy), tz = PLANE_STRESS(gz);
  float solid = dot(tx, wx + 0.5f * ix) + dot(ty, wy + 0.5f * iy) + dot(tz, wz + 0.5f * iz);
  // What the springs put into the same motions: (all s^2 + (s_xx + s_yy + s_zz)^2 + sum of (s_mn + s_nm)^2) / 8.
  float size = dot(sa, sa) + dot(sb, sb) + dot(sc, sc), trace = sa.x + sb.y + sc.z;
  vec3 pair = vec3(sb.z + sc.y, sc.x + sa.z, sa.y + sb.x);
  float energy = solid - 0.125f * (size + trace * trace + dot(pair, pair)) + 0.5f * kAlternating * dot(q.hxyz, q.hxyz);
  // Derivatives before any fading: by s, by strains and shears.
  vec3 bx = PLANE_STRESS(wx + ix), by = PLANE_STRESS(wy + iy), bz = PLANE_STRESS(wz + iz);
#undef PLANE_STRESS
  vec3 ra = vec3(by.z + bz.z, bz.x, by.y) - 0.25f * (sa + vec3(trace, pair.z, pair.y));
  vec3 rb = vec3(bz.y, bz.z + bx.z, bx.x) - 0.25f * (sb + vec3(pair.z, trace, pair.x));
  vec3 rc = vec3(by.x, bx.y, bx.z + by.z) - 0.25f * (sc + vec3(pair.y, pair.x, trace));
  vec3 strains = vec3(t.first.y * ty.y + t.first.z * tz.x, t.first.z * tz.y + t.first.x * tx.x, t.first.x * tx.y + t.first.y * ty.x);
  vec3 shears = vec3(t.first.x * tx.z, t.first.y * ty.z, t.first.z * tz.z);
#ifdef HAS_THIN_WALLS
  if (t.bend != 0u) {
    CellBendPull bend = bendPull(t.bend, sa, sb, sc, vec3(ea.strain, eb.strain, ec.strain), shear);
    energy += bend.energy;
    ra += bend.a;
    rb += bend.b;
    rc += bend.c;
    strains += bend.strains;
    shears += bend.shears;
  }
#endif
  float bent = size / kFadeBend, less = 1.0f / (1.0f + bent * bent);
  float fade = less * ea.fade * eb.fade * ec.fade;
  float turn = -4.0f * bent * less * energy / kFadeBend;  // 2 d(1/(1 + bent^2))/d(size) energy / less
  ra += turn * sa;
  rb += turn * sb;
  rc += turn * sc;
  float scale = rigidity * fade;
  vec3 ca = ra.x * q.hx + ra.y * q.hy + ra.z * q.hz + shears.y * ec.direction + shears.z * eb.direction;
  vec3 cb = rb.x * q.hx + rb.y * q.hy + rb.z * q.hz + shears.z * ea.direction + shears.x * ec.direction;
  vec3 cc = rc.x * q.hx + rc.y * q.hy + rc.z * q.hz + shears.x * eb.direction + shears.y * ea.direction;
  float faded = rigidity * less * energy;
  CellPull pull;
  pull.energy = scale * energy;
  pull.a = edgePull(ea, scale * ca, scale * strains.x, faded * eb.fade * ec.fade);
  pull.b = edgePull(eb, scale * cb, scale * strains.y, faded * ec.fade * ea.fade);
  pull.c = edgePull(ec, scale * cc, scale * strains.z, faded * ea.fade * eb.fade);
  pull.hx = scale * (ra.x * ea.direction + rb.x * eb.direction + rc.x * ec.direction);
  pull.hy = scale * (ra.y * ea.direction + rb.y * eb.direction + rc.y * ec.direction);
  pull.hz = scale * (ra.z * ea.direction + rb.z * eb.direction + rc.z * ec.direction);
  pull.hxyz = (scale * kAlternating) * q.hxyz;
  if (mayBeCrushed(q)) addCrushed(q, rigidity, pull);
  return pull;
}

/// @param n  displacements of the corners: bit 0 of the index x, bit 1 y, bit 2 z [m]
CellMotion cellMotion(vec3 n[8], float h) {
  // Sums and differences along x, then y, then z.
  vec3 s0 = n[0] + n[1], s1 = n[2] + n[3], s2 = n[4] + n[5], s3 = n[6] + n[7];
  vec3 d0 = n[1] - n[0], d1 = n[3] - n[2], d2 = n[5] - n[4], d3 = n[7] - n[6];
  vec3 ss0 = s0 + s1, ss1 = s2 + s3, sd0 = s1 - s0, sd1 = s3 - s2;
  vec3 ds0 = d0 + d1, ds1 = d2 + d3, dd0 = d1 - d0, dd1 = d3 - d2;
  float quarter = 0.25f / h, half_ = 0.5f / h;
  CellMotion q;
  q.da = quarter * (ds0 + ds1);
  q.db = quarter * (sd0 + sd1);
  q.dc = quarter * (ss1 - ss0);
  q.hx = half_ * (sd1 - sd0);
  q.hy = half_ * (ds1 - ds0);
  q.hz = half_ * (dd0 + dd1);
  q.hxyz = (0.35355339f / h) * (dd1 - dd0);
  return q;
}

/// The moments of a cell that is filled all through.
CellMoments fullMoments() {
  CellMoments t = {vec3(0.0f), vec3(1.0f / 12.0f), vec3(0.0f), 0u};
  return t;
}
