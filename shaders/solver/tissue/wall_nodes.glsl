// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The nodes that kernels of thin walls visit: corners of cells in these walls. After elastic.glsl. Features: AWAKE (only in bricks with
// listed cells, see awake_bricks.comp).
layout(std430, binding = kBindNodes) readonly buffer NodesBuffer { NodeBits nodes[]; };
layout(std430, binding = kBindWallNodes) readonly buffer WallNodesBuffer { uint wall_nodes[]; };
uniform uint wall_node_count;
#ifdef AWAKE
layout(std430, binding = kBindSleepingBricks) readonly buffer SleepingBuffer { SleepingBrick sleeping[]; };
bool isWanted(uint slot) { return sleeping[slot >> 6].cells_listed != 0u; }
#else
bool isWanted(uint slot) { return true; }
#endif
