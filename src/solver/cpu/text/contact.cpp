// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/text/glsl_kernel.h"
#include "solver/cpu/text/tool_passes.h"

namespace viscera {

namespace glsl {

namespace {

#define VARIANT_NAME Place
#define VARIANT_BASE Kernel
#define VARIANT_TEXT "shaders/solver/tissue/lattice.glsl"
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME Contact
#define VARIANT_BASE Place
#define VARIANT_TEXT "shaders/solver/tools/contact.glsl"
#include "solver/cpu/text/glsl_variant.inc"

}  // namespace

}  // namespace glsl

namespace {

glsl::vec3 fromEigen(const Vector3f& v) {
  return {v.x(), v.y(), v.z()};
}
Vector3f toEigen(const glsl::vec3& v) {
  return {v.x, v.y, v.z};
}

/// Momentum that one stylus or obstacle gave to all nodes, and its moment about the tip.
struct Sum {
  Vector3d impulse = Vector3d::Zero(), angular = Vector3d::Zero();
  uint32_t touched = 0;
};

layout::vec4 rounded(const Vector3d& v, double w) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), static_cast<float>(w)};
}

/// @param impulses  [givers * slots] of which those of `giver` are summed and cleared   @param place  of the giver
void addBrick(CpuLattice& lattice, std::vector<layout::vec4>& impulses, uint32_t brick, size_t giver,
              const Vector3f& place_m, Sum& sum) {
  glsl::Contact place(lattice);
  for (uint32_t i = lattice.store.first_active[brick]; i < lattice.store.first_active[brick + 1]; ++i) {
    const uint32_t slot = lattice.store.active[i];
    layout::vec4& given = impulses[giver * lattice.slotCount() + slot];
    if (given.w == 0) continue;
    const Vector3f arm = toEigen(place.restPosition(slot) + glsl::xyz(place.displacement[slot])) - place_m;
    const Vector3d impulse(given.x, given.y, given.z);
    sum.impulse += impulse;
    sum.angular += arm.cast<double>().cross(impulse);
    ++sum.touched;
    given = {};
  }
}

}  // namespace

void resolveContact(CpuLattice& lattice, uint32_t slot, const layout::ToolMotion* motions, float dt_s,
                    float push_speed_m_per_s, const Vector3f& u_m, Vector3f& u_next_m, Vector3f& v_next_m_per_s) {
  glsl::Contact contact(lattice);
  contact.tool_motions = motions;
  contact.dt_s = dt_s;
  contact.push_speed = push_speed_m_per_s;
  glsl::vec3 u_next = fromEigen(u_next_m), v_next = fromEigen(v_next_m_per_s);
  contact.resolveContacts(slot, lattice.store.nodes[slot], lattice.strengths.mass[slot], fromEigen(u_m), u_next,
                          v_next);
  u_next_m = toEigen(u_next);
  v_next_m_per_s = toEigen(v_next);
}

void sumReactions(CpuLattice& lattice, const std::array<Vector3f, layout::kMaxStyluses>& tips,
                  layout::TickStats& stats) {
  std::array<Sum, layout::kMaxStyluses> sums;
  for (uint32_t brick = 0; brick < lattice.hands.touched.size(); ++brick) {
    if (!lattice.hands.touched[brick]) continue;
    for (uint32_t s = 0; s < layout::kMaxStyluses; ++s)
      addBrick(lattice, lattice.hands.impulses, brick, s, tips[s], sums[s]);
    lattice.hands.touched[brick] = 0;
  }
  for (uint32_t s = 0; s < layout::kMaxStyluses; ++s) {
    stats.impulse[s] = rounded(sums[s].impulse, sums[s].touched);
    stats.angular[s] = rounded(sums[s].angular, 0);
    stats.touched[s] = sums[s].touched;
  }
}

void sumObstacles(CpuLattice& lattice, const std::vector<Vector3f>& places, layout::TickStats& stats) {
  std::array<Sum, layout::kMaxObstacles> sums;
  for (uint32_t brick = 0; brick < lattice.hands.met.size(); ++brick) {
    if (!lattice.hands.met[brick]) continue;
    for (size_t o = 0; o < places.size(); ++o) {
      addBrick(lattice, lattice.hands.obstacle_impulses, brick, o, places[o], sums[o]);
    }
    lattice.hands.met[brick] = 0;
  }
  for (size_t o = 0; o < places.size(); ++o) {
    stats.obstacle_impulse[o] = rounded(sums[o].impulse, sums[o].touched);
    stats.obstacle_angular[o] = rounded(sums[o].angular, 0);
  }
}

}  // namespace viscera
