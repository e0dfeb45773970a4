// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// main() of the kernels that visit each node's contacts. After collision_search.glsl and
//   `bool isAlone(uint slot)`  no search needed
//   `void begin()`   `void visit(Entry me, Entry other, float wanted)`  for every contact   `void end(uint slot)`
void consider(Entry me, Entry other) {
  float wanted = touchDistance(me, other);
  if (wanted > 0.0f) visit(me, other, wanted);
}

/// Different cells may share a bucket: the position of an entry gives its cell.
void visitCell(Entry me, ivec3 cell) {
  uint b = hashOf(cell) & (bucket_count - 1u);
  uint first = buckets[3u * b + 1u], end = first + buckets[3u * b];
  for (uint e = first; e < end; ++e) {
    uvec4 at = entries[e];
    vec3 x = uintBitsToFloat(uvec3(at.x, at.y, at.z)), apart = me.x - x;
    if (at.w == me.slot || dot(apart, apart) >= cell_m * cell_m) continue;  // true for most of them
    if (cellOf(x) == cell) consider(me, entryAt(e));
  }
}

void visitCells(Entry me) {
  ivec3 cell = cellOf(me.x);
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) visitCell(me, cell + ivec3(x, y, z));
    }
  }
}

void main() {
  uint e = globalIndex();
  if (e >= buckets[3u * bucket_count]) return;
  Entry me = entryAt(e);
  begin();
  if (!isAlone(me.slot)) visitCells(me);
  end(me.slot);
}
