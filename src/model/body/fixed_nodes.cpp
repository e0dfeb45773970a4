// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/body/fixed_nodes.h"

#include <algorithm>
#include <functional>

#include "math/number_text.h"
#include "model/scene/key_place.h"
#include "model/scene/structure_rules.h"
#include "model/shape/organ/tissue.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

constexpr double kOnBorder = 1e-6;      ///< of a cell: rounding of the pose
constexpr double kNearest = 0.5;        ///< of a cell; see fixNodes()
constexpr double kOnMeshBorder = 1e-4;  ///< of a spring: rounding of single-precision meshes

/// How far outside of a shape nodes are still held, in springs.
double slackOf(const BodyConfig& config) {
  if (isNetwork(config.structure)) return kOnMeshBorder;
  return fillsInPart(config) ? kNearest - kOnBorder : kOnBorder;
}

using Holds = std::function<bool(const Vector3d& point_m)>;

/// Whether a shape holds a point of the body's frame.
Holds shapeOf(const FixedConfig& fixed, double slack_m) {
  switch (fixed.shape) {
    case FixedShape::kBox:
      return [fixed, slack_m](const Vector3d& p) {
        return (p.array() >= fixed.min_m.array() - slack_m).all() && (p.array() <= fixed.max_m.array() + slack_m).all();
      };
    case FixedShape::kSphere:
      return [fixed, slack_m](const Vector3d& p) { return (p - fixed.center_m).norm() <= fixed.radius_m + slack_m; };
    default:
      return
          [fixed, slack_m](const Vector3d& p) { return (p - fixed.point_m).dot(fixed.normal.normalized()) <= slack_m; };
  }
}

size_t fix(const std::vector<uint32_t>& slots, Lattice& lattice) {
  for (const uint32_t slot : slots) lattice.nodes[slot].lo |= layout::kFixedBit;
  return slots.size();
}

size_t fixShape(const Holds& holds, const Pose& to_body, Body& body) {
  std::vector<uint32_t> held;
  for (const uint32_t slot : body.lattice.active_slots) {
    if (holds(to_body * restPosition(body, slot))) held.push_back(slot);
  }
  return fix(held, body.lattice);
}

std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

std::string extentOf(const Body& body, const Pose& to_body) {
  Eigen::AlignedBox3d box;
  for (const uint32_t slot : body.lattice.active_slots) box.extend(to_body * restPosition(body, slot));
  TextOut out;
  out << "the body spans " << box.min().transpose() << " to " << box.max().transpose() << " m in its own frame";
  return out.str();
}

}  // namespace

std::vector<uint32_t> slotsOfPart(uint16_t label, const Solid& solid, const Lattice& lattice) {
  std::vector<uint32_t> slots;
  for (int z = 0; z < solid.cells.z(); ++z) {
    for (int y = 0; y < solid.cells.y(); ++y) {
      for (int x = 0; x < solid.cells.x(); ++x) {
        if (solid.labels[solid.index(x, y, z)] != label) continue;
        for (int c = 0; c < 8; ++c) {
          const int64_t slot = lattice.slotAt({x + (c & 1), y + (c >> 1 & 1), z + (c >> 2)});
          slots.push_back(static_cast<uint32_t>(slot));
        }
      }
    }
  }
  return slots;
}

size_t fixNodes(const BodyConfig& config, const PartNodes& parts, Body& body) {
  const Pose to_body = bodyPose(config).inverse();
  const double spacing_m = body.lattice.spacing_m;
  const double slack_m = spacing_m * slackOf(config);
  for (size_t i = 0; i < config.fixed.size(); ++i) {
    const FixedConfig& fixed = config.fixed[i];
    const std::string key = "fixed[" + std::to_string(i) + "]";
    if (fixed.shape == FixedShape::kPart) {
      const auto part = std::find(parts.names.begin(), parts.names.end(), fixed.part);
      if (part == parts.names.end()) {
        throw BodyKeyError(config.name, key, ": no part '" + fixed.part + "'; the parts are " + listed(parts.names));
      }
      const auto label = static_cast<uint16_t>(part - parts.names.begin() + 1);
      if (fix(parts.slots(label), body.lattice) == 0) {
        throw BodyKeyError(config.name, key,
                           ": part '" + fixed.part + "' fills no cell at spacing_m " + numberText(spacing_m));
      }
    } else if (fixShape(shapeOf(fixed, slack_m), to_body, body) == 0) {
      throw BodyKeyError(config.name, key, " matches no node; " + extentOf(body, to_body));
    }
  }
  const Lattice& lattice = body.lattice;
  return static_cast<size_t>(std::count_if(lattice.active_slots.begin(), lattice.active_slots.end(),
                                           [&](uint32_t slot) { return isFixed(lattice.nodes[slot]); }));
}

}  // namespace viscera
