// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/contact/collision.h"

#include <algorithm>
#include <cmath>

#include "layout/touch_depths.h"

namespace viscera {

namespace {

/// Factor by which a cell is larger than the reach, as quotients of coordinates and cell are rounded.
constexpr double kCellMargin = 1.01;

uint32_t powerOf2(size_t least) {
  uint32_t out = 1;
  while (out < least) out *= 2;
  return out;
}

/// Returns [slots] the number of cells around each node of a lattice.
std::vector<uint8_t> cellsAround(const Lattice& lattice) {
  std::vector<uint8_t> out(lattice.nodes.size());
  for (const uint32_t lowest : lattice.active_slots) {
    if (!(lattice.nodes[lowest].lo & layout::kCellBit)) continue;
    forEachCorner(lattice, lowest, [&out](const Vector3i&, uint32_t slot) { ++out[slot]; });
  }
  return out;
}

constexpr double kRounded = 0.02;  ///< share of a cell: nodes that are no farther outside count as on the surface

bool isWithin(const Lattice& lattice, uint32_t slot) {
  return lattice.depth_m[slot] >= -kRounded * lattice.spacing_m;
}

/// Returns how far above the surface point nearest to an outside node the inner nodes stop a node that approaches it
/// [m]; negative where they do not. @param distance_m  distance that nodes keep [m]
double stopsAbove(const Lattice& lattice, uint32_t slot, double distance_m) {
  constexpr int kAside = 2, kWide = 2 * kAside + 1;
  const Vector3d offset_m = lattice.offset_to_surface_m[slot].cast<double>();
  const Vector3d outwards = -offset_m.normalized();
  const Vector3i at = lattice.nodeAt(slot);
  double out_m = -distance_m;
  for (int i = 0; i < kWide * kWide * kWide; ++i) {
    const Vector3i aside(i % kWide - kAside, i / kWide % kWide - kAside, i / (kWide * kWide) - kAside);
    const int64_t other = lattice.slotAt(at + aside);
    if (other < 0 || !isWithin(lattice, static_cast<uint32_t>(other))) continue;
    const Vector3d apart_m = lattice.spacing_m * aside.cast<double>() - offset_m;  // from the surface point
    const double above_m = apart_m.dot(outwards), aside2 = apart_m.squaredNorm() - above_m * above_m;
    const double reach_m = distance_m + lattice.depth_m[static_cast<size_t>(other)];
    if (aside2 < reach_m * reach_m) out_m = std::max(out_m, above_m + std::sqrt(reach_m * reach_m - aside2));
  }
  return out_m;
}

/// Returns whether there is no tissue a cell below the surface point nearest to an outside node.
bool isThinBeside(const Lattice& lattice, uint32_t slot) {
  const Vector3d offset = lattice.offset_to_surface_m[slot].cast<double>() / lattice.spacing_m;
  const Vector3d below = offset + offset.normalized();
  const int64_t node = lattice.slotAt(lattice.nodeAt(slot) + below.array().round().matrix().cast<int>());
  return node < 0 || !isWithin(lattice, static_cast<uint32_t>(node));
}

/// Returns whether inner nodes leave the surface point nearest to an outside node uncovered.
bool isBareBeside(const Lattice& lattice, uint32_t slot, double distance_m) {
  constexpr double kFlat = 0.7, kEdge = 0.25;  // shares of the distance: in a square of nodes, and above a sharp edge
  const double stops_m = stopsAbove(lattice, slot, distance_m);
  return stops_m < (isThinBeside(lattice, slot) ? kFlat : kEdge) * distance_m;
}

/// Returns touchDepths() of a lattice with partially filled cells, [slots]. @param distance_m  collisionDistance()
std::vector<float> depthsAtSurface(const Lattice& lattice, double distance_m) {
  constexpr double kNear = -0.7;    // of a cell: every row of nodes through a wall has a node as near
  constexpr double kLeast = -0.25;  // of the distance that nodes keep, and of a cell: smaller spheres leave holes
  const double deepest_m = (1 - kRounded) * lattice.spacing_m;
  const auto least_m = static_cast<float>(kLeast * std::min(distance_m, lattice.spacing_m));
  std::vector<float> out(lattice.nodes.size(), layout::kTouchesOnceCut);
  for (const uint32_t slot : lattice.active_slots) {
    const float depth_m = lattice.depth_m[slot];
    if (isWithin(lattice, slot)) {
      if (depth_m < deepest_m) out[slot] = std::max(depth_m, 0.0f);
    } else if (depth_m >= kNear * lattice.spacing_m && isBareBeside(lattice, slot, distance_m)) {
      out[slot] = std::max(depth_m, least_m);
    } else {
      out[slot] = layout::kNeverTouches;
    }
  }
  return out;
}

/// Returns by how much more than its distance a body's nodes touch [m].
double deepestTouch(const Body& body) {
  return body.hasCells() && !body.lattice.depth_m.empty() ? body.lattice.spacing_m : 0;
}

}  // namespace

double collisionDistance(const Body& body, const CollisionConfig& config) {
  if (config.distance_m > 0) return config.distance_m;
  return body.hasCells() ? body.lattice.spacing_m : body.network->meanLength();
}

double collisionReach(const Model& model, const CollisionConfig& config) {
  double reach = 0, deepest = 0;
  for (const Body& body : model.bodies) {
    reach = std::max(reach, collisionDistance(body, config));
    deepest = std::max(deepest, deepestTouch(body));
  }
  return reach + 2 * deepest;
}

double collisionCell(const Model& model, const CollisionConfig& config) {
  return kCellMargin * collisionReach(model, config);
}

std::vector<float> touchDepths(const Model& model, const CollisionConfig& config) {
  constexpr uint8_t kInside = 8;
  std::vector<float> out(model.slots(), layout::kTouchesOnceCut);
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const uint32_t first = model.slotOffset(b);
    if (body.hasCells() && !body.lattice.depth_m.empty()) {
      const std::vector<float> depths = depthsAtSurface(body.lattice, collisionDistance(body, config));
      std::copy(depths.begin(), depths.end(), out.begin() + first);
      continue;
    }
    const std::vector<uint8_t> cells = body.hasCells() ? cellsAround(body.lattice) : std::vector<uint8_t>{};
    for (const uint32_t slot : body.lattice.active_slots) {
      if (cells.empty() || cells[slot] != kInside) out[first + slot] = 0;
    }
  }
  return out;
}

uint32_t bucketCount(size_t nodes) {
  return powerOf2(2 * nodes);
}

}  // namespace viscera
