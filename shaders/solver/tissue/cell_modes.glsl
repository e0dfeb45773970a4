// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Deformation modes of a cell, and its tissue part (physics.md 1).
// A cell moves as x = middle + sum of F_n p_n + H_x p_y p_z + H_y p_z p_x + H_z p_x p_y + ..., with p the position in it, -1/2 to
// 1/2. F are its mean edges, H its hourglass modes, all over h. No affine motion has any H.

/// Moments of the tissue part of a cell, over its share: integrals of p and of p p^T.
struct CellMoments {
  vec3 first;
  vec3 square;  // of p_x p_x, p_y p_y, p_z p_z
  vec3 mixed;   // of p_y p_z, p_z p_x, p_x p_y
#ifdef PRESTRESS
  vec3 pulled, sheared;  // its stress at rest over mu: xx, yy, zz; yz, zx, xy
#endif
#ifdef LAMINATES
  vec4 plane;   // normal of the plane between its two materials, from a to b; share of a, 1 for a single material
  vec4 layers;  // shear moduli of a and b over their mean, K/mu of both
#endif
#ifdef WALLS
  vec4 wall;        // unit normal of its thin wall; share of its second derivatives that comes from rows, 0: it is in no wall
  float variation;  // share of their variation within the cell
#endif
};

#ifdef WALLS
/// Second derivatives of a cell in a thin wall along its axes, by rows of nodes (rows.comp), over h; or derivatives by these.
struct CellRows {
  vec3 second[3];  // mean over the corners, by axis of the row
  vec3 varied[6];  // mean over a face less that over the opposite one, by axis of the row and axis of the faces xy, xz, yz, yx, zx, zy
  vec3 there;      // 1 where a corner has a row along the axis
};
#endif

/// Mean edges less their rest value, and hourglass modes, over h.
struct CellModes {
  vec3 da, db, dc;
  vec3 hx, hy, hz, hxyz;  // hxyz: sum of s_x s_y s_z u over the corners, over sqrt(8)
#ifdef WALLS
  CellRows rows;  // only where CellMoments has a wall
#endif
};

/// Energy [J], and its derivatives by the modes [J].
struct CellForce {
  float energy;
  vec3 a, b, c, hx, hy, hz, hxyz;
#ifdef WALLS
  CellRows rows;  // only where CellMoments has a wall
#endif
};

/// Returns -1 or 1 per axis. @param corner  bit per axis, x lowest
vec3 cornerSide(uint corner) { return vec3(float(corner & 1u), float((corner >> 1) & 1u), float(corner >> 2)) * 2.0f - 1.0f; }

/// Returns the modes of a cell. @param n  displacements of the corners: bit 0 of the index x, bit 1 y, bit 2 z [m]
CellModes cellMotion(vec3 n[8], float h) {
  // Sums and differences along x, then y, then z.
  vec3 s0 = n[0] + n[1], s1 = n[2] + n[3], s2 = n[4] + n[5], s3 = n[6] + n[7];
  vec3 d0 = n[1] - n[0], d1 = n[3] - n[2], d2 = n[5] - n[4], d3 = n[7] - n[6];
  vec3 ss0 = s0 + s1, ss1 = s2 + s3, sd0 = s1 - s0, sd1 = s3 - s2;
  vec3 ds0 = d0 + d1, ds1 = d2 + d3, dd0 = d1 - d0, dd1 = d3 - d2;
  float quarter = 0.25f / h, half_ = 0.5f / h;
  CellModes q;
  q.da = quarter * (ds0 + ds1);
  q.db = quarter * (sd0 + sd1);
  q.dc = quarter * (ss1 - ss0);
  q.hx = half_ * (sd1 - sd0);
  q.hy = half_ * (ds1 - ds0);
  q.hz = half_ * (dd0 + dd1);
  q.hxyz = (0.35355339f / h) * (dd1 - dd0);
  return q;
}

/// Returns the moments of a completely filled cell.
CellMoments fullMoments() {
  CellMoments t;
  t.first = t.mixed = vec3(0.0f);
  t.square = vec3(1.0f / 12.0f);
#ifdef PRESTRESS
  t.pulled = t.sheared = vec3(0.0f);
#endif
#ifdef LAMINATES
  t.plane = vec4(0.0f, 0.0f, 0.0f, 1.0f);
#endif
#ifdef WALLS
  t.wall = vec4(0.0f);
  t.variation = 0.0f;
#endif
  return t;
}
