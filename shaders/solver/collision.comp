// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// collision.comp - contacts between nodes: search, then what they do.   Owner: solver/gpu/collision_pass.h   physics.md 8
// in  displacement, velocity [slots] after the integrator; displacement before it in the other buffer
// out corrections [2 * slots]
// Stages of the complete search, a hashed uniform grid by counting sort. Integer atomics only; where a bucket lies depends on
// their order, what is in it and in which order does not:
//   COUNT nodes per bucket   PLACE buckets   SCATTER nodes into them   ORDER each bucket by slot
// Stages of GW's search (STAGGERED): partitions of space, each shifted by a part of a cell, their nodes sorted by cell:
//   LIST keys of cells   EXCHANGE a step of a bitonic sort   RANK where each node ended up
// Then, of either: MEET sums each node's contacts, PUSH their effects; PAIRS lists them, for tests.
#include "layout.h"
#include "lattice.glsl"
#include "elastic.glsl"
#include "collision.glsl"

#ifndef STAGGERED
uint bucketOf(vec3 x) { return hashOf(cellOf(x, 0.0f)) & (bucket_count - 1u); }

Entry entryAt(uint e) {
  uvec4 at = entries[e];
  Entry entry = {at.w, uintBitsToFloat(uvec3(at.x, at.y, at.z)), xyz(entries_before[e])};
  return entry;
}
#else
/// Partitions are shifted along the diagonal, by equal parts of a cell.
ivec3 cellIn(uint part, vec3 x) { return cellOf(x, float(part) / float(partitions)); }

Entry entryOf(uint slot) {
  Entry entry = {slot, positionOf(slot), positionBefore(slot)};
  return entry;
}

bool near(uint part, uint slot_a, vec3 a, uint slot_b, vec3 b) {
  if (cellIn(part, a) != cellIn(part, b)) return false;
  int away = int(ranks[part * slot_count + slot_a]) - int(ranks[part * slot_count + slot_b]);
  return abs(away) <= int(window);
}

/// A pair that several partitions show counts in the first.
bool foundBefore(uint part, Entry a, Entry b) {
  for (uint p = 0u; p < part; ++p) {
    if (near(p, a.slot, a.x, b.slot, b.x)) return true;
  }
  return false;
}
#endif

#ifdef COUNT
void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  vec3 x = positionOf(slot);
  if (collides(slot, nodes[slot], x)) atomicAdd(buckets[3u * bucketOf(x)], 1u);
}
#endif

#ifdef PLACE
void main() {
  uint b = globalIndex();
  if (b >= bucket_count) return;
  uint count = buckets[3u * b];
  if (count != 0u) buckets[3u * b + 1u] = atomicAdd(buckets[3u * bucket_count], count);
}
#endif

#ifdef SCATTER
void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  vec3 x = positionOf(slot);
  if (!collides(slot, nodes[slot], x)) return;
  uint b = bucketOf(x);
  unsorted[buckets[3u * b + 1u] + atomicAdd(buckets[3u * b + 2u], 1u)] = slot;
}
#endif

#ifdef ORDER
void main() {
  uint e = globalIndex();
  if (e >= buckets[3u * bucket_count]) return;
  uint slot = unsorted[e];
  vec3 x = positionOf(slot);
  uint b = bucketOf(x), first = buckets[3u * b + 1u], place = first;
  for (uint k = first; k < first + buckets[3u * b]; ++k) place += unsorted[k] < slot ? 1u : 0u;
  uvec3 bits = floatBitsToUint(x);
  entries[place] = uvec4(bits, slot);
  entries_before[place] = vec4(positionBefore(slot), 0.0);
}
#endif

#ifdef LIST
void main() {
  uint i = globalIndex();
  if (i >= partitions * sorted_count) return;
  uint k = i % sorted_count;
  items[i] = uvec2(0xffffffffu);
  if (k >= active_count) return;
  uint slot = active_nodes[k];
  vec3 x = positionOf(slot);
  if (collides(slot, nodes[slot], x)) items[i] = uvec2(hashOf(cellIn(i / sorted_count, x)), slot);
}
#endif

#ifdef EXCHANGE
layout(location = 12) uniform uint run;   // length of runs that are sorted after this pass over the distances
layout(location = 13) uniform uint away;  // distance of the two that are compared

void main() {
  uint i = globalIndex();
  if (i >= partitions * sorted_count / 2u) return;
  uint low = 2u * i - (i & (away - 1u)), high = low + away;
  uvec2 a = items[low], b = items[high];
  bool greater = a.x > b.x || (a.x == b.x && a.y > b.y);
  bool rising = ((low & (sorted_count - 1u)) & run) == 0u;
  if (greater != rising) return;
  items[low] = b;
  items[high] = a;
}
#endif

#ifdef RANK
void main() {
  uint i = globalIndex();
  if (i >= partitions * sorted_count) return;
  uint slot = items[i].y;
  if (slot != 0xffffffffu) ranks[(i / sorted_count) * slot_count + slot] = i % sorted_count;
}
#endif

#if defined(MEET) || defined(PUSH) || defined(PAIRS)
#ifdef MEET
vec3 direction_sum = vec3(0.0f);
float contact_count = 0.0f;

void visit(Entry me, Entry other, float wanted) {
  bool first = me.slot < other.slot;
  vec3 direction = first ? directionBetween(me, other) : -directionBetween(other, me);
  direction_sum += (wanted - distance(me.x, other.x)) * direction;
  contact_count += 1.0f;
}
bool isAlone(uint slot) { return false; }
void begin() {
  direction_sum = vec3(0.0f);
  contact_count = 0.0f;
}
void end(uint slot) { contacts[slot] = vec4(direction_sum, contact_count); }
#endif

#ifdef PUSH
vec3 impulse_sum = vec3(0.0f), shift_sum = vec3(0.0f);

void visit(Entry me, Entry other, float wanted) {
  if (me.slot < other.slot) {
    Push push = pushBetween(me, other, wanted);
    impulse_sum += push.impulse;
    shift_sum += push.shift;
  } else {
    Push push = pushBetween(other, me, wanted);
    impulse_sum -= push.impulse;
    shift_sum -= push.shift;
  }
}
bool isAlone(uint slot) { return contacts[slot].w == 0.0f; }  // MEET has found nobody: no need to search again
void begin() { impulse_sum = shift_sum = vec3(0.0f); }
void end(uint slot) {
  float inverse = inverseMass(slot);
  corrections[2u * slot] = vec4(inverse * impulse_sum, 0.0f);
  corrections[2u * slot + 1u] = vec4(inverse * shift_sum, 0.0f);
}
#endif

#ifdef PAIRS
#ifndef __cplusplus
layout(location = 14) uniform uint most_pairs;
layout(std430, binding = kBindPairs) buffer PairsBuffer { uint pairs[]; };  // their number, then two slots each
void addPair(uint a, uint b) {
  uint place = atomicAdd(pairs[0], 1u);
  if (place >= most_pairs) return;
  pairs[1u + 2u * place] = a;
  pairs[2u + 2u * place] = b;
}
#endif
void visit(Entry me, Entry other, float wanted) {
  if (me.slot < other.slot) addPair(me.slot, other.slot);
}
bool isAlone(uint slot) { return false; }
void begin() {}
void end(uint slot) {}
#endif

void consider(Entry me, Entry other) {
  float wanted = touchDistance(me, other);
  if (wanted > 0.0f) visit(me, other, wanted);
}

#ifndef STAGGERED
/// Different cells may share a bucket: whoever is in one says which cell it is in.
void visitCell(Entry me, ivec3 cell) {
  uint b = hashOf(cell) & (bucket_count - 1u);
  uint first = buckets[3u * b + 1u], end = first + buckets[3u * b];
  for (uint e = first; e < end; ++e) {
    uvec4 at = entries[e];
    vec3 x = uintBitsToFloat(uvec3(at.x, at.y, at.z)), apart = me.x - x;
    if (at.w == me.slot || dot(apart, apart) >= cell_m * cell_m) continue;  // most of them
    if (cellOf(x, 0.0f) == cell) consider(me, entryAt(e));
  }
}

void visitCells(Entry me) {
  ivec3 cell = cellOf(me.x, 0.0f);
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
#else
void main() {
  uint e = globalIndex();
  if (e >= sorted_count) return;
  if (items[e].y == 0xffffffffu) return;
  Entry me = entryOf(items[e].y);
  begin();
  uint searched = isAlone(me.slot) ? 0u : partitions;
  for (uint p = 0u; p < searched; ++p) {
    int rank = int(ranks[p * slot_count + me.slot]), last = int(sorted_count) - 1;
    for (int r = max(rank - int(window), 0); r <= min(rank + int(window), last); ++r) {
      uint slot = items[p * sorted_count + uint(r)].y;
      if (slot == 0xffffffffu || slot == me.slot) continue;
      Entry other = entryOf(slot);
      if (near(p, me.slot, me.x, slot, other.x) && !foundBefore(p, me, other)) consider(me, other);
    }
  }
  end(me.slot);
}
#endif
#endif
