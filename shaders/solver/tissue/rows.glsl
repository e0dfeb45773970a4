// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Input of cells in thin walls from rows of nodes (physics.md 1, Thin walls). After elastic.glsl and corners.glsl. Feature: WALLS
#ifdef LOADS
layout(std430, binding = kBindRows) restrict readonly buffer RowsIn { vec4 rows[]; };  // [kRowVectors * slots], of rows.comp
#else
layout(binding = kUnitRows) uniform samplerBuffer rows;  // the same
#endif

/// Returns the second derivatives of a cell and their variation.   @param slot  lowest corner of the cell
CellRows cellRows(uint slot) {
  CellRows q;
  for (int i = 0; i < 3; ++i) q.second[i] = vec3(0.0f);
  for (int i = 0; i < 6; ++i) q.varied[i] = vec3(0.0f);
  q.there = vec3(0.0f);
  for (uint c = 0u; c < 8u; ++c) {
    uint corner = cornerSlot(slot, c);
    vec3 side = 0.25f * cornerSide(c);
    vec4 x = stateAt(rows, int(inPlanes(corner, 0u, kRowVectors)));
    vec4 y = stateAt(rows, int(inPlanes(corner, 1u, kRowVectors)));
    vec4 z = stateAt(rows, int(inPlanes(corner, 2u, kRowVectors)));
    q.second[0] += 0.125f * x.xyz;
    q.second[1] += 0.125f * y.xyz;
    q.second[2] += 0.125f * z.xyz;
    q.varied[0] += side.y * x.xyz;
    q.varied[1] += side.z * x.xyz;
    q.varied[2] += side.z * y.xyz;
    q.varied[3] += side.x * y.xyz;
    q.varied[4] += side.x * z.xyz;
    q.varied[5] += side.y * z.xyz;
    q.there = max(q.there, vec3(x.w, y.w, z.w));
  }
  return q;
}
