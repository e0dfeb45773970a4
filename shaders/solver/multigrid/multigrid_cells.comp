// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// multigrid_cells.comp - what cells do to their corners where an increment leads, and the tangents of that; with PRODUCT what a
// change of displacement makes of it, moments at constant directions of the cell's edges.
// Owner: solver/gpu/steps/multigrid_stages.h   physics.md 2 (src/solver/multigrid/levels/fine_cells-inl.h is its twin)
// in  places of the step, or a vector of the system     out  cell forces; tangents, partial sums of energy
#ifndef __cplusplus
#define MAKES_CELL_FORCES
#endif
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"
#include "solver/tissue/step.glsl"
#include "solver/multigrid/multigrid.glsl"
#include "solver/multigrid/multigrid_cell_tangents.glsl"
#include "solver/tissue/corners.glsl"
#ifndef PRODUCT
#include "solver/multigrid/multigrid_sums.glsl"
#endif

layout(std430, binding = kBindCells) readonly buffer CellsBuffer { uint cells[]; };
layout(std430, binding = kBindCellForces) writeonly buffer CellForcesBuffer { vec4 cell_forces_out[]; };
uniform uint x_vector;

void store(uint slot, CellForces f) { LEAVE_CELL_FORCES(slot, f, 0.0f) }

#ifdef PRODUCT
/// s_mn = direction of edge m . H_n, by m.
vec3 alongEdge(CellEdge e, CellMotion q) { return vec3(dot(e.direction, q.hx), dot(e.direction, q.hy), dot(e.direction, q.hz)); }

/// A cell's share of moments in the change of its forces. @param at  its edges   @param x  a change of its motion
/// @param scale  rigidity with all that fades it [J]   @param sure  how much what moments take off the springs' stiffness counts
void addMoments(CellMotion at, CellMotion x, CellMoments t, float ratio, float scale, float sure, float h, inout CellForces f) {
  CellEdge ea = cellEdge(vec3(1.0f, 0.0f, 0.0f), at.da), eb = cellEdge(vec3(0.0f, 1.0f, 0.0f), at.db);
  CellEdge ec = cellEdge(vec3(0.0f, 0.0f, 1.0f), at.dc);
  vec3 a = ea.direction, b = eb.direction, c = ec.direction, first = sure * t.first;
  vec3 sa = alongEdge(ea, x), sb = alongEdge(eb, x), sc = alongEdge(ec, x);
  vec3 gx = vec3(sb.z, sc.y, sb.y + sc.z), gy = vec3(sc.x, sa.z, sc.z + sa.x), gz = vec3(sa.y, sb.x, sa.x + sb.y);
  vec3 strain = vec3(ea.strain_slope * dot(a, x.da), eb.strain_slope * dot(b, x.db), ec.strain_slope * dot(c, x.dc));
  vec3 ta = edgePull(ea, x.da, 0.0f, 0.0f), tb = edgePull(eb, x.db, 0.0f, 0.0f), tc = edgePull(ec, x.dc, 0.0f, 0.0f);
  vec3 shear = vec3(dot(b, tc) + dot(c, tb), dot(c, ta) + dot(a, tc), dot(a, tb) + dot(b, ta));
  float poisson = (ratio + 1.0f) / (ratio + 3.0f), along = 4.0f * (ratio + 2.0f) / (ratio + 3.0f), aside = 2.0f * poisson;
#define PLANE_STRESS(v) vec3(along * (v).x + aside * (v).y, along * (v).y + aside * (v).x, (v).z)
  vec3 dx = vec3(-poisson * (gx.x + gx.y), gx.x, gx.y), dy = vec3(gy.y, -poisson * (gy.x + gy.y), gy.x);
  vec3 dz = vec3(gz.x, gz.y, -poisson * (gz.x + gz.y));
  vec3 mx = t.square.x * dx + t.mixed.z * dy + t.mixed.y * dz;
  vec3 my = t.mixed.z * dx + t.square.y * dy + t.mixed.x * dz;
  vec3 mz = t.mixed.y * dx + t.mixed.x * dy + t.square.z * dz;
  vec3 ix = vec3(mx.y, mx.z, t.square.x * gx.z), iy = vec3(my.z, my.x, t.square.y * gy.z), iz = vec3(mz.x, mz.y, t.square.z * gz.z);
  vec3 bx = PLANE_STRESS(first.x * vec3(strain.y, strain.z, shear.x) + ix);
  vec3 by = PLANE_STRESS(first.y * vec3(strain.z, strain.x, shear.y) + iy);
  vec3 bz = PLANE_STRESS(first.z * vec3(strain.x, strain.y, shear.z) + iz);
  vec3 tx = PLANE_STRESS(gx), ty = PLANE_STRESS(gy), tz = PLANE_STRESS(gz);
#undef PLANE_STRESS
  vec3 strains = scale * vec3(first.y * ty.y + first.z * tz.x, first.z * tz.y + first.x * tx.x, first.x * tx.y + first.y * ty.x);
  vec3 shears = scale * vec3(first.x * tx.z, first.y * ty.z, first.z * tz.z);
  float trace = sa.x + sb.y + sc.z, less = 0.25f * sure;
  vec3 pair = vec3(sb.z + sc.y, sc.x + sa.z, sa.y + sb.x);
  vec3 ra = scale * (vec3(by.z + bz.z, bz.x, by.y) - less * (sa + vec3(trace, pair.z, pair.y)));
  vec3 rb = scale * (vec3(bz.y, bz.z + bx.z, bx.x) - less * (sb + vec3(pair.z, trace, pair.x)));
  vec3 rc = scale * (vec3(by.x, bx.y, bx.z + by.z) - less * (sc + vec3(pair.y, pair.x, trace)));
#ifdef HAS_THIN_WALLS
  if (t.bend != 0u) {
    CellBendPull bend = bendPull(t.bend, sa, sb, sc, sure * strain, sure * shear);
    ra += scale * bend.a;
    rb += scale * bend.b;
    rc += scale * bend.c;
    strains += (scale * sure) * bend.strains;
    shears += (scale * sure) * bend.shears;
  }
#endif
  float quarter = 0.25f / h;
  f.a += quarter * edgePull(ea, shears.y * c + shears.z * b, strains.x, 0.0f);
  f.b += quarter * edgePull(eb, shears.z * a + shears.x * c, strains.y, 0.0f);
  f.c += quarter * edgePull(ec, shears.x * b + shears.y * a, strains.z, 0.0f);
  f.hx = (2.0f * quarter) * (ra.x * a + rb.x * b + rc.x * c);
  f.hy = (2.0f * quarter) * (ra.y * a + rb.y * b + rc.y * c);
  f.hz = (2.0f * quarter) * (ra.z * a + rb.z * b + rc.z * c);
  f.hxyz = (0.70710678f / h * scale * (0.5f * kAlternating + 0.25f - less)) * x.hxyz;
}

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;  // of cells
  uint slot = cells[i];
  vec4 tangent[3];
  for (uint n = 0u; n < 3u; ++n) tangent[n] = cellTangent(n, slot);
  if (tangent[0].w == 0.0f && tangent[1].w == 0.0f) return;  // its forces are 0
  BodyParams body = bodies[bodyOf(nodes[slot])];
  float h = body.origin_spacing.w, bulk = cellBulk(slot, body);
  vec3 corners[8];
  for (uint c = 0u; c < 8u; ++c) corners[c] = ofSystem(x_vector, cornerSlot(slot, c));
  CellMotion x = cellMotion(corners, h);
  CellMotion at = {tangent[0].xyz, tangent[1].xyz, tangent[2].xyz, vec3(0.0f), vec3(0.0f), vec3(0.0f), vec3(0.0f)};
  CellShape shape = cellShape(at.da, at.db, at.dc);
  float p = 0.25f / h * tangent[0].w * (dot(shape.bc, x.da) + dot(shape.ca, x.db) + dot(shape.ab, x.dc));
  CellForces f = {p * shape.bc, p * shape.ca, p * shape.ab, vec3(0.0f), vec3(0.0f), vec3(0.0f), vec3(0.0f)};
  float rigidity = cellRigidity(slot, body);
  if (rigidity > 0.0f) addMoments(at, x, cellMoments(slot), bulk / rigidity, tangent[1].w, tangent[2].w, h, f);
  // The change of a force that pulls back: signs as of the forces themselves.
  store(slot, f);
}
#else
/// W''(e) of volumeEnergy(); of negative bulk what is left without the curvature of g, which is the same at rest.
float volumeCurvature(float bulk, float e) {
  if (bulk > 0.0f) return abs(e) < 1.0f ? bulk : 0.0f;
  float q = 1.0f + e * e, slope = (1.0f + 2.0f * e - e * e) / (q * q);
  return e > -1.0f ? bulk * slope * slope : 0.0f;
}

/// Of a crushed cell, as if all its corners had the mean volume.
float crushedCurvature(float rigidity, float e) {
  float lacks = kCrushed - 1.0f - e;
  return lacks > 0.0f && lacks < kMostCrushed ? kCrushing * rigidity : 0.0f;
}

/// What moments are times, with all that fades it, at constant directions [J]; and how much of what they take off the stiffness of
/// springs counts. At rest the two fit, and all of it does. In a strained cell springs point elsewhere than its mean edges; where
/// little tissue fills the cell, the difference of the two, which is all that there is, would be negative.
vec2 momentTangent(CellMotion q, float rigidity) {
  const float unsure = 0.5f;  // per strain, shear or bend
  CellEdge ea = cellEdge(vec3(1.0f, 0.0f, 0.0f), q.da), eb = cellEdge(vec3(0.0f, 1.0f, 0.0f), q.db);
  CellEdge ec = cellEdge(vec3(0.0f, 0.0f, 1.0f), q.dc);
  vec3 a = ea.direction, b = eb.direction, c = ec.direction;
  float size = 0.0f;
#define BENDS(e) dot(vec3(dot(e, q.hx), dot(e, q.hy), dot(e, q.hz)), vec3(dot(e, q.hx), dot(e, q.hy), dot(e, q.hz)))
  size = BENDS(a) + BENDS(b) + BENDS(c);
#undef BENDS
  vec3 longer = vec3(ea.shrink, eb.shrink, ec.shrink) - 1.0f, shear = vec3(dot(a, b), dot(b, c), dot(c, a));
  float bent = size / kFadeBend, sum = dot(longer, longer) + dot(shear, shear) + size;
  return vec2(rigidity / (1.0f + bent * bent) * ea.fade * eb.fade * ec.fade, max(0.0f, 1.0f - unsure * sqrt(sum)));
}

/// @return energy [J]
double linearise(uint slot) {
  NodeBits bits = nodes[slot];
  CellForces f = {vec3(0.0f), vec3(0.0f), vec3(0.0f), vec3(0.0f), vec3(0.0f), vec3(0.0f), vec3(0.0f)};
  vec4 tangent[3];
  for (uint n = 0u; n < 3u; ++n) tangent[n] = vec4(0.0f);
  float energy = 0.0f;
  if ((bits.lo & kCellBit) != 0u) {
    BodyParams body = bodies[bodyOf(bits)];
    float h = body.origin_spacing.w, bulk = cellBulk(slot, body), rigidity = cellRigidity(slot, body);
    vec3 at[8];
    for (uint c = 0u; c < 8u; ++c) at[c] = ofStep(kStepPlace, cornerSlot(slot, c));
    CellMotion q = cellMotion(at, h);
    CellShape shape = cellShape(q.da, q.db, q.dc);
    vec2 moments = rigidity > 0.0f ? momentTangent(q, rigidity) : vec2(0.0f);
    tangent[0] = vec4(q.da, volumeCurvature(bulk, shape.e) + crushedCurvature(rigidity, shape.e));
    tangent[1] = vec4(q.db, moments.x);
    tangent[2] = vec4(q.dc, moments.y);
    f = cellForces(at, shape, 0.25f / h * volumePressure(bulk, shape.e), h, bulk, rigidity, cellMoments(slot));
    energy = cellEnergy(at, shape.e, h, bulk, rigidity, cellMoments(slot));
  }
  for (uint n = 0u; n < 3u; ++n) cell_tangents[n * slot_count + slot] = tangent[n];
  store(slot, f);
  return double(energy);
}

void main() {
  uint i = globalIndex();
  double energy = i < active_count ? linearise(cells[i]) : 0.0LF;  // of cells
  sumUp(0u, dvec4(energy, 0.0LF, 0.0LF, 0.0LF));
}
#endif
