// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Contacts between nodes within the solution of a substep of implicit Euler (physics.md 2). After lattice.glsl.
// Who may touch whom is found once, where the first iterate leads (collision_note.comp). Two such nodes come no nearer along the
// normal that they have at the start of the substep than the distance that they keep: n . (du_a - du_b) >= -gap. A sweep steps all
// nodes with such contacts together, each by what pulls it (implicit_pull.comp) and by the forces of its contacts, which are equal
// and opposite and mended in rounds (implicit_meet.comp, implicit_place.comp).
#ifndef __cplusplus
// Word 0: how many ends of pairs there are. Then two words per slot: the first of its ends, their number. Then the other node of each.
layout(std430, binding = kBindPairWords) buffer PairWordsBuffer { uint pair_words[]; };
// Two per end: xyz normal, from the node of the higher slot to the other, w gap [m]; xyz force on the one of the lower slot [N].
layout(std430, binding = kBindPairRows) buffer PairRowsBuffer { vec4 pair_rows[]; };
// Three per slot: xyz what pulls it [N], w the majoriser of that, 0 where it is prescribed [N/m]; xyz the increment that it would
// go to [m], w how many of its contacts pressed before; xyz force of its contacts [N], w how many press.
layout(std430, binding = kBindNodePairs) buffer NodePairsBuffer { vec4 node_pairs[]; };
uniform uint pair_slots;
uniform uint most_pairs;  // ends for which there is room
uniform float pair_friction;
uniform float pair_restitution;
uniform float pair_bounces_from;  // m/s: what comes slower does not
uint takeRoom(uint count) { return atomicAdd(pair_words[0], count); }
#endif

const float kInPairs = -2.0f;  // increment.w of a node that has some and is not prescribed

struct PairRun {
  uint first, count;
};

/// The ends of a node's pairs. Where there are more than there is room for, no node has any: which would depend on the order of atomics.
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
