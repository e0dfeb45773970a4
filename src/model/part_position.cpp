// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/part_position.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <vector>

#include "viscera/math/error.h"
#include "viscera/model/model.h"

namespace viscera {
namespace {

constexpr double kUnreached = std::numeric_limits<double>::infinity();

/// Nodes of a part in one body.
struct NodesOfPart {
  const Lattice* lattice = nullptr;
  std::vector<bool> within;     ///< [slots]
  std::vector<uint32_t> slots;  ///< ascending
};

NodesOfPart partNodes(const Body& body, const std::string& part) {
  const Lattice& lattice = body.lattice;
  const auto at = std::find(lattice.part_names.begin(), lattice.part_names.end(), part);
  const auto label = static_cast<size_t>(at - lattice.part_names.begin()) + 1;
  const bool whole = body.name == part;
  NodesOfPart out{&lattice, std::vector<bool>(lattice.nodes.size()), {}};
  for (const uint32_t slot : lattice.active_slots) {
    if (!whole && (at == lattice.part_names.end() || lattice.labels[slot] != label)) continue;
    out.within[slot] = true;
    out.slots.push_back(slot);
  }
  return out;
}

/// Returns the nodes of a part, of the body that has most of them. @throws Error  there are none
NodesOfPart partNodes(const Model& model, const std::string& part) {
  NodesOfPart out;
  std::vector<std::string> names;
  std::string known;
  const auto add = [&](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) != names.end()) return;
    names.push_back(name);
    known += (known.empty() ? "" : ", ") + name;
  };
  for (const Body& body : model.bodies) {
    if (!body.hasCells()) continue;
    add(body.name);
    for (const std::string& name : body.lattice.part_names) add(name);
    NodesOfPart here = partNodes(body, part);
    if (here.slots.size() > out.slots.size()) out = std::move(here);
  }
  if (out.slots.empty())
    throw Error("'part' and 'from' must be bodies or parts of the tissue, of " + (known.empty() ? "none" : known) +
                "; found '" + part + "'");
  return out;
}

/// Returns the length of the shortest path within the part from a node to each; infinite for others.
std::vector<double> pathLengths(const NodesOfPart& part, uint32_t start) {
  using Reached = std::pair<double, uint32_t>;
  const Lattice& lattice = *part.lattice;
  std::vector<double> out(lattice.nodes.size(), kUnreached);
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> next;
  out[start] = 0;
  next.emplace(0.0, start);
  while (!next.empty()) {
    const auto [length_m, slot] = next.top();
    next.pop();
    if (length_m > out[slot]) continue;
    for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
      const int64_t to = lattice.neighborSlot(slot, s);
      if (to < 0 || !part.within[static_cast<size_t>(to)]) continue;
      const auto other = static_cast<uint32_t>(to);
      const double more_m = length_m + (lattice.restPosition(other) - lattice.restPosition(slot)).norm();
      if (more_m >= out[other]) continue;
      out[other] = more_m;
      next.emplace(more_m, other);
    }
  }
  return out;
}

/// Keeps the largest piece of a part.
NodesOfPart largestPieceOf(const NodesOfPart& part) {
  NodesOfPart out;
  std::vector<bool> seen(part.within.size());
  for (const uint32_t slot : part.slots) {
    if (seen[slot]) continue;
    const std::vector<double> lengths_m = pathLengths(part, slot);
    NodesOfPart piece{part.lattice, std::vector<bool>(part.within.size()), {}};
    for (const uint32_t other : part.slots) {
      if (lengths_m[other] == kUnreached) continue;
      seen[other] = piece.within[other] = true;
      piece.slots.push_back(other);
    }
    if (piece.slots.size() > out.slots.size()) out = std::move(piece);
  }
  return out;
}

/// Returns the node of a part that is nearest to another part.
uint32_t nodeNearest(const NodesOfPart& part, const NodesOfPart& other) {
  uint32_t out = part.slots.front();
  double least = kUnreached;
  for (const uint32_t slot : part.slots) {
    const Vector3d at_m = part.lattice->restPosition(slot);
    for (const uint32_t there : other.slots) {
      const double squared = (other.lattice->restPosition(there) - at_m).squaredNorm();
      if (squared >= least) continue;
      least = squared;
      out = slot;
    }
  }
  return out;
}

uint32_t farthestNode(const NodesOfPart& part, const std::vector<double>& lengths_m) {
  return *std::max_element(part.slots.begin(), part.slots.end(),
                           [&](uint32_t a, uint32_t b) { return lengths_m[a] < lengths_m[b]; });
}

}  // namespace

Vector3d positionOf(const Model& model, const PartPosition& position) {
  const NodesOfPart part = largestPieceOf(partNodes(model, position.part));
  // Lengths count from the far end: a part ends there in few nodes, but often adjoins `from` with a whole side.
  std::vector<double> lengths_m;
  double wanted_m = 0;
  if (!position.from.empty()) {
    const uint32_t near = nodeNearest(part, partNodes(model, position.from));
    lengths_m = pathLengths(part, farthestNode(part, pathLengths(part, near)));
    wanted_m = (1 - position.along) * lengths_m[farthestNode(part, lengths_m)];
  }
  Vector3d sum_m = Vector3d::Zero();
  size_t count = 0;
  for (const uint32_t slot : part.slots) {
    if (!lengths_m.empty() && std::abs(lengths_m[slot] - wanted_m) > part.lattice->spacing_m) continue;
    sum_m += part.lattice->restPosition(slot);
    ++count;
  }
  return sum_m / static_cast<double>(count) + position.offset_m;
}

}  // namespace viscera
