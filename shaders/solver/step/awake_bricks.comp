// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// awake_bricks.comp - selects the bricks that are stepped, and lists their nodes and cells.
// Owner: solver/gpu/buffers/awake_bricks.h
// in  state of the nodes; cuts; regions that tools may reach     in/out  sleeping bricks     out  lists
// LANES invocations per brick: 1, or 64 in a group of their own, which is faster on GPUs. Features, one each: WAKE_ALL, WAKE_NEAR
// (boxes), WAKE_HELD, WAKE_CUT (after a cut of springs), WAKE_MARKED (another kernel has woken bricks), CHECK (nodes that were
// fast in the last substep; with TOOLS also those that were touched), LIST. The rule is that of src/solver/cpu/state/sleep.h. A
// pass that invalidates a list empties it; LIST must follow before the next substep. A list is in the order in which bricks
// arrive: nodes gather forces, so no result depends on it.
#include "layout.h"
#include "solver/tissue/lattice.glsl"

layout(std430, binding = kBindSleepingBricks) buffer SleepingBuffer { SleepingBrick sleeping[]; };
layout(std430, binding = kBindAwakeNodes) buffer AwakeNodesBuffer {
  AwakeList nodes_list;
  uint awake_nodes[];
};
#ifdef LAW
layout(std430, binding = kBindAwakeCells) buffer AwakeCellsBuffer {
  AwakeList cells_list;
  uint awake_cells[];
};
#endif
uniform uint brick_count;

uint firstSlot(uint brick) { return brick * kBrickSlots; }

#if LANES > 1
shared uint of_group;
uint brickOfInvocation() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
uint lane() { return gl_LocalInvocationID.x; }
/// Returns the largest value of the brick's invocations. All of them must call it.
uint largestOf(uint own) {
  barrier();
  if (lane() == 0u) of_group = 0u;
  barrier();
  atomicMax(of_group, own);
  barrier();
  return of_group;
}
/// Returns the value of the brick's first invocation. All of them must call it.
uint ofFirst(uint own) {
  barrier();
  if (lane() == 0u) of_group = own;
  barrier();
  return of_group;
}
#else
uint brickOfInvocation() { return globalIndex(); }
uint lane() { return 0u; }
uint largestOf(uint own) { return own; }
uint ofFirst(uint own) { return own; }
#endif
bool isFirst() { return lane() == 0u; }
bool anyOf(bool own) { return largestOf(own ? 1u : 0u) != 0u; }

void startLists() {
  nodes_list.groups_x = nodes_list.groups_y = nodes_list.count = 0u;
  nodes_list.groups_z = 1u;
  nodes_list.bricks = nodes_list.farthest_bits = 0u;
#ifdef LAW
  cells_list.groups_x = cells_list.groups_y = cells_list.count = 0u;
  cells_list.groups_z = 1u;
#endif
}

/// Wakes a brick: it restarts its quiet time.
void wake(uint b) {
  if (!isFirst() || sleeping[b].kind != kMayMove) return;
  sleeping[b].quiet_s = 0.0;
  sleeping[b].awake = 1u;
}

#if defined(WAKE_ALL) || defined(WAKE_HELD)
layout(std430, binding = kBindActive) readonly buffer ActiveBuffer { uint active_nodes[]; };
layout(std430, binding = kBindNodes) readonly buffer NodesBuffer { NodeBits nodes[]; };
#endif
#if defined(WAKE_ALL) || defined(LIST)
layout(std430, binding = kBindDisplacementIn) readonly buffer DisplacementIn { vec4 displacement[]; };
layout(std430, binding = kBindDisplacementOut) writeonly buffer DisplacementOut { vec4 next_displacement[]; };
layout(std430, binding = kBindVelocityIn) writeonly buffer VelocityIn { vec4 velocity[]; };
layout(std430, binding = kBindVelocityOut) writeonly buffer VelocityOut { vec4 next_velocity[]; };

/// Sets both states to that before the substep, at rest.
/// @return the largest |u| [m]
float freeze(uint b) {
  float largest2 = 0.0;
  for (uint slot = firstSlot(b) + lane(); slot < firstSlot(b) + kBrickSlots; slot += LANES) {
    vec4 u = displacement[slot];
    next_displacement[slot] = u;
    velocity[slot] = vec4(0.0);
    next_velocity[slot] = vec4(0.0);
    largest2 = max(largest2, dot(xyz(u), xyz(u)));
  }
  return sqrt(uintBitsToFloat(largestOf(floatBitsToUint(largest2))));  // positive floats order like their bits
}
#endif

#ifdef WAKE_ALL
/// Fixed, or isolated and not held (step.glsl). Ghosts move.
bool staysAtRest(NodeBits bits) {
  if ((bits.lo & kGhostBit) != 0u) return false;
  return (bits.lo & kFixedBit) != 0u || (isIsolated(bits) && (bits.lo & kGrabMask) == 0u);
}

uint kindOf(uint b) {
#ifdef NETWORK
  if (bodies[bodyAt(firstSlot(b))].connections != kImplicit) return kNeverSleeps;
#endif
  uint first = sleeping[b].first_node;
  bool moves = false;
  for (uint i = first + lane(); i < first + sleeping[b].node_count; i += LANES) {
    moves = moves || !staysAtRest(nodes[active_nodes[i]]);
  }
  return anyOf(moves) ? kMayMove : kNeverMoves;
}

void ask(uint b) {
  uint kind = kindOf(b);
  if (kind == kNeverMoves) freeze(b);
  if (!isFirst()) return;
  sleeping[b].kind = kind;
  sleeping[b].quiet_s = 0.0;
  sleeping[b].wanted = 0u;
  sleeping[b].awake = kind == kMayMove ? 1u : 0u;
}
#endif

#ifdef WAKE_NEAR
layout(std430, binding = kBindDisplacementIn) readonly buffer DisplacementIn { vec4 displacement[]; };
uniform vec3 box_low[kMostToolBoxes];   // tissue frame [m]
uniform vec3 box_high[kMostToolBoxes];
uniform uint box_count;

float largestDisplacement(uint b) {
  float largest2 = 0.0;
  for (uint slot = firstSlot(b) + lane(); slot < firstSlot(b) + kBrickSlots; slot += LANES) {
    largest2 = max(largest2, dot(xyz(displacement[slot]), xyz(displacement[slot])));
  }
  return sqrt(uintBitsToFloat(largestOf(floatBitsToUint(largest2))));
}

void ask(uint b) {
  SleepingBrick brick = sleeping[b];
  ofFirst(0u);  // all have read before the first one writes
  if (brick.kind != kMayMove || (brick.awake != 0u && brick.quiet_s == 0.0)) return;
  vec4 origin = bodies[bodyAt(firstSlot(b))].origin_spacing;
  float edge = float(kBrickEdge) * origin.w;
  vec3 first = xyz(origin) + edge * vec3(brickCoord(firstSlot(b)));
  float reach = brick.awake != 0u ? largestDisplacement(b) : brick.farthest_m;
  vec3 last = first + (edge - origin.w) + reach;
  for (uint i = 0u; i < box_count; ++i) {
    if (all(lessThanEqual(first - reach, box_high[i])) && all(greaterThanEqual(last, box_low[i]))) wake(b);
  }
}
#endif

#ifdef WAKE_HELD
void ask(uint b) {
  uint first = sleeping[b].first_node;
  bool held = false;
  for (uint i = first + lane(); i < first + sleeping[b].node_count; i += LANES) {
    held = held || (nodes[active_nodes[i]].lo & kGrabMask) != 0u;
  }
  if (anyOf(held)) wake(b);
}
#endif

#ifdef WAKE_MARKED
void ask(uint b) {}
#endif

#ifdef WAKE_CUT
layout(std430, binding = kBindDisplacementIn) readonly buffer DisplacementIn { vec4 displacement[]; };
layout(std430, binding = kBindStats) readonly buffer StatsBuffer { TickStats stats; };
layout(std140, binding = kBindToolMotions) uniform ToolMotionsBlock { ToolMotion tool_motions[kMaxStyluses]; };
uniform uint stylus;
uniform float beside;  // in cells: largest distance of tissue from a node outside it
#include "solver/tools/blade.glsl"

/// For a node, or an empty slot.
void ask(uint b) {
  if (stats.springs_cut == nodes_list.springs_cut) return;
  ToolMotion m = tool_motions[stylus];
  float h = bodies[bodyAt(firstSlot(b))].origin_spacing.w;
  vec4 sphere = bladeSphere(m, h);
  sphere.w += beside * h;
  bool near = false;
  for (uint slot = firstSlot(b) + lane(); slot < firstSlot(b) + kBrickSlots; slot += LANES) {
    near = near || !farFromBlade((restPosition(slot) - xyz(m.from)) + xyz(displacement[slot]), sphere);
  }
  if (anyOf(near)) wake(b);
}
#endif

#ifdef CHECK
layout(std430, binding = kBindVelocityOut) readonly buffer VelocityOut { vec4 next_velocity[]; };
uniform uint check;         // number of this check, > 0
uniform float since_s;      // time since the last check
uniform float sleeps_after_s;
uniform float slow2;        // largest |v|^2 that counts as slow [m2/s2]

uint speedBits(uint slot) {
  vec3 v = xyz(next_velocity[slot]);
  return floatBitsToUint(dot(v, v)) & 0x7fffffffu;
}

#ifdef TOOLS
layout(std430, binding = kBindActive) readonly buffer ActiveBuffer { uint active_nodes[]; };
layout(std430, binding = kBindNodes) readonly buffer NodesBuffer { NodeBits nodes[]; };
layout(std430, binding = kBindDisplacementOut) readonly buffer DisplacementOut { vec4 next_displacement[]; };
layout(std140, binding = kBindToolMotions) uniform ToolMotionsBlock { ToolMotion tool_motions[kMaxStyluses]; };
uniform float deepest_m;  // largest depth of a node below the surface by which it is touched
#include "solver/tools/touch.glsl"

bool isWithinReach(ToolMotion m, vec3 x) {
  float reach = m.from.w + deepest_m + distance(xyz(m.from), xyz(m.to));
  vec3 off = x - xyz(m.to);
  return dot(off, off) < reach * reach;
}

/// Returns whether one of its nodes is held or within reach of a probe or a shaft.
bool touched(uint b) {
  uint first = sleeping[b].first_node;
  bool found = false;
  for (uint i = first + lane(); i < first + sleeping[b].node_count; i += LANES) {
    uint slot = active_nodes[i];
    vec3 x = restPosition(slot) + xyz(next_displacement[slot]);
    found = found || (nodes[slot].lo & kGrabMask) != 0u;
    for (uint s = 0u; s < kMaxStyluses; ++s) {
      ToolMotion m = tool_motions[s];
      found = found || ((m.info.y & kToolPushes) != 0u && isWithinReach(m, x));
#ifdef SHAFTS
      found = found || ((m.info.y & kToolShaft) != 0u && isWithinReach(shaftNear(m, x), x));
#endif
    }
  }
  return found;
}
#else
bool touched(uint b) { return false; }
#endif

void ask(uint b) {
  if (sleeping[b].awake == 0u) return;
  uint fastest = 0u;  // positive floats order like their bits, and NaN is above all
#if LANES > 1
  fastest = speedBits(firstSlot(b) + lane());
#else
  for (uint slot = firstSlot(b); slot < firstSlot(b) + kBrickSlots; slot += 4u) {
    fastest = max(fastest, max(max(speedBits(slot), speedBits(slot + 1u)), max(speedBits(slot + 2u), speedBits(slot + 3u))));
  }
#endif
  bool restless = anyOf(fastest > floatBitsToUint(slow2) || touched(b));
  float quiet = uintBitsToFloat(ofFirst(floatBitsToUint(restless ? 0.0 : sleeping[b].quiet_s + since_s)));
  if (isFirst()) sleeping[b].quiet_s = quiet;
  if (quiet >= sleeps_after_s) return;
  for (uint d = lane(); d < 27u; d += LANES) sleeping[neighborBrick(firstSlot(b), d)].wanted = check;
}
#endif

#ifdef LIST
layout(std430, binding = kBindActive) readonly buffer ActiveBuffer { uint active_nodes[]; };
layout(std430, binding = kBindStats) readonly buffer StatsBuffer { TickStats stats; };
#ifdef LAW
layout(std430, binding = kBindCells) readonly buffer CellsBuffer { uint cells[]; };
#endif
uniform uint check;  // number of the last check; 0: bricks are awake as stored
uniform uint group_size;
uniform float sleeps_after_s;
const uint kMostGroups = 65535u;  // along x, as Program::dispatch folds them

/// Returns the state of this check, also for bricks that another invocation is writing.
bool isAwake(uint b) {
  if (sleeping[b].kind != kMayMove) return sleeping[b].kind == kNeverSleeps;
  return check > 0u ? sleeping[b].wanted == check : sleeping[b].awake != 0u;
}

uint groupsOf(uint count) { return (count + group_size - 1u) / group_size; }

void listNodes(uint b) {
  uint count = sleeping[b].node_count, first = sleeping[b].first_node;
  uint position = ofFirst(isFirst() ? atomicAdd(nodes_list.count, count) : 0u);
  for (uint i = lane(); i < count; i += LANES) awake_nodes[position + i] = active_nodes[first + i];
  if (!isFirst()) return;
  atomicMax(nodes_list.groups_x, min(groupsOf(position + count), kMostGroups));
  atomicMax(nodes_list.groups_y, (groupsOf(position + count) + kMostGroups - 1u) / kMostGroups);
}

#ifdef LAW
/// Returns whether a cell of the brick has a corner in an awake brick: its own or one of the seven above. With rows of nodes a
/// cell reaches two nodes farther: all 27 bricks count.
bool needsCells(uint b) {
  bool needed = false;
#ifdef WALLS
  for (uint d = lane(); d < 27u; d += LANES) needed = needed || isAwake(neighborBrick(firstSlot(b), d));
#else
  for (uint c = lane(); c < 8u; c += LANES) {
    needed = needed || isAwake(neighborBrick(firstSlot(b), 13u + (c & 1u) + 3u * ((c >> 1) & 1u) + 9u * (c >> 2)));
  }
#endif
  return anyOf(needed);
}

void listCells(uint b) {
  uint count = sleeping[b].cell_count, first = sleeping[b].first_cell;
  bool needed = needsCells(b);
#ifdef WALLS
  if (isFirst()) sleeping[b].cells_listed = needed ? 1u : 0u;
#endif
  if (!needed || count == 0u) return;
  uint position = ofFirst(isFirst() ? atomicAdd(cells_list.count, count) : 0u);
  for (uint i = lane(); i < count; i += LANES) awake_cells[position + i] = cells[first + i];
  if (!isFirst()) return;
  atomicMax(cells_list.groups_x, min(groupsOf(position + count), kMostGroups));
  atomicMax(cells_list.groups_y, (groupsOf(position + count) + kMostGroups - 1u) / kMostGroups);
}
#endif

/// Puts a brick to sleep, keeps it, or wakes it for a neighbour; then it does not wake others before it moves.
void follow(uint b, bool now) {
  bool before = ofFirst(sleeping[b].awake) != 0u;
  float farthest_m = before && !now ? freeze(b) : sleeping[b].farthest_m;
  if (!isFirst()) return;
  sleeping[b].farthest_m = farthest_m;
  if (now && !before) sleeping[b].quiet_s = sleeps_after_s;
  sleeping[b].awake = now ? 1u : 0u;
}

void ask(uint b) {
  bool now = isAwake(b);
  if (check > 0u && sleeping[b].kind == kMayMove) follow(b, now);
  if (now) listNodes(b);
#ifdef LAW
  listCells(b);
#endif
  if (!isFirst() || sleeping[b].kind != kMayMove) return;
  if (now) atomicAdd(nodes_list.bricks, 1u);
  else atomicMax(nodes_list.farthest_bits, floatBitsToUint(sleeping[b].farthest_m));
}
#endif

void main() {
  uint b = brickOfInvocation();
  if (b >= brick_count) return;
#ifdef LIST
  if (b == 0u && isFirst()) nodes_list.springs_cut = stats.springs_cut;
#else
  if (b == 0u && isFirst()) startLists();
#endif
  ask(b);
}
