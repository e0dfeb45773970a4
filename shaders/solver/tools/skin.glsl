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

bool pushesEdges(ToolMotion motion) { return (motion.info.y & (kToolPushes | kToolFeels)) == kToolPushes; }

/// Returns whether a probe may touch springs of a node that ends the substep at x, and move it through them.
bool mayFeelEdges(uint slot, NodeBits bits, vec3 x) {
  if ((bits.lo & (kGrabMask | kFixedBit)) != 0u || !onSkin(slot, bits)) return false;
  bool near = false;
  for (uint s = 0u; s < kMaxStyluses; ++s) {
    if (!pushesEdges(tool_motions[s])) continue;
    float reach = tool_motions[s].from.w + edge_reach + distance(xyz(tool_motions[s].from), xyz(tool_motions[s].to));
    vec3 off = x - xyz(tool_motions[s].to);
    near = near || dot(off, off) < reach * reach;
  }
  return near;
}
