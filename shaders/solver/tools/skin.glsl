// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Nodes with springs that a probe may touch between their ends (physics.md 5). After contact.glsl.
#ifndef __cplusplus
uniform float edge_reach;  // [m] distance from a probe at which nodes of springs that it touches may be, see edgeReach()
#endif

/// Returns whether a node is on the surface. A node of a lattice with all its springs, and no surface near it, is inside. In
/// networks all are on it.
bool onSkin(uint slot, NodeBits bits) {
  const uint axial_units = 0x9249u, diagonal_units = 0x555555u;
  uint axial = (bits.lo | bits.lo >> 1 | bits.lo >> 2) & axial_units, diagonal = (bits.hi | bits.hi >> 1) & diagonal_units;
  return axial != axial_units || diagonal != diagonal_units || surfaceDepth(slot) != 0.0f;
}

bool isNearEdges(ToolMotion m, vec3 x) {
  float reach = m.from.w + edge_reach + distance(xyz(m.from), xyz(m.to));
  vec3 off = x - xyz(m.to);
  return dot(off, off) < reach * reach;
}

/// Returns whether a probe may touch springs of a node that ends the substep at x, and move it through them.
bool mayFeelEdges(uint slot, NodeBits bits, vec3 x) {
  if ((bits.lo & (kGrabMask | kFixedBit)) != 0u || !onSkin(slot, bits)) return false;
  bool near = false;
  for (uint s = 0u; s < kMaxStyluses; ++s) {
    near = near || (pushesByTip(tool_motions[s]) && isNearEdges(tool_motions[s], x));
#ifdef SHAFTS
    near = near || (pushesByShaft(tool_motions[s]) && isNearEdges(shaftNear(tool_motions[s], x), x));
#endif
  }
  return near;
}
