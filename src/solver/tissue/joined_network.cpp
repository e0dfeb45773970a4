// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/tissue/joined_network.h"

#include "math/vec4.h"
#include "viscera/solver/material.h"

namespace viscera {

namespace {

void addMassesOfLattice(const Body& body, std::vector<float>& out) {
  const float eighth = bodyParams(body, 0).mass_eighth_kg;
  const Strengths table = isHeterogeneous(body) ? strengths(body) : Strengths{};
  for (size_t slot = 0; slot < body.lattice.nodes.size(); ++slot) {
    const float counted = static_cast<float>(massEighths(body.lattice.nodes[slot])) * eighth;
    const float mass = isHeterogeneous(body) ? table.mass_kg[slot] : counted;
    out.push_back(mass > 0 ? mass : 1);
  }
}

void addNetwork(const SpringNetwork& network, uint32_t slot_offset, JoinedNetwork& out) {
  NetworkLinks own = linksOf(network);
  const auto link_offset = static_cast<uint32_t>(out.links.size());
  for (size_t slot = 0; slot + 1 < own.starts.size(); ++slot) out.starts.push_back(own.starts[slot + 1] + link_offset);
  for (layout::Link& link : own.links) {
    link.far += slot_offset;
    out.links.push_back(link);
  }
  for (const layout::SpringEnds& ends : own.ends) {
    out.springs.push_back(
        {ends.a + slot_offset, ends.b + slot_offset, ends.link_a + link_offset, ends.link_b + link_offset});
  }
  for (const double mass : network.masses_kg) out.masses_kg.push_back(mass > 0 ? static_cast<float>(mass) : 1);
  for (const Vector3d& at : network.positions_m) out.rest_m.push_back(rounded(at));
}

}  // namespace

JoinedNetwork joinNetworks(const Model& model) {
  JoinedNetwork out;
  if (!model.hasNetwork()) return out;
  out.starts.push_back(0);
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (body.network) {
      addNetwork(*body.network, model.slotOffset(b), out);
      continue;
    }
    addMassesOfLattice(body, out.masses_kg);
    out.starts.resize(out.starts.size() + body.lattice.nodes.size(), static_cast<uint32_t>(out.links.size()));
    out.rest_m.resize(out.starts.size() - 1);
    for (const uint32_t slot : body.lattice.active_slots) {
      out.rest_m[model.slotOffset(b) + slot] = rounded(body.lattice.restPosition(slot));
    }
  }
  return out;
}

void eraseSprings(const std::vector<float>& spring_cut, const std::vector<layout::SpringEnds>& springs,
                  std::vector<layout::Link>& links) {
  for (size_t i = 0; i < spring_cut.size(); ++i) {
    if (spring_cut[i] == 0) continue;
    links[springs[i].link_a].stiffness = 0;
    links[springs[i].link_b].stiffness = 0;
  }
}

}  // namespace viscera
