// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Corners of a cell, from its lowest one. After lattice.glsl.

/// Returns the slot of a corner. @param c  bit per axis, x lowest
uint cornerSlot(uint slot, uint c) { return neighborSlot(slot, ivec3(c & 1u, (c >> 1) & 1u, (c >> 2) & 1u)); }
