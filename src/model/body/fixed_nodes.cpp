// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/body/fixed_nodes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "math/number_text.h"
#include "model/scene/key_location.h"
#include "model/scene/structure_rules.h"
#include "model/shape/organ/tissue.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

constexpr double kOnBorder = 1e-6;      ///< in cells: rounding of the pose
constexpr double kNearest = 0.5;        ///< in cells; see fixNodes()
constexpr double kOnMeshBorder = 1e-4;  ///< in springs: rounding of single-precision meshes

/// Returns how far outside a shape nodes are still fixed, in springs.
double slackOf(const BodyConfig& config) {
  if (isNetwork(config.structure)) return kOnMeshBorder;
  return fillsInPart(config) ? kNearest - kOnBorder : kOnBorder;
}

using Holds = std::function<bool(const Vector3d& point_m)>;

/// Returns a test whether a shape contains a point of the body's frame.
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

/// State of a node: outside all shapes, in a shape's reach, on a face that tissue does not reach, or fixed for certain.
enum class Hold : uint8_t { kNone, kInShape, kOnFace, kFirm };

/// Raises the state of `slots` to `how`. @return  number of slots
size_t hold(const std::vector<uint32_t>& slots, Hold how, std::vector<Hold>& holds) {
  for (const uint32_t slot : slots) holds[slot] = std::max(holds[slot], how);
  return slots.size();
}

size_t holdShape(const Holds& in_shape, const Pose& to_body, const Body& body, std::vector<Hold>& holds) {
  std::vector<uint32_t> held;
  for (const uint32_t slot : body.lattice.active_slots) {
    if (in_shape(to_body * restPosition(body, slot))) held.push_back(slot);
  }
  return hold(held, Hold::kInShape, holds);
}

/// Returns whether a cell's tissue reaches its face on one side of an axis, judged by the slab with the same mean and
/// variance along the axis.
bool reaches(const CellFill& fill, int axis, int side) {
  constexpr double kNear = 0.15;  // in cells: margin for a wedge, as its slab ends before its edge
  const double mean = fill.first[axis] / fill.share, spread = fill.second(axis, axis) / fill.share - mean * mean;
  return side * mean + std::sqrt(3 * std::max(0.0, spread)) > 0.5 - kNear;
}

/// Calls visit(four slots) for a cell's faces, with the axis and the side of each.
template <class Visit>
void forEachFace(const std::array<uint32_t, 8>& corners, Visit visit) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {-1, 1}) {
      std::array<uint32_t, 4> face{};
      size_t n = 0;
      for (size_t c = 0; c < 8; ++c)
        if ((c >> axis & 1) == (side > 0 ? 1U : 0U)) face[n++] = corners[c];
      visit(face, axis, side);
    }
  }
}

/// Frees nodes on the border of the fixed set where no tissue reaches the faces between them. Otherwise tissue that
/// ends in a neighbouring cell would be attached where there is nothing. If no node would remain, all stay fixed.
void letGoBesideTissue(const Lattice& lattice, std::vector<Hold>& holds) {
  const auto is_held = [&](uint32_t slot) { return holds[slot] != Hold::kNone; };
  const auto firmly = [&](auto& slots) { hold({slots.begin(), slots.end()}, Hold::kFirm, holds); };
  for (const uint32_t lowest : lattice.active_slots) {
    if (lattice.cell_labels[lowest] == 0) continue;
    std::array<uint32_t, 8> corners{};
    size_t c = 0;
    forEachCorner(lattice, lowest, [&](const Vector3i&, uint32_t slot) { corners[c++] = slot; });
    const auto held = std::count_if(corners.begin(), corners.end(), is_held);
    if (held == 8) firmly(corners);
    if (held < 4 || held == 8) continue;
    const CellFill fill = fillOf(lattice, lowest);
    forEachFace(corners, [&](const std::array<uint32_t, 4>& face, int axis, int side) {
      if (!std::all_of(face.begin(), face.end(), is_held)) return;
      if (reaches(fill, axis, side))
        firmly(face);
      else
        hold({face.begin(), face.end()}, Hold::kOnFace, holds);
    });
  }
  const bool any = std::any_of(holds.begin(), holds.end(), [](Hold how) { return how == Hold::kFirm; });
  for (Hold& how : holds) {
    if (any && how == Hold::kOnFace) how = Hold::kNone;
  }
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
  std::vector<Hold> holds(body.lattice.nodes.size(), Hold::kNone);
  for (size_t i = 0; i < config.fixed.size(); ++i) {
    const FixedConfig& fixed = config.fixed[i];
    const std::string key = "fixed[" + std::to_string(i) + "]";
    if (fixed.shape == FixedShape::kPart) {
      const auto part = std::find(parts.names.begin(), parts.names.end(), fixed.part);
      if (part == parts.names.end()) {
        throw BodyKeyError(config.name, key, ": no part '" + fixed.part + "'; the parts are " + listed(parts.names));
      }
      const auto label = static_cast<uint16_t>(part - parts.names.begin() + 1);
      if (hold(parts.slots(label), Hold::kFirm, holds) == 0) {
        throw BodyKeyError(config.name, key,
                           ": part '" + fixed.part + "' fills no cell at spacing_m " + numberText(spacing_m));
      }
    } else if (holdShape(shapeOf(fixed, slack_m), to_body, body, holds) == 0) {
      throw BodyKeyError(config.name, key, " matches no node; " + extentOf(body, to_body));
    }
  }
  Lattice& lattice = body.lattice;
  if (!lattice.fills.empty()) letGoBesideTissue(lattice, holds);
  for (const uint32_t slot : lattice.active_slots) {
    if (holds[slot] != Hold::kNone) lattice.nodes[slot].lo |= layout::kFixedBit;
  }
  return static_cast<size_t>(std::count_if(lattice.active_slots.begin(), lattice.active_slots.end(),
                                           [&](uint32_t slot) { return isFixed(lattice.nodes[slot]); }));
}

}  // namespace viscera
