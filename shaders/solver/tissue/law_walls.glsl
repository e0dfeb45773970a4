// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The law of cells in thin walls, with second derivatives along their own axes from rows of nodes (physics.md 1, Thin walls).
// Let e_k be those along axis k in the frame, and a_k those of the law without rows. G and the gradients of strain then get the
// additional terms v_k = share (e_k - a_k). F* = F (1 + G) + tau, where tau is due to the variation of second derivatives within
// the cell. Included within law.glsl, before lawPull(). Feature: WALLS

/// Contributions of rows.
struct LawWall {
  vec3 share;     // share of the second derivatives along each axis that comes from rows
  mat3 by_rows;   // columns e_k
  mat3 more;      // columns v_k
  mat3 varies;    // tau
  vec3 ends;      // factors of the variation along l of second derivatives along k, in the motion of the faces across l
  vec3 mixed;     // moments of yz, zx, xy about the cell's middle, times the share of the variation
};

/// Returns the second derivatives along each axis of the law without rows, in the frame: columns a_k.   @param s  s_al, row by row
mat3 lawOwn(LawCell t, LawColumns s) {
  float p = t.poisson;
  return mat3(vec3(-p * (s.b.z + s.c.y), -s.a.z, -s.a.y), vec3(-s.b.z, -p * (s.c.x + s.a.z), -s.b.x),
              vec3(-s.c.y, -s.c.x, -p * (s.a.y + s.b.x)));
}

/// Returns the contributions of rows.   @param c, e  cofactors and dilation of the mean edges
LawWall lawWall(CellModes q, CellMoments moments, LawCell t, LawColumns c, float e, LawColumns s) {
  float inverse = 1.0f / max(1.0f + e, kLeastVolume);
  LawWall w;
  w.share = moments.wall.w * q.rows.there;
  w.by_rows = inverse * mat3(lawTransposed(c, q.rows.second[0]), lawTransposed(c, q.rows.second[1]), lawTransposed(c, q.rows.second[2]));
  mat3 own = lawOwn(t, s);
  w.more = mat3(w.share.x * (w.by_rows[0] - own[0]), w.share.y * (w.by_rows[1] - own[1]), w.share.z * (w.by_rows[2] - own[2]));
  w.ends = (0.5f * moments.variation) * (moments.square - 0.25f);
  w.mixed = moments.variation * moments.mixed;
  vec3 xy = q.rows.varied[0], xz = q.rows.varied[1], yz = q.rows.varied[2], yx = q.rows.varied[3], zx = q.rows.varied[4], zy = q.rows.varied[5];
  w.varies = mat3(w.ends.y * yx + w.ends.z * zx + w.mixed.z * xy + w.mixed.y * xz,
                  w.ends.x * xy + w.ends.z * zy + w.mixed.z * yx + w.mixed.x * yz,
                  w.ends.x * xz + w.ends.y * yz + w.mixed.y * zx + w.mixed.x * zy);
  return w;
}

/// Returns G of F* = F (1 + G) + tau.
LawColumns lawWallCentroid(LawCell t, LawColumns s, LawWall w) {
  LawColumns g = lawAtCentroid(t, s);
  return lawColumns(g.a + t.center.x * w.more[0], g.b + t.center.y * w.more[1], g.c + t.center.z * w.more[2]);
}

/// Returns F* - 1.   @param g  lawWallCentroid()
LawColumns lawWallStar(LawColumns d, LawColumns g, LawWall w) {
  return lawColumns(d.a + (lawTimes(d, g.a) + w.varies[0]), d.b + (lawTimes(d, g.b) + w.varies[1]), d.c + (lawTimes(d, g.c) + w.varies[2]));
}

/// Gradients of strain along the three axes.
struct LawGradients {
  mat3 x, y, z;
};
/// Returns a symmetric tensor.   @param on  xx, yy, zz   @param off  yz, zx, xy
mat3 lawSymmetric(vec3 on, vec3 off) { return mat3(on.x, off.z, off.y, off.z, on.y, off.x, off.y, off.x, on.z); }
/// Returns the gradients of strain.   @param more  columns v_k
LawGradients lawGradients(LawCell t, LawColumns s, mat3 more) {
  float p = t.poisson;
  vec3 x = more[0], y = more[1], z = more[2];
  LawGradients g;
  g.x = lawSymmetric(vec3(x.x - p * (s.b.z + s.c.y), s.b.z, s.c.y), 0.5f * vec3(s.b.y + s.c.z, x.z, x.y));
  g.y = lawSymmetric(vec3(s.a.z, y.y - p * (s.c.x + s.a.z), s.c.x), 0.5f * vec3(y.z, s.c.z + s.a.x, y.x));
  g.z = lawSymmetric(vec3(s.a.y, s.b.x, z.z - p * (s.a.y + s.b.x)), 0.5f * vec3(z.y, z.x, s.a.x + s.b.y));
  return g;
}

/// Returns the stress of a strain over mu, without the share `relieved` (lambda + 2) of its component across the wall.
/// @param lambda  over mu
mat3 lawRelieved(mat3 strain, float lambda, vec3 normal, float relieved) {
  float trace = strain[0].x + strain[1].y + strain[2].z;
  float across = relieved * (lambda * trace + 2.0f * dot(normal, strain * normal)), pressure = lambda * (trace - across);
  mat3 stress = 2.0f * strain - (2.0f * across) * outerProduct(normal, normal);
  stress[0].x += pressure;
  stress[1].y += pressure;
  stress[2].z += pressure;
  return stress;
}

float lawProduct(mat3 a, mat3 b) { return dot(a[0], b[0]) + dot(a[1], b[1]) + dot(a[2], b[2]); }

/// Returns the energy of the gradients of strain within the cell, over mu.
/// @param lambda  over mu   @param r  derivatives by s, row by row   @param by_more  derivatives by v_k, columns
float lawWallBends(LawCell t, LawColumns s, vec4 wall, float lambda, mat3 more, OUT(LawColumns) r, OUT(mat3) by_more) {
  float relieved = wall.w * (1.0f - kRowStressAcross) / (lambda + 2.0f), p = t.poisson;
  LawGradients g = lawGradients(t, s, more);
  mat3 x = lawRelieved(t.square.x * g.x + t.mixed.z * g.y + t.mixed.y * g.z, lambda, wall.xyz, relieved);
  mat3 y = lawRelieved(t.mixed.z * g.x + t.square.y * g.y + t.mixed.x * g.z, lambda, wall.xyz, relieved);
  mat3 z = lawRelieved(t.mixed.y * g.x + t.mixed.x * g.y + t.square.z * g.z, lambda, wall.xyz, relieved);
  by_more = mat3(x[0], y[1], z[2]);
  vec3 bx = vec3(x[1].y - p * x[0].x, x[2].z - p * x[0].x, x[1].z), by = vec3(y[2].z - p * y[1].y, y[0].x - p * y[1].y, y[2].x);
  vec3 bz = vec3(z[0].x - p * z[2].z, z[1].y - p * z[2].z, z[0].y);
  r = lawColumns(vec3(by.z + bz.z, bz.x, by.y), vec3(bz.y, bz.z + bx.z, bx.x), vec3(by.x, bx.y, bx.z + by.z));
  return 0.5f * (lawProduct(g.x, x) + lawProduct(g.y, y) + lawProduct(g.z, z));
}

/// Adds to r the derivatives by s through a_k, which v_k subtracts.   @param by_rows  derivatives by e_k, columns
void lawAddOwn(LawCell t, mat3 by_rows, INOUT(LawColumns) r) {
  vec3 x = by_rows[0], y = by_rows[1], z = by_rows[2], p = t.poisson * vec3(x.x, y.y, z.z);
  r.a += vec3(0.0f, x.z + p.z, x.y + p.y);
  r.b += vec3(y.z + p.z, 0.0f, y.x + p.x);
  r.c += vec3(z.y + p.y, z.x + p.x, 0.0f);
}

/// Writes the derivatives by rows, and adds to the derivatives by mean edges those through the frame.   @param p  dW/dF* over mu
void lawLeaveRows(CellModes q, LawColumns d, LawColumns c, float e, LawWall w, LawColumns p, mat3 by_rows, float rigidity, INOUT(CellForce) pull) {
  float inverse = 1.0f / max(1.0f + e, kLeastVolume);
  mat3 by_second = (rigidity * inverse) * mat3(lawTimes(c, by_rows[0]), lawTimes(c, by_rows[1]), lawTimes(c, by_rows[2]));
  for (int k = 0; k < 3; ++k) pull.rows.second[k] = by_second[k];
  p = lawColumns(rigidity * p.a, rigidity * p.b, rigidity * p.c);
  pull.rows.varied[0] = w.ends.x * p.b + w.mixed.z * p.a;
  pull.rows.varied[1] = w.ends.x * p.c + w.mixed.y * p.a;
  pull.rows.varied[2] = w.ends.y * p.c + w.mixed.x * p.b;
  pull.rows.varied[3] = w.ends.y * p.a + w.mixed.z * p.b;
  pull.rows.varied[4] = w.ends.z * p.a + w.mixed.y * p.c;
  pull.rows.varied[5] = w.ends.z * p.b + w.mixed.x * p.c;
  if (1.0f + e >= kLeastVolume) {
    mat3 turned = by_second * transpose(w.by_rows);
    pull.a -= turned[0];
    pull.b -= turned[1];
    pull.c -= turned[2];
  } else {  // as in lawLeave()
    vec3 fa = vec3(1.0f, 0.0f, 0.0f) + d.a, fb = vec3(0.0f, 1.0f, 0.0f) + d.b, fc = vec3(0.0f, 0.0f, 1.0f) + d.c;
    mat3 of = (rigidity * inverse) * (mat3(q.rows.second[0], q.rows.second[1], q.rows.second[2]) * transpose(by_rows));
    pull.a += cross(of[1], fc) + cross(fb, of[2]);
    pull.b += cross(of[2], fa) + cross(fc, of[0]);
    pull.c += cross(of[0], fb) + cross(fa, of[1]);
  }
}

/// Returns lawPull() for a cell in a thin wall.
CellForce lawWallPull(CellModes q, CellMoments moments, float rigidity, float bulk_j, float stiffening) {
  float ratio = bulk_j / rigidity;
  LawCell t = lawCell(moments, ratio);
  LawColumns d = lawColumns(q.da, q.db, q.dc), c = lawCofactors(d);
  float e = lawDilation(d, c);
  LawColumns s = lawFrame(q, c, e), r;
  LawWall w = lawWall(q, moments, t, c, e, s);
  mat3 by_more;
  CellForce pull;
  pull.energy = lawWallBends(t, s, moments.wall, ratio + 1.0f, w.more, r, by_more) + 0.5f * kLawAlternating * dot(q.hxyz, q.hxyz);
  LawColumns g = lawWallCentroid(t, s, w), star = lawWallStar(d, g, w), of_star = lawCofactors(star);
  float density;
  LawColumns ps = lawPoint(star, of_star, lawDilation(star, of_star), ratio + 5.0f / 3.0f, stiffening, moments, density);
  pull.energy += density;
  LawColumns by_g = lawColumns(lawTransposed(d, ps.a), lawTransposed(d, ps.b), lawTransposed(d, ps.c));
  lawAddCentroid(t, by_g, r);
  by_more = mat3(w.share.x * (by_more[0] + t.center.x * by_g.a), w.share.y * (by_more[1] + t.center.y * by_g.b),
                 w.share.z * (by_more[2] + t.center.z * by_g.c));  // from here on by e_k
  lawAddOwn(t, by_more, r);
  lawLeave(q, d, c, e, s, lawByEdges(ps, g), r, rigidity, pull);
  lawLeaveRows(q, d, c, e, w, ps, by_more, rigidity, pull);
  return pull;
}
