// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "layout/edge_nodes.h"
#include "solver/cpu/kernels/glsl_kernel.h"
#include "solver/cpu/kernels/tool_passes.h"

namespace viscera {

namespace glsl {

namespace {

#define VARIANT_NAME Contact
#define VARIANT_BASE Kernel
#define VARIANT_TEXT "solver/cpu/kernels/contact.inc"
#include "solver/cpu/kernels/glsl_variant.inc"

}  // namespace

}  // namespace glsl

namespace {

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

/// Sums and clears the impulses of one stylus or obstacle on a brick.
/// @param impulses  [givers * slots]
/// @param place  position of the giver
void addBrick(CpuLattice& lattice, std::vector<layout::vec4>& impulses, uint32_t brick, size_t giver,
              const Vector3f& position_m, Sum& sum) {
  glsl::Contact position(lattice);
  for (uint32_t i = lattice.store.first_active[brick]; i < lattice.store.first_active[brick + 1]; ++i) {
    const uint32_t slot = lattice.store.active[i];
    layout::vec4& given = impulses[giver * lattice.slotCount() + slot];
    if (given.w == 0) continue;
    const Vector3f arm = toEigen(position.restPosition(slot) + glsl::xyz(position.displacement[slot])) - position_m;
    const Vector3d impulse(given.x, given.y, given.z);
    sum.impulse += impulse;
    sum.angular += arm.cast<double>().cross(impulse);
    ++sum.touched;
    given = {};
  }
}

}  // namespace

void resolveContacts(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions, const uint32_t* slots,
                     size_t count) {
  glsl::Contact contact(lattice);
  contact.tell(step);
  contact.tool_motions = motions;
  for (const uint32_t* slot = slots; slot < slots + count; ++slot) {
    if (lattice.strengths.mobility[*slot] == 0) continue;
    glsl::vec3 u_next = glsl::xyz(contact.next_displacement[*slot]), v_next = glsl::xyz(contact.next_velocity[*slot]);
    contact.resolveContacts(*slot, lattice.store.nodes[*slot], lattice.strengths.mass[*slot],
                            glsl::xyz(contact.displacement[*slot]), u_next, v_next);
    contact.next_displacement[*slot] = glsl::vec4(u_next, 0);
    contact.next_velocity[*slot] = glsl::vec4(v_next, 0);
  }
}

void CpuEdges::add(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions, const uint32_t* slots,
                   size_t count) {
  glsl::Contact contact(lattice);
  contact.tell(step);
  contact.tool_motions = motions;
  for (const uint32_t* slot = slots; slot < slots + count; ++slot) {
    const glsl::vec3 x = contact.restPosition(*slot) + glsl::xyz(contact.next_displacement[*slot]);
    if (contact.mayFeelEdges(*slot, lattice.store.nodes[*slot], x)) slots_.push_back(*slot);
  }
}

struct CpuEdges::Lists {
  std::vector<glsl::Contact::NearEdge> edges;
  std::vector<glsl::Contact::AskedEdge> asked;                       ///< edges of a round that are in contact
  std::vector<std::pair<uint32_t, glsl::Contact::EdgePush>> pushes;  ///< pushes of a round, by slot
  std::vector<glsl::vec2> sums;                                      ///< [slots]
};

CpuEdges::CpuEdges(size_t slots) : lists_(std::make_unique<Lists>()) {
  if (slots == 0) return;
  lists_->sums.resize(slots, glsl::vec2(0));
  constexpr size_t kNodes = 1024, kEdges = 8 * kNodes;  // more than come near a tip that is a few cells wide
  slots_.reserve(kNodes);
  lists_->pushes.reserve(kNodes);
  lists_->edges.reserve(kEdges);
  lists_->asked.reserve(kEdges);
}
CpuEdges::~CpuEdges() = default;

void CpuEdges::run(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions) {
  if (slots_.size() > layout::kMostEdgeNodes) slots_.clear();
  if (slots_.empty()) return;
  glsl::Contact contact(lattice);
  contact.tell(step);
  auto& [edges, asked, pushes, sums] = *lists_;
  contact.edge_sums = sums.data();
  const auto push = [&](uint32_t s, const glsl::Contact::EdgeTip& tip) {
    edges.clear();
    for (const uint32_t slot : slots_) contact.listEdges(tip, slot, edges);
    for (uint32_t round = 0; round < layout::kEdgeRounds; ++round) {
      asked.clear();
      contact.askEdges(tip, edges, asked);
      if (asked.empty()) break;
      pushes.clear();
      const auto *first = asked.data(), *end = first + asked.size();
      while (first != end) {
        const uint32_t slot = first->edge.slot;
        pushes.emplace_back(slot, contact.pushOfAsked(first, end));
      }
      for (const auto& [slot, given] : pushes) {
        contact.giveEdges(s, slot, given);
        sums[slot] = glsl::vec2(0);
      }
    }
  };
  for (uint32_t s = 0; s < layout::kMaxStyluses; ++s) {
    if (contact.pushesByTip(motions[s])) push(s, contact.tipOf(motions[s]));
    if (contact.pushesByShaft(motions[s])) push(s, contact.shaftOf(motions[s]));
  }
  slots_.clear();
}

void sumReactions(CpuLattice& lattice, const std::array<Vector3f, layout::kMaxStyluses>& tips,
                  layout::TickStats& stats) {
  std::array<Sum, layout::kMaxStyluses> sums;
  for (uint32_t brick = 0; brick < lattice.tools.touched.size(); ++brick) {
    if (!lattice.tools.touched[brick]) continue;
    for (uint32_t s = 0; s < layout::kMaxStyluses; ++s)
      addBrick(lattice, lattice.tools.impulses, brick, s, tips[s], sums[s]);
    lattice.tools.touched[brick] = 0;
  }
  for (uint32_t s = 0; s < layout::kMaxStyluses; ++s) {
    stats.impulse[s] = rounded(sums[s].impulse, sums[s].touched);
    stats.angular[s] = rounded(sums[s].angular, 0);
    stats.touched[s] = sums[s].touched;
  }
}

void sumObstacles(CpuLattice& lattice, const std::vector<Vector3f>& positions, layout::TickStats& stats) {
  std::array<Sum, layout::kMaxObstacles> sums;
  for (uint32_t brick = 0; brick < lattice.tools.met.size(); ++brick) {
    if (!lattice.tools.met[brick]) continue;
    for (size_t o = 0; o < positions.size(); ++o) {
      addBrick(lattice, lattice.tools.obstacle_impulses, brick, o, positions[o], sums[o]);
    }
    lattice.tools.met[brick] = 0;
  }
  for (size_t o = 0; o < positions.size(); ++o) {
    stats.obstacle_impulse[o] = rounded(sums[o].impulse, sums[o].touched);
    stats.obstacle_angular[o] = rounded(sums[o].angular, 0);
  }
}

}  // namespace viscera
