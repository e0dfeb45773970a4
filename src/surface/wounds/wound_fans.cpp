// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Joins walls to the lips of the surface mesh.
#include "surface/skins/keep_room.h"
#include "surface/wounds/wound_walls.h"

namespace viscera {

namespace {

// Order of triangles: after quads (wound_walls.cpp).
constexpr uint64_t kFans = uint64_t{1} << 62U, kFansBetween = uint64_t{2} << 62U;

}  // namespace

/// Moves a vertex to the vertex of the surface mesh that it belongs to.
void WoundWalls::placeLipVertex(uint32_t vertex) {
  touched_.record(vertex, mark_);
  const Vector3d& point = skin_->pointOf(vertices_[vertex].skin_vertex);
  if (vertices_[vertex].point == point) return;
  vertices_[vertex].point = point;
  to_shade_.record(vertex, mark_);
  askAround(vertex);
}

void WoundWalls::dropFan(uint32_t f) {
  Fan& fan = fans_[f];
  if (fan.triangle == kNone) return;
  recordNeighborFans(fan.triangle);
  for (uint32_t& triangle : fan.triangles) dropTriangle(triangle);
  for (const uint32_t vertex : {fan.from, fan.to}) touched_.record(vertex, mark_);
  if (fan.cell != kNone) {
    points_to_find_.record(fan.cell, mark_);
    uint32_t* link = &first_fans_[fan.cell];
    while (*link != f) link = &fans_[*link].next;
    *link = fan.next;
  }
  fan = Fan();
}

void WoundWalls::placeFan(uint32_t f, const Lip& lip) {
  Fan& fan = fans_[f];
  fan.triangle = lip.triangle;
  fan.from = lipVertex(lip.from);
  fan.to = lipVertex(lip.to);
  for (const uint32_t vertex : {fan.from, fan.to}) placeLipVertex(vertex);
  recordNeighborFans(lip.triangle);
  if (lip.cell == Lip::kNoCell) return;
  fan.cell = cells_->numberOf(lip.cell);
  fan.next = first_fans_[fan.cell];
  first_fans_[fan.cell] = f;
  points_to_find_.record(fan.cell, mark_);
}

/// Notes the fans of a triangle and of those that share an edge with it, as lips continue from one to the other.
void WoundWalls::recordNeighborFans(uint32_t triangle) {
  for (const uint32_t edge : skin_->edgesOf(triangle)) {
    for (const uint32_t beside : skin_->trianglesAt(edge)) {
      const uint32_t shown = beside == WoundSkinIndex::kNone ? kNone : skin_->shownOf(beside);
      if (shown == kNone) continue;
      for (uint32_t i = 0; i < skin_->shown()[shown].lip_count; ++i) fans_to_make_.record(6 * shown + i, mark_);
    }
  }
}

/// Updates the fans that the surface mesh has changed.
void WoundWalls::takeFans() {
  for (const uint32_t shown : skin_->changed()) {
    for (uint32_t i = 0; i < 6; ++i) dropFan(6 * shown + i);
  }
  for (const uint32_t shown : skin_->changed()) {
    const VisiblePieces& pieces = skin_->shown()[shown];
    for (uint32_t i = 0; i < pieces.lip_count; ++i) {
      if (fans_[6 * shown + i].triangle == kNone) placeFan(6 * shown + i, pieces.lips[i]);
    }
  }
}

/// Returns the lip that ends where this one begins, in a cell.
const Lip* WoundWalls::lipBefore(const Lip& lip) const {
  const Lip* before = nullptr;
  forEachLipAt(lip.from, [&](const Lip& other) {
    if (before == nullptr && other.to == lip.from && other.cell != Lip::kNoCell) before = &other;
  });
  return before;
}

void WoundWalls::addFan(uint32_t f) {
  Fan& fan = fans_[f];
  if (fan.triangle == kNone || fan.cell == kNone) return;
  const Lip& lip = skin_->shown()[f / 6].lips[f % 6];
  const auto point_of = [&](const Lip& of) {
    const uint32_t cell = cells_->numberOf(of.cell);
    return pointVertex(cell, sideOf(cell, of.node));
  };
  const uint64_t order = 8 * uint64_t{lip.triangle} + f % 6;
  const uint32_t behind = point_of(lip);
  setTriangle({fan.to, fan.from, behind}, kFans | order, fan.triangles[0]);
  std::array<uint32_t, 3> between{};
  if (const Lip* const other = lipBefore(lip)) {
    const uint32_t before = point_of(*other);
    // Not from side to side of one cell, where a wound ends: a web would span it when it opens.
    if (cell_of_[before] != cell_of_[behind]) between = {fan.from, before, behind};
  }
  setTriangle(between, kFansBetween | order, fan.triangles[1]);
}

/// Finds the outward direction of a vertex on a lip, from the pieces of the surface mesh around it.
void WoundWalls::findOutward(uint32_t vertex) {
  if (vertices_[vertex].skin_vertex == WoundVertex::kNone) return;
  Vector3d outward = Vector3d::Zero();
  forEachLipAt(vertices_[vertex].skin_vertex, [&](const Lip& lip) {
    if (lip.cell != Lip::kNoCell) outward += lip.outward;
  });
  if (outward == outward_[vertex]) return;
  outward_[vertex] = outward;
  askAround(vertex);
}

/// Joins every lip to its cell's point. Where a lip continues in another cell, joins both cells' points to the vertex
/// between.
void WoundWalls::addFans() {
  for (const uint32_t cell : cells_changed_.list) {
    for (uint32_t f = first_fans_[cell]; f != kNone; f = fans_[f].next) recordNeighborFans(fans_[f].triangle);
  }
  for (const uint32_t f : fans_to_make_.list) addFan(f);
  for (const uint32_t vertex : touched_.list) findOutward(vertex);
}

}  // namespace viscera
