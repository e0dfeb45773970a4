// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// picked.glsl - which item an invocation stands for: of its number, or with PICKED of a list (surface/grouped_items.h).
#ifdef PICKED
uniform uint first;  // place in the list
layout(std430, binding = kBindPicked) readonly buffer PickedBuffer { uint picked[]; };
uint itemAt(uint index) { return picked[first + index]; }
#else
uint itemAt(uint index) { return index; }
#endif
