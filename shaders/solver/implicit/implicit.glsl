// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Implicit Euler in increments du = u+ - u, what pd solves (physics.md 2). After elastic.glsl and step.glsl.
//   m (1 + gamma dt)/dt^2 (du - y) = F(u + du),   y = (dt v + dt^2 g)/(1 + gamma dt),   v+ = du/dt
// F has the springs, the volumes and the dashpots c/dt n n^T (du_far - du_near), n at the current iterate. A solution is a
// stationary point of the incremental potential
//   P(du) = sum of m (1 + gamma dt)/(2 dt^2) |du - y|^2 + E(u + du) + sum of c/(2 dt) (n . (du_far - du_near))^2
// increment.w is 1 where du is prescribed: fixed, sleeping and held nodes; -1 where the node has contacts (implicit_contact.glsl), -2
// where it may touch other nodes (implicit_pairs.glsl).
#ifndef __cplusplus
layout(std430, binding = kBindActive) readonly buffer ActiveBuffer { uint active_nodes[]; };
layout(std430, binding = kBindNodes) readonly buffer NodesBuffer { NodeBits nodes[]; };
// Word 0: float bits of the share of y that the iterations start from, in the end of the share of du that was taken. Then two
// words per iteration of pd: float bits of its largest change; 1 if acceleration was given up by then.
layout(std430, binding = kBindGuard) buffer GuardBuffer { uint guard[]; };
#endif

uint changeWord(uint iteration) { return 1u + 2u * iteration; }
uint plainWord(uint iteration) { return 2u + 2u * iteration; }

/// How far a node may go in a sweep of pd where there are volumes [m]: what their majoriser reckons with. Twice what the last
/// sweep did, so that it is no more than a formality near a solution.
float reach(float h, uint iteration) {
  const float longest = 0.1f, shortest = 1e-3f;
  return iteration == 0u ? longest * h : clamp(2.0f * uintBitsToFloat(guard[changeWord(iteration - 1u)]), shortest * h, longest * h);
}

bool isPrescribed(vec4 du) { return du.w > 0.0f; }
bool isInContact(vec4 du) { return du.w < 0.0f; }
bool isInPairs(vec4 du) { return du.w < -1.5f; }

/// m (1 + gamma dt)/dt^2 [N/m]
float inertia(float mass, BodyParams body) { return mass * (1.0f + body.drag_per_s * dt_s) / (dt_s * dt_s); }

/// y: the increment that no force would change.
vec3 freeIncrement(uint slot, BodyParams body) {
  vec3 v = xyz(stateAt(velocity, int(slot)));
  return (dt_s * v + (dt_s * dt_s) * gravity) / (1.0f + body.drag_per_s * dt_s);
}

/// c/dt of a spring's dashpot [N/m]
float damping(float k, BodyParams body) {
#ifdef DASHPOT
  return k * body.dashpot_s / dt_s;
#else
  return 0.0f;
#endif
}

/// What a node knows of a spring in the current iterate.
struct ImplicitSpring {
  Spring spring;
  float damping;  // c/dt [N/m]
  vec3 force;     // spring and dashpot [N]
};

/// @param u, du  of the near end   @param n, d, l0, prestrain, k  of FOR_EACH_LINK (elastic.glsl)
ImplicitSpring implicitSpring(uint n, vec3 u, vec3 du, vec3 d, float l0, float prestrain, float k, BodyParams body) {
  vec3 along = xyz(stateAt(increment, int(n))) - du;
  ImplicitSpring s;
  s.spring = springBetween(d, l0, prestrain, (xyz(stateAt(displacement, int(n))) - u) + along);
  s.damping = damping(k, body);
  s.force = (k * s.spring.extension + s.damping * dot(s.spring.direction, along)) * s.spring.direction;
  return s;
}

#ifdef VOLUME
/// @param at  displacements of the cell's corners, bit per axis, x lowest [m]
CellShape shapeOf(vec3 at[8], float h, OUT(vec3) edge_lengths) {
  float quarter = 0.25f / h;
  vec3 da = quarter * ((at[1] - at[0]) + (at[3] - at[2]) + (at[5] - at[4]) + (at[7] - at[6]));
  vec3 db = quarter * ((at[2] - at[0]) + (at[3] - at[1]) + (at[6] - at[4]) + (at[7] - at[5]));
  vec3 dc = quarter * ((at[4] - at[0]) + (at[5] - at[1]) + (at[6] - at[2]) + (at[7] - at[3]));
  edge_lengths = vec3(length(vec3(1.0f, 0.0f, 0.0f) + da), length(vec3(0.0f, 1.0f, 0.0f) + db), length(vec3(0.0f, 0.0f, 1.0f) + dc));
  return cellShape(da, db, dc);
}

/// Bounds on the curvature W'' and the slope |W'| of a cell's energy within `way` of e [J].
vec2 volumeBounds(float bulk, float e, float way) {
  if (bulk <= 0.0f) return vec2(-0.75f * bulk, -0.703f * bulk);  // the largest there are
  return vec2(abs(e) - way < 1.0f ? bulk : 0.0f, bulk * min(1.0f, abs(e) + way));
}

/// Added to the diagonal of a Jacobi iteration for each corner of a cell [N/m], this makes every step descend in which no
/// corner goes farther than reach: half of a bound on the curvature of W along such a motion. With mean edges a, b, c over h,
/// which move by up to 2 reach/h, and their rates a', b', c':  W = W'' e'^2 + W' e'',
///   e'^2 <= (|b x c|^2 + |c x a|^2 + |a x b|^2) sum |a'|^2,   e'' <= (|a| + |b| + |c|) sum |a'|^2,   sum |a'|^2 <= sum |du'|^2/(2 h^2)
float volumeMajoriser(float bulk, CellShape s, vec3 edge_lengths, float reach, float h) {
  float way = 2.0f * reach / h;
  vec3 a = edge_lengths + way;
  vec3 areas = vec3(length(s.bc), length(s.ca), length(s.ab)) + way * (vec3(edge_lengths.y + edge_lengths.z, edge_lengths.z + edge_lengths.x, edge_lengths.x + edge_lengths.y) + way);
  vec2 bounds = volumeBounds(bulk, s.e, way * (areas.x + areas.y + areas.z));
  return 0.25f * (bounds.x * dot(areas, areas) + bounds.y * (a.x + a.y + a.z)) / (h * h);
}

/// The same for what crushed corners pull with (crushed.glsl), of energies kCrushing/8 rigidity phi(J), |phi'| <= kMostCrushed, phi'' <= 1 (0 beyond); each
/// corner has edges that move by sum |a'|^2 <= 2 (3 |du'|^2 + sum of the other ends' |du'|^2)/h^2, a node is at four corners: 12 |du'|^2/h^2.
/// Corners that are far from it are left out: few sweeps go so far, and all would be slowed by the first.
float crushedMajoriser(CellMotion q, float rigidity, float reach, float h) {
  const float far = 0.75f;  // of the volume at rest
  float way = 2.0f * reach / h, most = 0.0f;
  for (uint corner = 0u; corner < 8u; ++corner) {
    CornerEdges e = cornerEdges(q, cornerSide(corner));
    vec3 lengths = vec3(length(e.a), length(e.b), length(e.c));
    vec3 areas = vec3(length(cross(e.b, e.c)), length(cross(e.c, e.a)), length(cross(e.a, e.b)));
    areas += way * (vec3(lengths.y + lengths.z, lengths.z + lengths.x, lengths.x + lengths.y) + way);
    float volume = dot(e.a, cross(e.b, e.c)), around = way * (areas.x + areas.y + areas.z), lacks = kCrushed - volume;
    if (lacks + around <= 0.0f || volume >= far) continue;
    float curved = lacks - around < kMostCrushed ? dot(areas, areas) : 0.0f;
    most = max(most, curved + min(lacks + around, kMostCrushed) * (lengths.x + lengths.y + lengths.z + 3.0f * way));
  }
  return 0.5f * 12.0f * 0.125f * kCrushing * rigidity * most / (h * h);
}
#endif
