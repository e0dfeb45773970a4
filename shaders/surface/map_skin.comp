// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// map_skin.comp - vertices and normals of surface meshes from the nodes (EGVE 3.2 to 3.6; in partly filled cells from
// the cell's corners).
// Owner: surface/surface.h   physics.md 4, surface.md
// in  skin[count], nodes[slots], displacement[slots] m, node_normals[slots], stale_bricks[bricks]
// out  positions[3 * count] m, normals[count] packed
// Features: MIXED (some vertices belong to networks: network_skin.comp places them), and which bindings there are in
// addition to those with the constant basis: CURVED (kInterpolatedBit), IN_CELL, ONE_NODE, ALONG_NORMAL; NORMALS with
// any that needs approximate normals.
// BRANCHES: where a branch that is not taken costs nothing (compiled as C++; software rasterisers run both sides).
#include "layout.h"
#ifndef __cplusplus
layout(local_size_x = GROUP_SIZE) in;  // globalIndex() needs it
#endif
#include "solver/tissue/lattice.glsl"
#include "pack.glsl"
#include "skin_basis.glsl"

#ifndef __cplusplus
uniform uint first_item, count;  // of vertices
uniform uint followed_revision;  // vertices that have not moved after it are up to date; 0: none are
layout(std430, binding = kBindStaleBricks) readonly buffer StaleBricksBuffer { uint stale_bricks[]; };
layout(std430, binding = kBindDisplacementIn) readonly buffer DisplacementBuffer { vec4 displacement[]; };
#ifdef IN_CELL
layout(std430, binding = kBindNodes) readonly buffer NodesBuffer { NodeBits nodes[]; };
#endif
#ifdef NORMALS
layout(std430, binding = kBindNodeNormals) readonly buffer NodeNormalsBuffer { vec4 node_normals[]; };
#endif
layout(std430, binding = kBindSkinBindings) readonly buffer SkinBuffer { SkinBinding skin[]; };
layout(std430, binding = kBindSkinPositions) writeonly buffer PositionsBuffer { float positions[]; };
layout(std430, binding = kBindSkinNormals) writeonly buffer NormalsBuffer { uint normals[]; };
#endif

/// Returns the direction of an axial spring at rest. Edges 0-1 and 2-0 of every binding are axial
/// (model/body/skin_anchor.h).
vec3 axialDirection(uint spring) {
  vec3 axis = vec3(0.0f);
  axis[spring >> 1] = (spring & 1u) == 0u ? 1.0f : -1.0f;
  return axis;
}

/// Returns whether a node has moved, or one that its approximate normal depends on.
bool isStale(uint slot) { return stale_bricks[slot >> 6] > followed_revision; }

void put(uint vertex, vec3 position, vec3 normal) {
  positions[3u * vertex] = position.x;
  positions[3u * vertex + 1u] = position.y;
  positions[3u * vertex + 2u] = position.z;
  normals[vertex] = packNormal(normal);
}

#if defined(CURVED) && defined(BRANCHES)
/// Maps a vertex where normals are trusted, without the constant basis; the result is that of main() to the bit.
/// @return false: normals are not trusted, or edges collapsed
bool mapCurved(uint vertex, SkinBinding s, vec3 u0, vec3 edge1, vec3 edge2) {
  vec4 n0 = node_normals[s.slot0], n1 = node_normals[s.slot1], n2 = node_normals[s.slot2];
  Basis curved;
  curved.n = direction(s.weights.x * xyz(n0) + s.weights.y * xyz(n1) + s.weights.z * xyz(n2), vec3(0.0f));
  vec3 bitangent = cross(curved.n, direction(edge1, vec3(0.0f)));
  if (!(min(n0.w, min(n1.w, n2.w)) >= 1.0f && dot(bitangent, bitangent) > kLeastSine * kLeastSine)) return false;
  curved.b = direction(bitangent, bitangent);
  curved.t = cross(curved.b, curved.n);
  vec3 offset = inSpace(curved, xyz(s.offset_interpolated));
  vec3 position = restPosition(s.slot0) + (u0 + (s.weights.y * edge1 + s.weights.z * edge2 + offset));
  put(vertex, position, direction(inSpace(curved, xyz(s.normal_interpolated)), curved.n));
  return true;
}
#endif

#ifdef ALONG_NORMAL
/// Maps a vertex along the approximate normal (EGVE 3.5); where that is unclear, its offset turns with the triangle.
void mapAlongNormal(uint vertex, SkinBinding s, vec3 reference, vec3 edge1, vec3 edge2, vec3 rest1, vec3 rest2) {
  vec4 n0 = node_normals[s.slot0], n1 = node_normals[s.slot1], n2 = node_normals[s.slot2];
  float trust = min(n0.w, min(n1.w, n2.w));
  vec3 normal = direction(s.weights.x * xyz(n0) + s.weights.y * xyz(n1) + s.weights.z * xyz(n2), vec3(0.0f));
  vec3 offset = s.weights.w * normal;
  bool own = (s.springs & kOwnNormalBit) != 0u;
  if (own || !(trust >= 1.0f)) {
    Basis constant = triangleBasis(edge1, edge2, rest1, rest2);
    offset = mix(inSpace(constant, xyz(s.offset_constant)), offset, trust);
    normal = direction(mix(inSpace(constant, xyz(s.normal_constant)), normal, own ? 0.0f : trust), constant.n);
  }
  put(vertex, reference + offset, normal);
}
#endif

#ifdef IN_CELL
/// Returns corner c of a vertex's cell.
uint cellCorner(SkinBinding s, uint c) {
  uint own = (s.springs >> kCornerShift) & 7u;
  return neighborSlot(s.slot0, ivec3(c & 1u, (c >> 1) & 1u, (c >> 2) & 1u) - ivec3(own & 1u, (own >> 1) & 1u, (own >> 2) & 1u));
}

/// Returns whether a spring at one of its corners has been cut. Then the triangle carries the vertex, on its own side
/// of the cut.
bool isCellCut(SkinBinding s) {
  bool cut = false;
  for (uint c = 0u; c < 8u; ++c) cut = cut || (nodes[cellCorner(s, c)].lo & kSeveredBit) != 0u;
  return cut;
}

bool isCellStale(SkinBinding s) {
  bool stale = false;
  for (uint c = 0u; c < 8u; ++c) stale = stale || isStale(cellCorner(s, c));
  return stale;
}

/// Maps a vertex by the eight corners of its cell; its normal as that of a plane that deforms with them.
void mapInCell(uint vertex, SkinBinding s, float spacing, vec3 rest1, vec3 rest2) {
  Basis rest = triangleBasis(rest1, rest2, rest1, rest2);
  uint own = (s.springs >> kCornerShift) & 7u;
  vec3 from_own = s.weights.y * rest1 + s.weights.z * rest2 + inSpace(rest, xyz(s.offset_constant)) / spacing;
  vec3 position = vec3(float(own & 1u), float((own >> 1) & 1u), float((own >> 2) & 1u)) + from_own;
  vec3 moved = vec3(0.0f), along_x = vec3(0.0f), along_y = vec3(0.0f), along_z = vec3(0.0f);  // du/dp
  for (uint c = 0u; c < 8u; ++c) {
    vec3 u = xyz(displacement[cellCorner(s, c)]);
    float sx = (c & 1u) != 0u ? 1.0f : -1.0f, sy = (c & 2u) != 0u ? 1.0f : -1.0f, sz = (c & 4u) != 0u ? 1.0f : -1.0f;
    float wx = (c & 1u) != 0u ? position.x : 1.0f - position.x, wy = (c & 2u) != 0u ? position.y : 1.0f - position.y;
    float wz = (c & 4u) != 0u ? position.z : 1.0f - position.z;
    moved += wx * wy * wz * u;
    along_x += sx * wy * wz * u;
    along_y += wx * sy * wz * u;
    along_z += wx * wy * sz * u;
  }
  vec3 a = vec3(spacing, 0.0f, 0.0f) + along_x, b = vec3(0.0f, spacing, 0.0f) + along_y, c = vec3(0.0f, 0.0f, spacing) + along_z;
  vec3 normal = inSpace(rest, xyz(s.normal_constant)), carried = normal;
  vec3 sizes = abs(a) + abs(b) + abs(c);
  float size = (sizes.x + sizes.y) + sizes.z;
  if (size > kShortest && size < kLongest) {  // so that products neither underflow nor overflow
    a /= size;
    b /= size;
    c /= size;
    carried = direction(normal.x * cross(b, c) + normal.y * cross(c, a) + normal.z * cross(a, b), normal);
  }
  put(vertex, restPosition(s.slot0) + (spacing * from_own + moved), carried);
}

#endif

#ifdef ONE_NODE
/// Maps a vertex that moves with its node and keeps its offset (EGVE 3.2). Without a clear normal of the node the
/// vertex's normal turns with the triangle.
void mapByNode(uint vertex, SkinBinding s, float spacing, vec3 rest1, vec3 rest2) {
  vec3 u0 = xyz(displacement[s.slot0]);
  vec4 approximate = node_normals[s.slot0];
  vec3 normal = xyz(approximate);
  float trust = (s.springs & kOwnNormalBit) != 0u ? 0.0f : approximate.w;
  if (!(trust >= 1.0f)) {
    vec3 edge1 = spacing * rest1 + (xyz(displacement[s.slot1]) - u0), edge2 = spacing * rest2 + (xyz(displacement[s.slot2]) - u0);
    Basis constant = triangleBasis(edge1, edge2, rest1, rest2);
    normal = direction(mix(inSpace(constant, xyz(s.normal_constant)), normal, trust), constant.n);
  }
  Basis rest = triangleBasis(rest1, rest2, rest1, rest2);
  put(vertex, restPosition(s.slot0) + (u0 + inSpace(rest, xyz(s.offset_constant))), normal);
}
#endif

void main() {
  if (globalIndex() >= count) return;
  uint vertex = first_item + globalIndex();
  SkinBinding s = skin[vertex];
#ifdef MIXED
  if ((s.springs & kOneToOneBit) != 0u) return;
#endif
  bool stale = followed_revision == 0u || isStale(s.slot0) || isStale(s.slot1) || isStale(s.slot2);
#ifdef IN_CELL
  bool in_cell = (s.springs & kInCellBit) != 0u;
  stale = stale || (in_cell && isCellStale(s));
#endif
  if (!stale) return;
  float spacing = bodies[bricks[s.slot0 >> 6].body].origin_spacing.w;
  vec3 rest1 = axialDirection(s.springs & 31u);
  vec3 rest2 = -axialDirection((s.springs >> 10) & 31u);
#ifdef IN_CELL
  if (in_cell && !isCellCut(s)) {
    mapInCell(vertex, s, spacing, rest1, rest2);
    return;
  }
#endif
#ifdef ONE_NODE
  if ((s.springs & kOneNodeBit) != 0u) {
    mapByNode(vertex, s, spacing, rest1, rest2);
    return;
  }
#endif
  vec3 u0 = xyz(displacement[s.slot0]);
  // Edges as rest offset plus difference of displacements: exact at rest, wherever the body is.
  vec3 edge1 = spacing * rest1 + (xyz(displacement[s.slot1]) - u0);
  vec3 edge2 = spacing * rest2 + (xyz(displacement[s.slot2]) - u0);

#ifdef ALONG_NORMAL
  if ((s.springs & kAlongNormalBit) != 0u) {
    mapAlongNormal(vertex, s, restPosition(s.slot0) + (u0 + (s.weights.y * edge1 + s.weights.z * edge2)), edge1, edge2, rest1, rest2);
    return;
  }
#endif
#if defined(CURVED) && defined(BRANCHES)
  if ((s.springs & kInterpolatedBit) != 0u && mapCurved(vertex, s, u0, edge1, edge2)) return;
#endif
  Basis constant = triangleBasis(edge1, edge2, rest1, rest2);
  vec3 offset = inSpace(constant, xyz(s.offset_constant));
  vec3 normal = inSpace(constant, xyz(s.normal_constant));
#ifdef CURVED
  if ((s.springs & kInterpolatedBit) != 0u) {
    vec4 n0 = node_normals[s.slot0], n1 = node_normals[s.slot1], n2 = node_normals[s.slot2];
    float trust = min(n0.w, min(n1.w, n2.w));
    Basis curved = interpolatedBasis(s.weights.x * xyz(n0) + s.weights.y * xyz(n1) + s.weights.z * xyz(n2), constant);
    offset = mix(offset, inSpace(curved, xyz(s.offset_interpolated)), trust);
    normal = mix(normal, inSpace(curved, xyz(s.normal_interpolated)), trust);
  }
#endif
  vec3 position = restPosition(s.slot0) + (u0 + (s.weights.y * edge1 + s.weights.z * edge2 + offset));
  put(vertex, position, direction(normal, constant.n));
}
