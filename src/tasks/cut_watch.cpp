// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tasks/cut_watch.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "math/union_find.h"
#include "model/body/body_nodes.h"
#include "tasks/task.h"
#include "viscera/layout/links.h"
#include "viscera/model/body/neighbors.h"

namespace viscera {

namespace {

/// Returns the position of a cut along the spring; an erased spring has none, so its middle.
double shareAlong(float cut) {
  return cut >= layout::kErasedShare ? 0.5 : static_cast<double>(cut);
}

/// Returns the node nearest to a position as [body, slot].
/// @param fits  called with a body and a slot; whether the node counts
template <class Fits>
std::pair<size_t, uint32_t> nearestNode(const Model& model, const Vector3d& to_m, const Fits& fits) {
  std::pair<size_t, uint32_t> out;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    forEachNode(model.bodies[b], [&](uint32_t slot) {
      const double distance_m = (restPosition(model.bodies[b], slot) - to_m).norm();
      if (distance_m >= nearest_m || !fits(b, slot)) return;
      nearest_m = distance_m;
      out = {b, slot};
    });
  }
  return out;
}

std::pair<size_t, uint32_t> nearestNode(const Model& model, const Vector3d& to_m) {
  return nearestNode(model, to_m, [](size_t, uint32_t) { return true; });
}

/// Returns the sets of a body's slots that intact springs connect. @param label  of nodes that count; 0: all
UnionFind piecesOf(const Model& model, size_t body, const CutState& cuts, uint16_t label = 0) {
  const Body& it = model.bodies[body];
  UnionFind pieces(it.network ? it.network->masses_kg.size() : it.lattice.nodes.size());
  if (it.network) {
    size_t before = 0;
    for (size_t b = 0; b < body; ++b) before += model.bodies[b].network ? model.bodies[b].network->springs.size() : 0;
    const std::vector<NetworkSpring>& springs = it.network->springs;
    for (size_t i = 0; i < springs.size(); ++i)
      if (cuts.spring_cut.empty() || cuts.spring_cut[before + i] == 0) pieces.unite(springs[i].a, springs[i].b);
    return pieces;
  }
  const uint32_t offset = model.slotOffset(body);
  const auto counts = [&](size_t slot) { return label == 0 || it.lattice.labels[slot] == label; };
  for (const uint32_t slot : it.lattice.active_slots) {
    if (!counts(slot)) continue;
    for (uint32_t s = 0; s < layout::kSpringsPerNode; s += 2) {
      const int64_t other = it.lattice.neighborSlot(slot, s);
      if (other >= 0 && counts(static_cast<size_t>(other)) && springCount(cuts.nodes[offset + slot], s) > 0)
        pieces.unite(slot, static_cast<uint32_t>(other));
    }
  }
  return pieces;
}

}  // namespace

std::vector<FreshCut> CutWatch::fresh(const CutState& cuts) {
  std::vector<FreshCut> out;
  seen_springs_.resize(cuts.spring_cut.size());
  seen_axial_.resize(cuts.axial_cut.size());
  size_t spring = 0;
  for (size_t b = 0; b < model_.bodies.size(); ++b) {
    const Body& body = model_.bodies[b];
    for (size_t i = 0; body.network && i < body.network->springs.size(); ++i, ++spring) {
      const NetworkSpring& it = body.network->springs[i];
      if (spring >= cuts.spring_cut.size() || cuts.spring_cut[spring] == 0 || seen_springs_[spring]) continue;
      seen_springs_[spring] = true;
      if (!hasOwnNetwork(body) || it.against_bending) continue;
      const Vector3d &from = body.network->positions_m[it.a], &to = body.network->positions_m[it.b];
      out.push_back({from + shareAlong(cuts.spring_cut[spring]) * (to - from), b, it.a});
    }
    if (hasOwnNetwork(body)) continue;
    const size_t offset = size_t{3} * model_.slotOffset(b);
    for (const uint32_t slot : body.lattice.active_slots) {
      for (int axis = 0; axis < 3; ++axis) {
        const size_t at = offset + size_t{3} * slot + static_cast<size_t>(axis);
        if (at >= cuts.axial_cut.size() || cuts.axial_cut[at] == 0 || seen_axial_[at]) continue;
        seen_axial_[at] = true;
        const Vector3d along_m = shareAlong(cuts.axial_cut[at]) * body.lattice.spacing_m * Vector3d::Unit(axis);
        out.push_back({body.lattice.restPosition(slot) + along_m, b, slot});
      }
    }
  }
  return out;
}

Joint::Joint(const Model& model, const Vector3d& one_m, const Vector3d& other_m, const std::string& part)
    : model_(model) {
  const auto label = [&](size_t body) {
    const std::vector<std::string>& names = model.bodies[body].lattice.part_names;
    const auto at = std::find(names.begin(), names.end(), part);
    return at == names.end() ? uint16_t{0} : static_cast<uint16_t>(at - names.begin() + 1);
  };
  const auto fits = [&](size_t body, uint32_t slot) {
    return part.empty() || (label(body) > 0 && model.bodies[body].lattice.labels[slot] == label(body));
  };
  const auto [body, one] = nearestNode(model, one_m, fits);
  const auto [other_body, other] = nearestNode(model, other_m, fits);
  if (!part.empty() && label(body) == 0) {
    std::string known;
    for (const Body& it : model.bodies)
      for (const std::string& name : it.lattice.part_names) known += (known.empty() ? "" : ", ") + name;
    throw TaskError("'clip_and_divide.part' must be a part of a body, of " + known + "; found '" + part + "'");
  }
  if (body != other_body)
    throw TaskError("positions of 'clip_and_divide.clips' are nearest to different bodies, " + model.bodies[body].name +
                    " and " + model.bodies[other_body].name + "; they must be on one body");
  body_ = body;
  one_ = one;
  other_ = other;
  label_ = part.empty() ? uint16_t{0} : label(body);
}

bool Joint::isApart(const CutState& cuts) const {
  UnionFind pieces = piecesOf(model_, body_, cuts, label_);
  return pieces.find(one_) != pieces.find(other_);
}

HeldPiece::HeldPiece(const Model& model, const Vector3d& position_m) : model_(model) {
  std::tie(body_, node_) = nearestNode(model, position_m);
  const Body& body = model.bodies[body_];
  const auto held = [&](uint32_t slot) { return isFixed(body.lattice.nodes[slot]); };
  const std::vector<uint32_t>& slots = body.lattice.active_slots;
  if (body.network || std::none_of(slots.begin(), slots.end(), held))
    throw TaskError(
        "'detach.position_m' must be in a body of structure lattice with nodes that 'fixed' holds; it is in " +
        body.name);
}

bool HeldPiece::isApart(const CutState& cuts, const std::vector<FibreState>& fibres) const {
  const Lattice& lattice = model_.bodies[body_].lattice;
  UnionFind pieces = piecesOf(model_, body_, cuts);
  const uint32_t piece = pieces.find(node_);
  size_t alike = 0, within = 0;
  for (const uint32_t slot : lattice.active_slots) {
    const bool is_within = pieces.find(slot) == piece;
    if (is_within && isFixed(lattice.nodes[slot])) return false;
    if (lattice.labels[slot] != lattice.labels[node_]) continue;
    ++alike;
    within += is_within;
  }
  const uint32_t first = model_.slotOffset(body_);
  const auto holds = [&](const FibreState& fibre) {
    return fibre.whole && std::any_of(fibre.nodes.begin(), fibre.nodes.end(), [&](uint32_t slot) {
             return slot >= first && slot - first < lattice.nodes.size() && pieces.find(slot - first) == piece;
           });
  };
  return 2 * within >= alike && std::none_of(fibres.begin(), fibres.end(), holds);
}

DiscPiece::DiscPiece(const Model& model, const Vector3d& center_m, const Vector3d& normal, double radius_m,
                     double outside_m)
    : model_(model) {
  std::tie(body_, center_) = nearestNode(model, center_m);
  const Body& body = model.bodies[body_];
  zones_.resize(body.network ? body.network->masses_kg.size() : body.lattice.nodes.size(), Zone::kNone);
  forEachNode(body, [&](uint32_t slot) {
    const Vector3d offset = restPosition(body, slot) - center_m;
    const double out_m = (offset - normal * normal.dot(offset)).norm();
    zones_[slot] = out_m < radius_m ? Zone::kDisc : out_m > outside_m ? Zone::kOutside : Zone::kRim;
    disc_nodes_ += zones_[slot] == Zone::kDisc;
  });
}

bool DiscPiece::isApart(const CutState& cuts) const {
  UnionFind pieces = piecesOf(model_, body_, cuts);
  const uint32_t piece = pieces.find(center_);
  size_t disc_nodes = 0;
  for (uint32_t slot = 0; slot < zones_.size(); ++slot) {
    if (zones_[slot] == Zone::kNone || pieces.find(slot) != piece) continue;
    if (zones_[slot] == Zone::kOutside) return false;
    disc_nodes += zones_[slot] == Zone::kDisc;
  }
  return 2 * disc_nodes >= disc_nodes_;
}

}  // namespace viscera
