// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/skin_groups.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "model/body/skin_basis.h"
#include "viscera/layout/skin.h"

namespace viscera {

namespace {

constexpr uint32_t kNoGroup = UINT32_MAX;
constexpr float kRounding_m = 1e-6F;  // of positions worked out here in another order than in kernels, within 10 m

Vector3d axisOf(uint32_t spring) {
  const auto& o = kNeighborOffsets[spring];
  return {static_cast<double>(o[0]), static_cast<double>(o[1]), static_cast<double>(o[2])};
}

float lengthOf(const layout::vec4& v) {
  return Vector3f(v.x, v.y, v.z).norm();
}

/// Where a vertex lies in its cell, 0..1 along each axis where it is inside.
Vector3d placeInCell(const layout::SkinBinding& binding, double spacing_m) {
  const Vector3d rest1 = axisOf(binding.springs & 31U), rest2 = -axisOf(binding.springs >> 10U & 31U);
  const SkinBasis basis = triangleBasis(rest1, rest2);
  const layout::vec4& offset = binding.offset_constant;
  const uint32_t own = binding.springs >> layout::kCornerShift & 7U;
  return Vector3d(own & 1U, own >> 1U & 1U, own >> 2U & 1U) + binding.weights.y * rest1 + binding.weights.z * rest2 +
         (offset.x * basis.t + offset.y * basis.n + offset.z * basis.b) / spacing_m;
}

/// Where an edge of a network splits, a piece of it stands out from the node that carries it.
float splitReach(const Skin& skin) {
  float out = 0;
  for (const SplitEdge& edge : skin.split_edges)
    out = std::max(out, (skin.mesh.positions_m[edge.a] - skin.mesh.positions_m[edge.b]).norm());
  return out;
}

void unite(std::vector<uint32_t>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace

/// What is collected of each group.
struct SkinGroups::Draft {
  explicit Draft(size_t groups) : slots(groups), vertex_needs(groups), node_needs(groups) {}
  std::vector<std::vector<uint32_t>> slots, vertex_needs, node_needs;
};

SkinGroups::Lists SkinGroups::Lists::of(std::vector<std::vector<uint32_t>> lists) {
  Lists out;
  out.starts.push_back(0);
  for (std::vector<uint32_t>& list : lists) {
    unite(list);
    out.items.insert(out.items.end(), list.begin(), list.end());
    out.starts.push_back(static_cast<uint32_t>(out.items.size()));
  }
  return out;
}

void SkinGroups::Reach::add(const Reach& other) {
  offset_m = std::max(offset_m, other.offset_m);
  beyond = std::max(beyond, other.beyond);
}

SkinGroups::SkinGroups(const Model& model, const JoinedSkins& skins)
    : model_(&model), split_(model.bodies.size()), wounded_(model.bodies.size()), wholes_(model.bodies.size()) {
  for (size_t b = 0; b <= model.bodies.size(); ++b)
    slot_starts_.push_back(b < model.bodies.size() ? model.slotOffset(b) : static_cast<uint32_t>(model.slots()));
  for (size_t b = 0; b < model.bodies.size(); ++b) split_[b] = !model.bodies[b].skin.split_edges.empty();
  number(model, skins);
  Draft draft(count());
  addTriangles(skins, draft);
  std::vector<float> split_reaches;
  for (const Body& body : model.bodies) split_reaches.push_back(splitReach(body.skin));
  for (size_t g = 0; g < count(); ++g) reaches_[g].offset_m += split_reaches[body_of_[g]];
  for (size_t v = 0; v < skins.bindings.size(); ++v) {
    std::vector<uint32_t>& needs = draft.node_needs[vertex_groups_[v]];
    forEachSlot(skins.bindings[v], [&](uint32_t slot) { needs.push_back(groupOfSlot(slot)); });
  }
  node_starts_.push_back(0);
  for (std::vector<uint32_t>& slots : draft.slots) {
    unite(slots);
    for (const uint32_t slot : slots) nodes_.push_back({slot, restOf(slot)});
    node_starts_.push_back(static_cast<uint32_t>(nodes_.size()));
  }
  vertex_needs_ = Lists::of(std::move(draft.vertex_needs));
  node_needs_ = Lists::of(std::move(draft.node_needs));
}

/// Gives every brick with nodes that vertices depend on a number, in the order of the slots.
void SkinGroups::number(const Model& model, const JoinedSkins& skins) {
  std::vector<uint8_t> used(model.slots() / layout::kBrickSlots);
  for (const layout::SkinBinding& binding : skins.bindings)
    forEachSlot(binding, [&](uint32_t slot) { used[slot / layout::kBrickSlots] = 1; });
  brick_groups_.assign(used.size(), kNoGroup);
  size_t body = 0;
  for (uint32_t brick = 0; brick < used.size(); ++brick) {
    if (!used[brick]) continue;
    while (brick * layout::kBrickSlots >= slot_starts_[body + 1]) ++body;
    brick_groups_[brick] = static_cast<uint32_t>(body_of_.size());
    body_of_.push_back(static_cast<uint32_t>(body));
  }
  for (const layout::SkinBinding& binding : skins.bindings) vertex_groups_.push_back(groupOfSlot(binding.slot0));
}

void SkinGroups::addTriangles(const JoinedSkins& skins, Draft& draft) {
  reaches_.resize(count());
  for (size_t i = 0; i < skins.triangles.size(); i += 3) {
    const uint32_t group = vertex_groups_[skins.triangles[i]];
    for (size_t corner = 0; corner < 3; ++corner) {
      const uint32_t vertex = skins.triangles[i + corner];
      const layout::SkinBinding& binding = skins.bindings[vertex];
      forEachSlot(binding, [&](uint32_t slot) { draft.slots[group].push_back(slot); });
      draft.vertex_needs[group].push_back(vertex_groups_[vertex]);
      reaches_[group].add(reachOf(body_of_[group], binding));
    }
  }
}

template <class Visit>
void SkinGroups::forEachSlot(const layout::SkinBinding& binding, Visit visit) const {
  visit(binding.slot0);
  if (binding.springs & layout::kOneToOneBit) return;
  visit(binding.slot1);
  visit(binding.slot2);
  if (!(binding.springs & layout::kInCellBit)) return;
  const size_t body = bodyOfSlot(binding.slot0);
  const Lattice& lattice = model_->bodies[body].lattice;
  const uint32_t own = binding.springs >> layout::kCornerShift & 7U;
  const Vector3i lowest =
      lattice.nodeAt(binding.slot0 - slot_starts_[body]) - Vector3i(own & 1U, own >> 1U & 1U, own >> 2U & 1U);
  for (int c = 0; c < 8; ++c) {
    const int64_t slot = lattice.slotAt(lowest + Vector3i(c & 1, c >> 1 & 1, c >> 2 & 1));
    if (slot >= 0) visit(slot_starts_[body] + static_cast<uint32_t>(slot));
  }
}

SkinGroups::Reach SkinGroups::reachOf(size_t body, const layout::SkinBinding& binding) const {
  if (binding.springs & layout::kOneToOneBit) return {};
  Reach out;
  out.offset_m =
      std::max({lengthOf(binding.offset_constant), lengthOf(binding.offset_interpolated), std::abs(binding.weights.w)});
  for (const float weight : {binding.weights.x, binding.weights.y, binding.weights.z})
    out.beyond += std::max(0.0F, -weight);
  if (!(binding.springs & layout::kInCellBit)) return out;
  const Vector3d place = placeInCell(binding, model_->bodies[body].lattice.spacing_m);
  double sizes = 1;  // of the corners' weights
  for (int axis = 0; axis < 3; ++axis) sizes *= 1 + 2 * std::max({0.0, -place[axis], place[axis] - 1});
  out.beyond = std::max(out.beyond, static_cast<float>((sizes - 1) / 2));
  return out;
}

size_t SkinGroups::bodyOfSlot(uint32_t slot) const {
  return static_cast<size_t>(std::upper_bound(slot_starts_.begin(), slot_starts_.end(), slot) - slot_starts_.begin() -
                             1);
}

Vector3f SkinGroups::restOf(uint32_t slot) const {
  const size_t body = bodyOfSlot(slot);
  return restPosition(model_->bodies[body], slot - slot_starts_[body]).cast<float>();
}

void SkinGroups::wound(const ShownWounds& shown, const std::vector<layout::SkinBinding>& bindings) {
  std::vector<uint8_t> seen(slot_starts_.back());
  for (size_t b = 0; b < wounded_.size(); ++b) {
    wounded_[b] = shown.bodies[b].wounded;
    wholes_[b] = {};
  }
  for (const layout::SkinBinding& binding : bindings) {
    const size_t body = bodyOfSlot(binding.slot0);
    if (!wounded_[body]) continue;
    Whole& whole = wholes_[body];
    whole.reach.offset_m = std::max(whole.reach.offset_m, lengthOf(binding.offset_constant));
    float beyond = 0;  // of three nodes, as reachOf() has it
    for (const float weight : {binding.weights.x, binding.weights.y, binding.weights.z})
      beyond += std::max(0.0F, -weight);
    whole.reach.beyond = std::max(whole.reach.beyond, beyond);
    for (const uint32_t slot : {binding.slot0, binding.slot1, binding.slot2}) {
      if (!std::exchange(seen[slot], 1)) whole.nodes.push_back({slot, restOf(slot)});
    }
  }
}

template <class Iterator>
SkinBox SkinGroups::around(Iterator first, Iterator last, const Reach& reach, const HostDisplacements& displacements) {
  SkinBox box;
  bool finite = true;
  for (; first != last; ++first) {
    const Vector3f at = first->rest_m + displacements(first->slot);
    finite = finite && at.allFinite();
    box.extend(at);
  }
  if (box.isEmpty() && finite) return box;
  const Vector3f more = reach.beyond * box.sizes() + Vector3f::Constant(reach.offset_m + kRounding_m);
  if (!finite || !more.allFinite()) {
    constexpr float kEverything_m = std::numeric_limits<float>::max();
    return {Vector3f::Constant(-kEverything_m), Vector3f::Constant(kEverything_m)};
  }
  return {box.min() - more, box.max() + more};
}

void SkinGroups::place(const HostDisplacements& displacements, std::vector<SkinBox>& boxes) const {
  boxes.resize(count());
  for (size_t g = 0; g < count(); ++g) {
    boxes[g] =
        around(nodes_.begin() + node_starts_[g], nodes_.begin() + node_starts_[g + 1], reaches_[g], displacements);
  }
  std::vector<SkinBox> whole(wounded_.size());
  for (size_t b = 0; b < wounded_.size(); ++b) {
    if (wounded_[b])
      whole[b] = around(wholes_[b].nodes.begin(), wholes_[b].nodes.end(), wholes_[b].reach, displacements);
  }
  for (size_t g = 0; g < count(); ++g) {
    if (isWhole(body_of_[g])) whole[body_of_[g]].extend(boxes[g]);
  }
  for (size_t g = 0; g < count(); ++g) {
    if (isWhole(body_of_[g]) && hasTriangles(g)) boxes[g] = whole[body_of_[g]];
  }
}

bool SkinGroups::areAll(const std::vector<uint8_t>& shown) const {
  for (size_t g = 0; g < count(); ++g) {
    if (!shown[g] && hasTriangles(g)) return false;
  }
  return true;
}

std::vector<uint8_t> SkinGroups::bodiesOf(const std::vector<uint8_t>& shown) const {
  std::vector<uint8_t> out(wounded_.size());
  for (size_t g = 0; g < count(); ++g) out[body_of_[g]] |= shown[g];
  return out;
}

std::vector<SkinBox> SkinGroups::bodyBoxes(const std::vector<SkinBox>& boxes) const {
  std::vector<SkinBox> out(wounded_.size());
  for (size_t g = 0; g < count(); ++g) out[body_of_[g]].extend(boxes[g]);
  return out;
}

void SkinGroups::need(const std::vector<uint8_t>& shown, Needs& needs) const {
  needs.vertices.assign(count() + 1, 0);
  needs.nodes.assign(count(), 0);
  needs.networks = false;
  for (size_t g = 0; g < count(); ++g) {
    if (!shown[g]) continue;
    const size_t body = body_of_[g];
    needs.networks = needs.networks || isOneToOne(model_->bodies[body]);
    if (wounded_[body]) needs.vertices[g] = needs.vertices[count()] = 1;
    for (uint32_t i = vertex_needs_.starts[g]; i < vertex_needs_.starts[g + 1]; ++i)
      needs.vertices[vertex_needs_.items[i]] = 1;
  }
  for (size_t g = 0; g < count(); ++g) {
    if (!needs.vertices[g]) continue;
    for (uint32_t i = node_needs_.starts[g]; i < node_needs_.starts[g + 1]; ++i) needs.nodes[node_needs_.items[i]] = 1;
  }
}

}  // namespace viscera
