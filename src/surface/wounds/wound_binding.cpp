// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/wounds/wound_binding.h"

#include <algorithm>
#include <limits>

#include "model/body/skin_basis.h"

namespace viscera {

namespace {

constexpr double kOtherNode = 0.25;  // cells squared: how much nearer a triangle without the place's own node must be

/// Two axial springs of a node at right angles to each other, which span a triangle.
struct Candidate {
  uint32_t slot0 = 0, slot1 = 0, slot2 = 0;
  Vector3i edge1 = Vector3i::UnitX(), edge2 = Vector3i::UnitY();  // as if they existed where they do not
};

struct Fit {
  double cost = std::numeric_limits<double>::infinity(), weight1 = 0, weight2 = 0;
};

Fit fitOf(const Candidate& candidate, const CutCells& cells, const Vector3d& point) {
  const Vector3d from = point - cells.lattice().nodeAt(candidate.slot0).cast<double>();
  Fit fit;
  const auto share = [&](uint32_t slot, const Vector3i& edge) {  // a missing edge carries nothing
    return slot == candidate.slot0 ? 0 : std::clamp(from.dot(edge.cast<double>()), 0.0, 1.0);
  };
  fit.weight1 = share(candidate.slot1, candidate.edge1);
  fit.weight2 = share(candidate.slot2, candidate.edge2);
  const double beyond = fit.weight1 + fit.weight2 - 1;
  if (beyond > 0) {
    fit.weight1 = std::max(0.0, fit.weight1 - beyond / 2);
    fit.weight2 = 1 - fit.weight1;
  }
  const Vector3d nearest = fit.weight1 * candidate.edge1.cast<double>() + fit.weight2 * candidate.edge2.cast<double>();
  fit.cost = (from - nearest).squaredNorm();
  return fit;
}

Vector3i offsetOf(uint32_t spring) {
  const auto& o = kNeighborOffsets[spring];
  return {o[0], o[1], o[2]};
}

uint32_t neighborOf(const CutCells& cells, uint32_t slot, uint32_t spring) {
  return static_cast<uint32_t>(cells.slotAt(cells.lattice().nodeAt(slot) + offsetOf(spring)));
}

/// Visits triangles of a cell that `take(corner)` and `hold(slot, spring)` accept.
template <class Take, class Hold, class Visit>
void forEachInCell(const CutCells& cells, const WoundPoint& position, Take take, Hold hold, Visit visit) {
  const Vector3i at = cells.lattice().nodeAt(position.cell);
  for (int c = 0; c < 8; ++c) {
    if (!take(static_cast<size_t>(c))) continue;
    const auto slot = static_cast<uint32_t>(cells.slotAt(at + Vector3i(c & 1, c >> 1 & 1, c >> 2)));
    for (int normal = 0; normal < 3; ++normal) {
      const int u = (normal + 1) % 3, v = (normal + 2) % 3;
      const uint32_t spring1 = 2 * static_cast<uint32_t>(u) + (c >> u & 1),
                     spring2 = 2 * static_cast<uint32_t>(v) + (c >> v & 1);
      if (!hold(slot, spring1) || !hold(slot, spring2)) continue;
      visit(Candidate{slot, neighborOf(cells, slot, spring1), neighborOf(cells, slot, spring2), offsetOf(spring1),
                      offsetOf(spring2)});
    }
  }
}

/// Visits those on one side of the wound.
template <class Visit>
void forEachOfSide(const CutCells& cells, const WoundPoint& position, Visit visit) {
  const CutCell* const cut = cells.find(position.cell);
  const auto side = cut == nullptr ? 0 : cut->component[static_cast<size_t>(std::max(0, cut->cornerOf(position.node)))];
  forEachInCell(
      cells, position, [&](size_t corner) { return cut == nullptr || cut->component[corner] == side; },
      [&](uint32_t slot, uint32_t spring) { return cells.isAlive(slot, spring); }, visit);
}

/// Visits the triangles at a node in all cells, degenerate ones where it has no two intact springs at right angles.
template <class Visit>
void forEachAtNode(const CutCells& cells, uint32_t slot, Visit visit) {
  Candidate alone{slot, slot, slot};
  bool any = false;
  for (uint32_t first = 0; first < layout::kAxialSprings; ++first) {
    if (!cells.isAlive(slot, first)) continue;
    if (alone.slot1 == slot) {
      alone.slot1 = neighborOf(cells, slot, first);
      alone.edge1 = offsetOf(first);
      alone.edge2 = Vector3i::Unit((first / 2 + 1) % 3);
    }
    for (uint32_t second = 0; second < layout::kAxialSprings; ++second) {
      if (second / 2 == first / 2 || !cells.isAlive(slot, second)) continue;
      any = true;
      visit(Candidate{slot, neighborOf(cells, slot, first), neighborOf(cells, slot, second), offsetOf(first),
                      offsetOf(second)});
    }
  }
  if (!any) visit(alone);
}

layout::vec4 packed(const Vector3d& v) {
  const Vector3f f = v.cast<float>();
  return {f.x(), f.y(), f.z(), 0};
}

Vector3d woundAxisOf(uint32_t spring) {
  return offsetOf(spring).cast<double>();
}

SkinBasis basisOf(const layout::SkinBinding& binding) {
  return triangleBasis(woundAxisOf(binding.springs & 31U), -woundAxisOf(binding.springs >> 10U & 31U));
}

}  // namespace

void setNormal(const Vector3d& normal, layout::SkinBinding& binding) {
  binding.normal_constant = packed(basisOf(binding).coordinates(normal));
  binding.normal_interpolated = binding.normal_constant;
  if (binding.springs & (layout::kOneNodeBit | layout::kAlongNormalBit)) binding.springs |= layout::kOwnNormalBit;
}

namespace {

layout::SkinBinding bindingOf(const Candidate& best, const Fit& fit, const CutCells& cells, const Vector3d& point,
                              const Vector3d& normal) {
  layout::SkinBinding binding{};
  binding.slot0 = best.slot0;
  binding.slot1 = best.slot1;
  binding.slot2 = best.slot2;
  const Vector3i across = best.edge2 - best.edge1, back = -best.edge2;
  binding.springs = static_cast<uint32_t>(springIndex(best.edge1)) | static_cast<uint32_t>(springIndex(across)) << 5U |
                    static_cast<uint32_t>(springIndex(back)) << 10U;
  const auto weight1 = static_cast<float>(fit.weight1), weight2 = static_cast<float>(fit.weight2);
  binding.weights = {1 - weight1 - weight2, weight1, weight2, 0};
  // The offset is measured from the reference point of the rounded weights, as for uncut meshes (skin.cpp).
  const Vector3d reference = cells.lattice().nodeAt(best.slot0).cast<double>() + weight1 * best.edge1.cast<double>() +
                             weight2 * best.edge2.cast<double>();
  binding.offset_constant = packed(cells.lattice().spacing_m * basisOf(binding).coordinates(point - reference));
  setNormal(normal, binding);
  return binding;
}

}  // namespace

layout::SkinBinding bindToSide(const CutCells& cells, const Vector3d& point, const Vector3d& normal,
                               const WoundPoint& position) {
  Candidate best;
  Fit fit;
  const auto consider = [&](const Candidate& candidate) {
    Fit next = fitOf(candidate, cells, point);
    const bool own =
        candidate.slot0 == position.node || candidate.slot1 == position.node || candidate.slot2 == position.node;
    if (!own) next.cost += kOtherNode;
    if (next.cost >= fit.cost) return;
    fit = next;
    best = candidate;
  };
  forEachOfSide(cells, position, consider);
  if (fit.cost == std::numeric_limits<double>::infinity()) forEachAtNode(cells, position.node, consider);
  return bindingOf(best, fit, cells, point, normal);
}

layout::SkinBinding bindAcross(const CutCells& cells, const Vector3d& point, const Vector3d& normal,
                               const WoundPoint& position) {
  Candidate best;
  Fit fit;
  const auto consider = [&](const Candidate& candidate) {
    const Fit next = fitOf(candidate, cells, point);
    if (next.cost >= fit.cost) return;
    fit = next;
    best = candidate;
  };
  forEachInCell(
      cells, position, [](size_t) { return true; }, [](uint32_t, uint32_t) { return true; }, consider);
  return bindingOf(best, fit, cells, point, normal);
}

layout::SkinBinding bindLike(const layout::SkinBinding& other, const CutCells& cells, const Vector3d& point,
                             const Vector3d& normal) {
  const Candidate same{other.slot0, other.slot1, other.slot2, offsetOf(other.springs & 31U),
                       -offsetOf(other.springs >> 10U & 31U)};
  return bindingOf(same, fitOf(same, cells, point), cells, point, normal);
}

}  // namespace viscera
