// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Forces and energies of the reference (physics.md 1).
#include <algorithm>
#include <cmath>

#include "solver/reference/deformed_spring.h"

namespace viscera {

double ReferenceLattice::strain(const Field& u_m, uint32_t slot, uint32_t spring) const {
  const double rest_m = neighbor(slot, spring).rest_m;
  return rest_m > 0 ? springAt(u_m, slot, spring).extension_m / rest_m : 0;
}

Vector3d ReferenceLattice::springForce(const Field& u_m, uint32_t slot) const {
  Vector3d sum = Vector3d::Zero();
  for (uint32_t s = 0; s < springsOf(slot) && !obeysLaw(slot); ++s) {
    const double k = stiffness(slot, s);
    if (k == 0) continue;
    const Spring spring = springAt(u_m, slot, s);
    sum += k * spring.extension_m * spring.direction;
  }
  return sum;
}

Vector3d ReferenceLattice::dashpotForce(const Field& u_m, const Field& v_m_per_s, uint32_t slot) const {
  Vector3d sum = Vector3d::Zero();
  for (uint32_t s = 0; s < springsOf(slot); ++s) {
    const double c = dashpot(slot, s);
    if (c == 0) continue;
    const Vector3d n = springAt(u_m, slot, s).direction;
    sum += c * n.dot(v_m_per_s[farEnd(slot, s)] - v_m_per_s[slot]) * n;
  }
  return sum;
}

Vector3d ReferenceLattice::dampingForce(const Field& u_m, const Field& v_m_per_s, uint32_t slot) const {
  if (obeysLaw(slot)) return elasticForce(lawPositions(u_m, v_m_per_s), slot) - elasticForce(u_m, slot);
  if (!predicts_ || body(slot).connections != layout::kImplicit) return dashpotForce(u_m, v_m_per_s, slot);
  const double dashpot_s = body(slot).dashpot_s;
  Vector3d sum = Vector3d::Zero();
  for (uint32_t s = 0; s < springsOf(slot); ++s) {
    const double k = stiffness(slot, s);
    if (k == 0) continue;
    const Neighbor& link = neighbor(slot, s);
    const Vector3d dv = v_m_per_s[link.slot] - v_m_per_s[slot], w = u_m[link.slot] - u_m[slot];
    const Spring now = springBetween(link, w), soon = springBetween(link, w + dashpot_s * dv);
    const double strain = soon.extension_m / link.rest_m;
    if (std::abs(strain * (2 + strain)) < static_cast<double>(layout::kMildStretch))
      sum += k * (soon.extension_m * soon.direction - now.extension_m * now.direction);
    else
      sum += k * dashpot_s * now.direction.dot(dv) * now.direction;
  }
  return sum;
}

Field ReferenceLattice::lawPositions(const Field& u_m, const Field& v_m_per_s) const {
  Field out = u_m;
  for (uint32_t slot : active) {
    if (obeysLaw(slot)) out[slot] += body(slot).dashpot_s * v_m_per_s[slot];
  }
  return out;
}

double ReferenceLattice::dissipation(const Field& u_m, const Field& v_m_per_s) const {
  double sum = 0;
  Field now, soon;
  for (uint32_t slot : active) {
    if (obeysLaw(slot)) {
      if (now.empty()) now = elasticForces(u_m), soon = elasticForces(lawPositions(u_m, v_m_per_s));
      sum -= 0.5 * v_m_per_s[slot].dot(soon[slot] - now[slot]);
      continue;
    }
    for (uint32_t s = 0; s < springsOf(slot); ++s) {
      const double c = isFirstEnd(slot, s) ? dashpot(slot, s) : 0;
      if (c == 0) continue;
      const double rate = springAt(u_m, slot, s).direction.dot(v_m_per_s[farEnd(slot, s)] - v_m_per_s[slot]);
      sum += 0.5 * c * rate * rate;
    }
  }
  return sum;
}

double ReferenceLattice::springEnergy(const Field& u_m) const {
  double sum = 0;
  for (uint32_t slot : active) {
    for (uint32_t s = 0; s < springsOf(slot) && !obeysLaw(slot); ++s) {
      const double k = isFirstEnd(slot, s) ? stiffness(slot, s) : 0;
      if (k == 0) continue;
      const double extension = springAt(u_m, slot, s).extension_m;
      sum += 0.5 * k * extension * extension;
    }
  }
  return sum;
}

double ReferenceLattice::forceScale(const Field& u_m) const {
  double scale = 0;
  for (uint32_t slot : active) {
    for (uint32_t s = 0; s < springsOf(slot); ++s) {
      const double k = isFirstEnd(slot, s) ? stiffness(slot, s) : 0;
      if (k == 0) continue;
      scale =
          std::max(scale, k * std::max(std::abs(springAt(u_m, slot, s).extension_m), 1e-6 * neighbor(slot, s).rest_m));
    }
  }
  return scale;
}

CellModes ReferenceLattice::motionOf(const Field& u_m, const Cell& cell) const {
  std::array<Vector3d, 8> corners;
  for (size_t c = 0; c < 8; ++c) corners[c] = u_m[cell.corners[c]];
  return cellMotion(corners, cell.spacing_m);
}

/// Returns whether a cell obeys a law and has all its springs.
bool ReferenceLattice::isWholeCell(const Cell& cell) const {
  return cell.law.rigidity_j != 0 && (nodes[cell.corners[0]].lo & layout::kCellBit) != 0;
}

bool ReferenceLattice::isBroken(const Cell& cell) const {
  return cell.law.rigidity_j != 0 && !(nodes[cell.corners[0]].lo & layout::kCellBit);
}

ReferenceLattice::CornerForces ReferenceLattice::brokenForces(const Field& u_m, const Cell& cell) const {
  CornerForces out;
  out.fill(Vector3d::Zero());
  forEachSpringOf(cell, [&](size_t corner, size_t far, uint32_t slot, uint32_t s, double k) {
    const Spring spring = springOf(u_m[farEnd(slot, s)] - u_m[slot], cell, slot, s);
    const Vector3d pull = k * spring.extension_m * spring.direction;
    out[corner] += pull;
    out[far] -= pull;
  });
  return out;
}

double ReferenceLattice::brokenEnergy(const Field& u_m, const Cell& cell) const {
  double sum = 0;
  forEachSpringOf(cell, [&](size_t, size_t, uint32_t slot, uint32_t s, double k) {
    const double extension = springOf(u_m[farEnd(slot, s)] - u_m[slot], cell, slot, s).extension_m;
    const double at_rest = springOf(Vector3d::Zero(), cell, slot, s).extension_m;
    sum += 0.5 * k * (extension * extension - at_rest * at_rest);
  });
  return sum;
}

/// Returns the forces of a cell on its corners [N]; zero for whole cells in thin walls, which act on more nodes
/// (addWallForces()).
ReferenceLattice::CornerForces ReferenceLattice::cellForces(const Field& u_m, size_t index) const {
  const Cell& cell = cells_[index];
  if (isBroken(cell)) return brokenForces(u_m, cell);
  CornerForces out;
  out.fill(Vector3d::Zero());
  if (!isWholeCell(cell) || cell.isInWall()) return out;
  const CellModes gradient = lawCellGradient(cell.law, motionOf(u_m, cell));
  for (size_t c = 0; c < 8; ++c) {
    const Eigen::Matrix<double, 7, 1> of_corner = motionOfCorner(c, cell.spacing_m);
    for (int i = 0; i < 7; ++i) out[c] -= of_corner[i] * gradient.segment<3>(3 * i);
  }
  return out;
}

/// @param forces_of  forces_of(cell) returns cellForces() of that cell
template <class ForcesOf>
Vector3d ReferenceLattice::cellForce(ForcesOf forces_of, uint32_t slot) const {
  Vector3d sum = Vector3d::Zero();
  for (size_t c = 0; c < 8; ++c) {
    const int cell = around_[slot][c];
    if (cell >= 0) sum += forces_of(static_cast<size_t>(cell))[c];
  }
  return sum;
}

double ReferenceLattice::cellEnergy(const Field& u_m) const {
  double sum = 0;
  for (const Cell& cell : cells_) {
    if (isBroken(cell)) sum += brokenEnergy(u_m, cell);
    if (!isWholeCell(cell)) continue;
    sum += cell.isInWall() ? wallEnergy(u_m, cell) : lawCellEnergy(cell.law, motionOf(u_m, cell));
  }
  return sum;
}

double ReferenceLattice::elasticEnergy(const Field& u_m) const {
  return springEnergy(u_m) + cellEnergy(u_m);
}

Vector3d ReferenceLattice::elasticForce(const Field& u_m, uint32_t slot) const {
  return springForce(u_m, slot) + cellForce([&](size_t cell) { return cellForces(u_m, cell); }, slot) +
         wallForce(u_m, slot);
}

Field ReferenceLattice::elasticForces(const Field& u_m) const {
  std::vector<CornerForces> of_cells(cells_.size());  // each is used by eight nodes
  for (size_t c = 0; c < cells_.size(); ++c) of_cells[c] = cellForces(u_m, c);
  Field forces(slots(), Vector3d::Zero());
  for (uint32_t slot : active) {
    forces[slot] = springForce(u_m, slot) + cellForce([&](size_t cell) { return of_cells[cell]; }, slot);
  }
  addWallForces(u_m, forces);
  return forces;
}

}  // namespace viscera
