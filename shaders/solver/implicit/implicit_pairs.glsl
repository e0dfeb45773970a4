// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Contacts between nodes in the solution of a substep of implicit Euler (physics.md 2). After lattice.glsl.
// The pairs that may touch are found once, at the first iterate (collision_record.comp). Two such nodes come no nearer than their
// contact distance along the normal at the start of the substep: n . (du_a - du_b) >= -gap. A sweep steps all nodes with such
// contacts together, each by the forces on it (implicit_pull.comp) and those of its contacts, which are equal and opposite and
// corrected in rounds (implicit_meet.comp, implicit_place.comp).
#ifndef __cplusplus
// Word 0: number of ends of pairs. Then two words per slot: its first end, their number. Then the other node of each end.
layout(std430, binding = kBindPairWords) buffer PairWordsBuffer { uint pair_words[]; };
// Two per end: xyz normal, from the node of the higher slot to the other, w gap [m]; xyz force on the one of the lower slot [N].
layout(std430, binding = kBindPairRows) buffer PairRowsBuffer { vec4 pair_rows[]; };
// Three per slot: xyz force without its contacts [N], w its majoriser, 0 where prescribed [N/m]; xyz increment to which it moves
// [m], w number of contacts active before; xyz force of its contacts [N], w number of active ones.
layout(std430, binding = kBindNodePairs) buffer NodePairsBuffer { vec4 node_pairs[]; };
uniform uint pair_slots;
uniform uint most_pairs;  // capacity in ends
uniform float pair_friction;
uniform float pair_restitution;
uniform float pair_bounces_from;  // m/s: slower impacts do not bounce
uint takeRoom(uint count) { return atomicAdd(pair_words[0], count); }
#endif

const float kInPairs = -2.0f;  // increment.w of a node with pairs that is not prescribed

struct PairRun {
  uint first, count;
};

/// The ends of a node's pairs. If the capacity is exceeded, no node has any: which ones fit would depend on the order of atomics.
PairRun pairsOf(uint slot) {
  PairRun run = {0u, 0u};
  if (most_pairs == 0u || pair_words[0] > most_pairs) return run;
  run.first = pair_words[1u + 2u * slot];
  run.count = pair_words[2u + 2u * slot];
  return run;
}

void reservePairs(uint slot, uint count) {
  pair_words[1u + 2u * slot] = count > 0u ? takeRoom(count) : 0u;
  pair_words[2u + 2u * slot] = count;
}

uint otherWord(uint end) { return 1u + 2u * pair_slots + end; }
