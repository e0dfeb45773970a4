// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Position of a node's tissue, for blades and grips. After lattice.glsl; reads displacement[].
#include "solver/tissue/surface_offset.glsl"

/// Returns the displacement from a node to its tissue in the current state [m].
vec3 toTissue(uint slot, float h) {
  uint offset = surfaceOffset(slot);
  if (offset == 0u) return vec3(0.0f);
  return toTissueIn(offset, h, xyz(displacement[slot]), xyz(displacement[pathEnd(slot, offset, 0u)]),
                    xyz(displacement[pathEnd(slot, offset, 1u)]), xyz(displacement[pathEnd(slot, offset, 2u)]));
}

/// Returns the position of a node relative to the blade's first tip [m].
vec3 nodeFromBlade(uint slot, ToolMotion m) {
  precise vec3 x = (restPosition(slot) - xyz(m.from)) + xyz(displacement[slot]);
  return x;
}

/// Returns the position of a node's tissue relative to the blade's first tip [m]: a blade in the air cuts nothing, and one that
/// ends in the air spares no tissue.
vec3 seenFromBlade(uint slot, ToolMotion m, float h) {
  precise vec3 tissue = nodeFromBlade(slot, m) + toTissue(slot, h);
  return tissue;
}
