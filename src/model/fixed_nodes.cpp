// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/fixed_nodes.h"

#include <algorithm>
#include <functional>
#include <sstream>

#include "model/tissue.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

constexpr double kOnBorder = 1e-6;  ///< of a cell: rounding of the pose

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

size_t fixShape(const Holds& holds, const Pose& to_body, Lattice& lattice) {
  size_t matches = 0;
  for (const uint32_t slot : lattice.active_slots) {
    if (!holds(to_body * lattice.restPosition(slot))) continue;
    lattice.nodes[slot].lo |= layout::kFixedBit;
    ++matches;
  }
  return matches;
}

size_t fixPart(uint16_t label, const Solid& solid, Lattice& lattice) {
  size_t matches = 0;
  for (int z = 0; z < solid.cells.z(); ++z) {
    for (int y = 0; y < solid.cells.y(); ++y) {
      for (int x = 0; x < solid.cells.x(); ++x) {
        if (solid.labels[solid.index(x, y, z)] != label) continue;
        for (int c = 0; c < 8; ++c) {
          const int64_t slot = lattice.slotAt({x + (c & 1), y + (c >> 1 & 1), z + (c >> 2)});
          lattice.nodes[static_cast<size_t>(slot)].lo |= layout::kFixedBit;
        }
        ++matches;
      }
    }
  }
  return matches;
}

std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

std::string extentOf(const Lattice& lattice, const Pose& to_body) {
  Eigen::AlignedBox3d box;
  for (const uint32_t slot : lattice.active_slots) box.extend(to_body * lattice.restPosition(slot));
  std::ostringstream out;
  out << "the body spans " << box.min().transpose() << " to " << box.max().transpose() << " m in its own frame";
  return out.str();
}

}  // namespace

size_t fixNodes(const BodyConfig& config, const Solid& solid, Lattice& lattice) {
  const Pose to_body = bodyPose(config).inverse();
  for (size_t i = 0; i < config.fixed.size(); ++i) {
    const FixedConfig& fixed = config.fixed[i];
    const std::string where = "body '" + config.name + "': fixed[" + std::to_string(i) + "]";
    if (fixed.shape == FixedShape::kPart) {
      const auto part = std::find(solid.part_names.begin(), solid.part_names.end(), fixed.part);
      if (part == solid.part_names.end()) {
        throw SceneError(where + ": no part '" + fixed.part + "'; the parts are " + listed(solid.part_names));
      }
      const auto label = static_cast<uint16_t>(part - solid.part_names.begin() + 1);
      if (fixPart(label, solid, lattice) == 0) {
        throw SceneError(where + ": part '" + fixed.part + "' fills no cell at spacing_m " +
                         std::to_string(solid.spacing_m));
      }
    } else if (fixShape(shapeOf(fixed, kOnBorder * solid.spacing_m), to_body, lattice) == 0) {
      throw SceneError(where + " matches no node; " + extentOf(lattice, to_body));
    }
  }
  return static_cast<size_t>(std::count_if(lattice.active_slots.begin(), lattice.active_slots.end(),
                                           [&](uint32_t slot) { return isFixed(lattice.nodes[slot]); }));
}

}  // namespace viscera
