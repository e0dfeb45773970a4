// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Step of a node with contacts to other nodes in a sweep: the step of its majoriser under the forces on it and those of these
// contacts, outside probes and obstacles. After implicit_pull.glsl, implicit_pairs.glsl and, with probes or obstacles,
// implicit_contact.glsl.
vec3 positionOf(uint slot, vec4 pulled, vec3 u, vec3 du) {
  vec3 force = xyz(pulled) + xyz(node_pairs[3u * slot + 2u]);
  vec3 change = force / pulled.w;
#ifdef CONTACT
  findContacts(slot, u, du + change);
  if (contactCount(slot) != 0u) change = stepInContact(slot, pulled.w, du, force);
#endif
  return du + change;
}

void place(uint slot, vec4 pulled, vec3 u, vec3 du) {
  float pressing = max(1.0f, node_pairs[3u * slot + 2u].w);
  node_pairs[3u * slot + 1u] = vec4(positionOf(slot, pulled, u, du), pressing);
}
