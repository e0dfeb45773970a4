// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/bleed/vessels.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "model/body/body_nodes.h"

namespace viscera {

namespace {

constexpr double kVesselPi = 3.14159265358979323846;
constexpr double kM3PerMl = 1e-6;
constexpr double kMinute_s = 60;

/// Returns whether it leaks a fluid.
bool leaks(const BleedingConfig& bleeding, Fluid fluid) {
  return bleeding.flow_ml_per_min > 0 && bleeding.fluid == fluid;
}

/// Returns [labels] the bleeding of each part; 0 is no part.
std::vector<BleedingConfig> bleedingByLabel(const Body& body) {
  std::vector<BleedingConfig> out(1 + body.lattice.part_names.size(), body.material.bleeding);
  for (const PartConfig& part : body.parts) {
    const auto& names = body.lattice.part_names;
    const auto name = std::find(names.begin(), names.end(), part.part);
    if (name != names.end()) out[static_cast<size_t>(name - names.begin()) + 1] = part.bleeding;
  }
  return out;
}

/// Returns the largest distance between two of these positions.
double lengthOf_m(const std::vector<Vector3d>& rest_m, const std::vector<uint32_t>& slots, uint32_t offset) {
  Vector3d end = rest_m[offset + slots.front()];
  double out = 0;
  for (int sweep = 0; sweep < 2; ++sweep) {
    Vector3d farthest = end;
    for (const uint32_t slot : slots) {
      const Vector3d& at = rest_m[offset + slot];
      if ((at - end).norm() > (farthest - end).norm()) farthest = at;
    }
    out = (farthest - end).norm();
    end = farthest;
  }
  return out;
}

}  // namespace

Vessels::Vessels(const Model& model, const HeatGraph& graph, Fluid fluid)
    : graph_(graph),
      rest_m_(model.slots(), Vector3d::Zero()),
      of_slots_(model.slots()),
      area_m2_(graph.links.size(), 0) {
  for (uint32_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const uint32_t offset = model.slotOffset(b);
    forEachNode(body, [&](uint32_t slot) { rest_m_[offset + slot] = restPosition(body, slot); });
    if (hasOwnNetwork(body)) {
      addNetwork(body, offset, fluid);
    } else {
      addCells(body, offset, fluid);
    }
  }
  const std::vector<uint8_t> whole(graph.links.size(), 0), open(of_slots_.size(), 0);
  for (const Piece& piece : pieces(whole, open)) {
    for (const uint32_t slot : piece.slots) of_slots_[slot].group = static_cast<uint32_t>(group_is_held_.size());
    group_is_held_.push_back(piece.is_held);
  }
  sumSupplies();
}

std::optional<uint32_t> Vessels::groupOf(uint32_t slot) const {
  const Node& node = of_slots_[slot];
  return node.flow_m3_per_s > 0 ? std::optional<uint32_t>(node.group) : std::nullopt;
}

/// Sums the fluid of the parts of each group. A part in several groups has its fluid in each of them.
void Vessels::sumSupplies() {
  supplies_m3_.assign(group_is_held_.size(), 0);
  std::set<std::pair<uint32_t, uint32_t>> added;
  for (const uint32_t slot : nodes_) {
    const Node& node = of_slots_[slot];
    if (added.emplace(node.group, node.part).second) supplies_m3_[node.group] += part_volumes_m3_[node.part];
  }
}

/// Calls visit for each link of a node. @param visit  (link, slot at its other end)
template <class Visit>
void Vessels::forEachLink(uint32_t slot, const Visit& visit) const {
  for (uint32_t i = graph_.starts[slot]; i < graph_.starts[slot + 1]; ++i) {
    const uint32_t link = graph_.links_of[i];
    const HeatGraph::Link& it = graph_.links[link];
    visit(link, it.a == slot ? it.b : it.a);
  }
}

/// @param slots  of the body, some more than once
void Vessels::addPart(const Body& body, uint32_t offset, const std::vector<uint32_t>& slots, double volume_m3,
                      const BleedingConfig& bleeding) {
  if (slots.empty()) return;
  const double section_m2 = bleeding.calibre_m > 0 ? 0.25 * kVesselPi * bleeding.calibre_m * bleeding.calibre_m
                                                   : volume_m3 / lengthOf_m(rest_m_, slots, offset);
  for (const uint32_t slot : slots) {
    Node& node = of_slots_[offset + slot];
    if (node.flow_m3_per_s == 0) nodes_.push_back(offset + slot);
    node.flow_m3_per_s = bleeding.flow_ml_per_min * kM3PerMl / kMinute_s;
    node.section_m2 = section_m2;
    node.part = static_cast<uint32_t>(part_volumes_m3_.size());
    node.is_held = (body.lattice.nodes[slot].lo & layout::kFixedBit) != 0;
  }
  part_volumes_m3_.push_back(bleeding.volume_ml * kM3PerMl);
}

/// Adds the sections of cells: a cell gives each of its edges a quarter of its faces.
void Vessels::addCells(const Body& body, uint32_t offset, Fluid fluid) {
  const Lattice& lattice = body.lattice;
  const std::vector<BleedingConfig> by_label = bleedingByLabel(body);
  std::vector<double> volumes_m3(by_label.size(), 0);
  std::vector<std::vector<uint32_t>> slots(by_label.size());
  const double face_m2 = lattice.spacing_m * lattice.spacing_m;
  for (const uint32_t cell : lattice.active_slots) {
    const uint16_t label = lattice.cell_labels[cell];
    if (label == 0 || !leaks(by_label[label], fluid)) continue;
    const double share = fillOf(lattice, cell).share;
    volumes_m3[label] += share * face_m2 * lattice.spacing_m;
    std::array<uint32_t, 8> corners{};
    size_t count = 0;
    forEachCorner(lattice, cell, [&](const Vector3i&, uint32_t slot) {
      corners[count++] = offset + slot;
      slots[label].push_back(slot);
    });
    for (size_t c = 0; c < corners.size(); ++c) {
      forEachLink(corners[c], [&](uint32_t link, uint32_t other) {
        for (size_t axis = 1; axis < corners.size(); axis *= 2)
          if ((c & axis) == 0 && corners[c | axis] == other) area_m2_[link] += 0.25 * share * face_m2;
      });
    }
  }
  for (size_t label = 1; label < by_label.size(); ++label)
    addPart(body, offset, slots[label], volumes_m3[label], by_label[label]);
}

/// Adds the sections of a network, scaled for isotropic conduction: their sum of area times direction across a plane
/// equals that of the plane.
void Vessels::addNetwork(const Body& body, uint32_t offset, Fluid fluid) {
  if (!leaks(body.material.bleeding, fluid)) return;
  std::vector<uint32_t> slots;
  double volume_m3 = 0;
  forEachNode(body, [&](uint32_t slot) {
    slots.push_back(slot);
    volume_m3 += graph_.volume_m3[offset + slot];
    forEachLink(offset + slot, [&](uint32_t link, uint32_t other) {
      area_m2_[link] = graph_.links[link].w_per_k * (rest_m_[other] - rest_m_[offset + slot]).norm();
    });
  });
  addPart(body, offset, slots, volume_m3, body.material.bleeding);
}

/// Returns the connected components of the vessels by whole links, without closed nodes.
std::vector<Vessels::Piece> Vessels::pieces(const std::vector<uint8_t>& is_cut,
                                            const std::vector<uint8_t>& is_closed) const {
  std::vector<uint8_t> is_found = is_closed;
  std::vector<Piece> out;
  for (const uint32_t first : nodes_) {
    if (is_found[first]) continue;
    is_found[first] = 1;
    Piece piece;
    piece.slots.push_back(first);
    for (size_t i = 0; i < piece.slots.size(); ++i) {
      piece.is_held = piece.is_held || of_slots_[piece.slots[i]].is_held;
      forEachLink(piece.slots[i], [&](uint32_t link, uint32_t other) {
        if (area_m2_[link] == 0 || is_cut[link] || is_found[other]) return;
        is_found[other] = 1;
        piece.slots.push_back(other);
      });
    }
    out.push_back(std::move(piece));
  }
  return out;
}

/// Returns the open cross-section of a vessel at a node, as an outward vector.
Vector3d Vessels::open_m2(uint32_t slot, const std::vector<uint8_t>& is_cut) const {
  Vector3d out = Vector3d::Zero();
  forEachLink(slot, [&](uint32_t link, uint32_t other) {
    if (is_cut[link] && area_m2_[link] > 0) out += area_m2_[link] * (rest_m_[other] - rest_m_[slot]).normalized();
  });
  return out;
}

/// Finds the leaks. Fluid comes from where a vessel is fixed, as it continues there beyond the scene. Of a vessel that
/// is fixed nowhere, the largest piece has the fluid.
Vessels::Leaks Vessels::find(const std::vector<uint8_t>& is_cut, const std::vector<uint8_t>& is_closed) const {
  const std::vector<Piece> all = pieces(is_cut, is_closed);
  std::vector<const Piece*> largest(group_is_held_.size(), nullptr);
  for (const Piece& piece : all) {
    const Piece*& most = largest[of_slots_[piece.slots.front()].group];
    if (!most || piece.slots.size() > most->slots.size()) most = &piece;
  }
  Leaks out;
  for (const Piece& piece : all) {
    const uint32_t group = of_slots_[piece.slots.front()].group;
    const bool is_fed = group_is_held_[group] ? piece.is_held : largest[group] == &piece;
    if (!is_fed || piece.slots.size() < 2) continue;
    const size_t first = out.of_nodes.size();
    double sum_m3_per_s = 0, most_m3_per_s = 0;
    for (const uint32_t slot : piece.slots) {
      const Node& node = of_slots_[slot];
      const double flow_m3_per_s = node.flow_m3_per_s * open_m2(slot, is_cut).norm() / node.section_m2;
      if (flow_m3_per_s == 0) continue;
      out.of_nodes.push_back({slot, flow_m3_per_s, group});
      sum_m3_per_s += flow_m3_per_s;
      most_m3_per_s = std::max(most_m3_per_s, node.flow_m3_per_s);
    }
    out.stumps += out.of_nodes.size() > first;
    if (sum_m3_per_s <= most_m3_per_s) continue;
    for (size_t i = first; i < out.of_nodes.size(); ++i) out.of_nodes[i].m3_per_s *= most_m3_per_s / sum_m3_per_s;
  }
  return out;
}

}  // namespace viscera
