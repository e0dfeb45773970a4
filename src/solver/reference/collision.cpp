// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/reference/collision.h"

#include <algorithm>
#include <map>

#include "layout/touch_depths.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

namespace {

struct Node {
  uint32_t slot;
  size_t body;
  Vector3d rest_m, x_m;
  double depth_m;  ///< depth below the surface [m]
};

bool isAlone(const layout::NodeBits& bits) {
  return (bits.lo & layout::kAxialMask) == 0 && (bits.hi & layout::kDiagonalMask) == 0;
}

std::vector<Node> nodesThatMayTouch(const Model& model, const Scene& scene, const HostState& state) {
  const std::vector<float> depths = touchDepths(model, scene.collision);
  std::vector<Node> out;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    for (const uint32_t local : model.bodies[b].lattice.active_slots) {
      const uint32_t slot = model.slotOffset(b) + local;
      const layout::NodeBits& bits = state.nodes[slot];
      const bool inside = depths[slot] == layout::kTouchesOnceCut;
      if (isAlone(bits) || depths[slot] == layout::kNeverTouches || (inside && !(bits.lo & layout::kSeveredBit)))
        continue;
      const layout::vec4& u = state.displacement_m[slot];
      const Vector3d rest = restPosition(model.bodies[b], local);
      out.push_back({slot, b, rest, rest + Vector3d(u.x, u.y, u.z), inside ? 0.0 : depths[slot]});
    }
  }
  return out;
}

}  // namespace

std::vector<ReferencePair> referencePairs(const Model& model, const Scene& scene, const HostState& state,
                                          double margin_m) {
  const std::vector<Node> nodes = nodesThatMayTouch(model, scene, state);
  std::vector<double> distances;
  for (const Body& body : model.bodies) distances.push_back(collisionDistance(body, scene.collision));
  std::vector<ReferencePair> out;
  for (size_t i = 0; i < nodes.size(); ++i) {
    for (size_t j = i + 1; j < nodes.size(); ++j) {
      double wanted =
          std::max(distances[nodes[i].body], distances[nodes[j].body]) + nodes[i].depth_m + nodes[j].depth_m;
      if (nodes[i].body == nodes[j].body) wanted = std::min(wanted, 0.5 * (nodes[i].rest_m - nodes[j].rest_m).norm());
      const double depth = wanted - (nodes[i].x_m - nodes[j].x_m).norm();
      if (depth > -margin_m) out.push_back({{nodes[i].slot, nodes[j].slot}, depth});
    }
  }
  return out;
}

Recall recallOf(const std::vector<CollisionPair>& found, const std::vector<ReferencePair>& truth, double tolerance_m) {
  std::map<CollisionPair, double> depths;
  Recall out;
  for (const ReferencePair& pair : truth) {
    depths[pair.slots] = pair.depth_m;
    if (pair.depth_m > tolerance_m) ++out.there;
  }
  for (size_t i = 0; i < found.size(); ++i) {
    const auto known = depths.find(found[i]);
    const bool again = i > 0 && found[i] == found[i - 1];
    if (again || known == depths.end() || known->second < -tolerance_m) {
      ++out.wrong;
    } else if (known->second > tolerance_m) {
      ++out.found;
    }
  }
  return out;
}

}  // namespace viscera
