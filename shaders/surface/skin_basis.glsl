// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Orthonormal bases that carry vertices of surface meshes (EGVE eqs 6 and 8, corrected as in physics.md 4). Every
// function returns finite unit vectors for any finite input: nodes may be on one line or in one point. Must agree with
// model/body/skin_basis.h.
const float kShortest = 1e-30f;  // shorter vectors have no direction; far below any length that occurs
const float kLongest = 1e30f;    // longer ones would overflow when squared
const float kLeastSine = 1e-4f;  // edges closer to parallel give no normal: rounding would be 1e-3 of it

struct Basis {
  vec3 t, n, b;
};

/// Returns v scaled to length 1; `otherwise` where v has no direction.
vec3 direction(vec3 v, vec3 otherwise) {
  float size = max(abs(v.x), max(abs(v.y), abs(v.z)));
  if (!(size > kShortest && size < kLongest)) return otherwise;
  vec3 scaled = v / size;  // neither underflows nor overflows when squared
  return scaled * inversesqrt(dot(scaled, scaled));
}

/// Returns the unit vector at right angles to the unit vector `axis` that is nearest to `wanted`, or else to `second`;
/// wanted and second are unit vectors at right angles to each other.
vec3 rightAngleTo(vec3 axis, vec3 wanted, vec3 second) {
  vec3 first_try = wanted - dot(wanted, axis) * axis;
  if (dot(first_try, first_try) > 0.25f) return direction(first_try, wanted);
  return direction(second - dot(second, axis) * axis, second);
}

/// Returns the basis of a lattice triangle from its edges 0-1 and 0-2; rest1 and rest2 are their unit directions at
/// rest, at right angles. Where the nodes are collinear the normal is the nearest one to the rest normal.
Basis triangleBasis(vec3 edge1, vec3 edge2, vec3 rest1, vec3 rest2) {
  Basis basis;
  basis.t = direction(edge1, rest1);
  vec3 normal = cross(basis.t, direction(edge2, vec3(0.0f)));
  basis.n = dot(normal, normal) > kLeastSine * kLeastSine ? direction(normal, basis.t)
                                                          : rightAngleTo(basis.t, cross(rest1, rest2), rest2);
  basis.b = cross(basis.n, basis.t);
  return basis;
}

/// Returns the basis around an averaged approximate normal, of any length, with the tangent of its triangle.
Basis interpolatedBasis(vec3 average_normal, Basis triangle) {
  Basis basis;
  basis.n = direction(average_normal, triangle.n);
  vec3 bitangent = cross(basis.n, triangle.t);
  basis.b = dot(bitangent, bitangent) > kLeastSine * kLeastSine ? direction(bitangent, triangle.b) : triangle.b;
  basis.t = cross(basis.b, basis.n);
  return basis;
}

/// Returns the vector with the given coordinates in a basis: the sum of EGVE eq 9.
vec3 inSpace(Basis basis, vec3 coordinates) {
  return coordinates.x * basis.t + coordinates.y * basis.n + coordinates.z * basis.b;
}
