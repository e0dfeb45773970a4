// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/skin_boxes.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "model/body/skin_basis.h"
#include "viscera/layout/skin.h"

namespace viscera {

namespace {

constexpr float kRounding_m = 1e-6F;  // of positions within 10 m: kernels round in another order

Vector3d axisOf(uint32_t spring) {
  const auto& o = kNeighborOffsets[spring];
  return {static_cast<double>(o[0]), static_cast<double>(o[1]), static_cast<double>(o[2])};
}

float lengthOf(const layout::vec4& v) {
  return Vector3f(v.x, v.y, v.z).norm();
}

/// Returns the position of a vertex in its cell, 0..1 along each axis if it is inside.
Vector3d positionInCell(const layout::SkinBinding& binding, double spacing_m) {
  const Vector3d rest1 = axisOf(binding.springs & 31U), rest2 = -axisOf(binding.springs >> 10U & 31U);
  const SkinBasis basis = triangleBasis(rest1, rest2);
  const layout::vec4& offset = binding.offset_constant;
  const uint32_t own = binding.springs >> layout::kCornerShift & 7U;
  return Vector3d(own & 1U, own >> 1U & 1U, own >> 2U & 1U) + binding.weights.y * rest1 + binding.weights.z * rest2 +
         (offset.x * basis.t + offset.y * basis.n + offset.z * basis.b) / spacing_m;
}

/// Returns how far a piece of a split edge of a network may reach from the node that carries it.
float splitReach(const Skin& skin) {
  float out = 0;
  for (const SplitEdge& edge : skin.split_edges)
    out = std::max(out, (skin.mesh.positions_m[edge.a] - skin.mesh.positions_m[edge.b]).norm());
  return out;
}

/// Returns the sum of the negative weights, without sign, of a vertex outside its cell.
float beyondCell(const layout::SkinBinding& binding, double spacing_m) {
  const Vector3d position = positionInCell(binding, spacing_m);
  double sizes = 1;  // sum of the absolute weights
  for (int axis = 0; axis < 3; ++axis) sizes *= 1 + 2 * std::max({0.0, -position[axis], position[axis] - 1});
  return static_cast<float>((sizes - 1) / 2);
}

}  // namespace

SkinBoxes::SkinBoxes(const Model& model, const std::vector<layout::SkinBinding>& bindings) : slots_(model.slots()) {
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    bodies_.push_back({model.slotOffset(b), body.lattice.spacing_m, {}});
    if (body.skin.mesh.triangles.empty()) continue;
    // Walls of wounds may be bound to any node inside.
    for (const uint32_t slot : body.skin.can_be_cut ? body.lattice.active_slots : body.skin.bound_slots)
      bodies_[b].nodes.push_back({model.slotOffset(b) + slot, restPosition(body, slot).cast<float>()});
  }
  add(bindings);
  for (size_t b = 0; b < bodies_.size(); ++b) bodies_[b].offset_m += splitReach(model.bodies[b].skin);
}

void SkinBoxes::add(const std::vector<layout::SkinBinding>& bindings) {
  for (const layout::SkinBinding& binding : bindings) {
    OfBody& body = *std::prev(std::upper_bound(bodies_.begin(), bodies_.end(), binding.slot0,
                                               [](uint32_t slot, const OfBody& b) { return slot < b.first_slot; }));
    body.offset_m = std::max({body.offset_m, lengthOf(binding.offset_constant), lengthOf(binding.offset_interpolated),
                              std::abs(binding.weights.w)});
    float beyond = 0;
    for (const float weight : {binding.weights.x, binding.weights.y, binding.weights.z})
      beyond += std::max(0.0F, -weight);
    if (!(binding.springs & layout::kOneToOneBit) && (binding.springs & layout::kInCellBit))
      beyond = std::max(beyond, beyondCell(binding, body.spacing_m));
    body.beyond = std::max(body.beyond, beyond);
  }
}

SkinBox SkinBoxes::around(const OfBody& body, const HostDisplacements& displacements) {
  SkinBox box;
  bool finite = true;
  for (const Node& node : body.nodes) {
    const Vector3f at = node.rest_m + displacements(node.slot);
    finite = finite && at.allFinite();
    box.extend(at);
  }
  if (box.isEmpty() && finite) return box;
  const Vector3f more = body.beyond * box.sizes() + Vector3f::Constant(body.offset_m + kRounding_m);
  if (!finite || !more.allFinite()) {
    constexpr float kEverything_m = std::numeric_limits<float>::max();
    return {Vector3f::Constant(-kEverything_m), Vector3f::Constant(kEverything_m)};
  }
  return {box.min() - more, box.max() + more};
}

std::vector<SkinBox> SkinBoxes::place(const HostDisplacements& displacements) const {
  std::vector<SkinBox> boxes;
  for (const OfBody& body : bodies_) boxes.push_back(around(body, displacements));
  return boxes;
}

std::vector<SkinBox> SkinBoxes::atRest() const {
  return place(HostDisplacements::ofSlots(std::vector<layout::vec4>(slots_, layout::vec4{0, 0, 0, 0})));
}

}  // namespace viscera
