// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "solver/processes/suture/suture_bodies.h"
#include "support/solver_rig.h"
#include "viscera/model/scene/scene.h"

namespace viscera::test {

constexpr double kStitchSpacing_m = 0.003;
constexpr int kSlitLayer = 5;  // layer of nodes on one side of the slit; the next one is on the other

/// Returns a block of 33 x 30 x 9 mm of tissue, its two ends fixed.
inline Body stitchBox() {
  Body body = boxBody({11, 10, 3}, kStitchSpacing_m);
  body.material.young_modulus_pa = 1e4;
  body.material.density_kg_per_m3 = 1000;
  for (const uint32_t slot : body.lattice.active_slots) {
    const int x = body.lattice.nodeAt(slot).x();
    if (x == 0 || x == 11) body.lattice.nodes[slot].lo |= layout::kFixedBit;
  }
  return body;
}

/// Returns the block with a slit of 21 mm through it.
inline Body slitBox() {
  Body body = stitchBox();
  Lattice& lattice = body.lattice;
  const auto isSlit = [](double y) { return y > 1.4 && y < 8.6; };
  for (const uint32_t slot : lattice.active_slots) {
    const Vector3i node = lattice.nodeAt(slot);
    layout::NodeBits& bits = lattice.nodes[slot];
    if (node.x() == kSlitLayer && isSlit(node.y() + 0.5)) bits.lo &= ~layout::kCellBit;
    for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
      const auto& offset = kNeighborOffsets[s];
      const bool across = (node.x() == kSlitLayer && offset[0] > 0) || (node.x() == kSlitLayer + 1 && offset[0] < 0);
      if (across && isSlit(node.y() + 0.5 * offset[1])) setSpringCount(bits, s, 0);
    }
  }
  return body;
}

/// Returns a position in the plane across the middle of the slit [mm].
inline Vector3d inStitch(double x, double z) {
  return 1e-3 * Vector3d(x, 15, z);
}

/// Returns a stitch through the box: in at 4.5 mm from the slit, 6 mm deep, out on the other side, and up.
inline SutureConfig stitch() {
  SutureConfig out;
  out.material = SutureMaterial::kSilk;
  out.position_m = inStitch(16, 13);
  out.start = SutureEnd::kFixed;
  const Vector3d inside[] = {inStitch(12, 8.3), inStitch(12.5, 5.5), inStitch(15, 3.2),
                             inStitch(18, 3.2), inStitch(20.5, 5.5), inStitch(21, 8.3)};
  out.path.push_back({inStitch(12, 9.5)});
  for (const Vector3d& position : inside) {
    out.path.push_back({position});
    out.channels.push_back({"", position});
  }
  for (const Vector3d& position : {inStitch(21, 9.5), inStitch(17, 13), inStitch(17, 50)})
    out.path.push_back({position});
  return out;
}

inline Scene stitchScene(double most_n = 0.1) {
  Scene scene;
  scene.environment.gravity_m_per_s2.setZero();
  scene.styluses.emplace_back();
  scene.styluses[0].max_force_n = most_n;
  scene.sutures = {stitch()};
  return scene;
}

/// Pulls the faces of a box with a slit as in slitBox() apart, by the same distance on either side.
inline void pullApart(TissueStepper& solver, const Body& body, double by_m) {
  HostState state = solver.readState();
  const Body slit = slitBox();
  std::copy(slit.lattice.nodes.begin(), slit.lattice.nodes.end(), state.nodes.begin());
  constexpr double kHalf_m = 0.0165;
  for (const uint32_t slot : body.lattice.active_slots)
    state.displacement_m[slot].x = static_cast<float>((restPosition(body, slot).x() / kHalf_m - 1) * by_m);
  solver.writeState(state);
}

/// A stylus that takes the suture near its end and pulls it up, at most at 20 mm/s.
class StitchTool {
 public:
  explicit StitchTool(double offset_m) : offset_m_(offset_m) {}
  ToolMotions next(const TissueStepper& solver, double tick_s) {
    constexpr size_t kFromEnd = 30;
    const std::vector<Vector3d>& positions = findProcess<SutureBodies>(solver)->chain(0).positions_m();
    const bool begins = time_s_ == 0;
    if (begins) tip_m_ = positions[positions.size() - kFromEnd];
    ToolMotions out = tool(ToolMode::kGrab, at(time_s_), at(time_s_ + tick_s));
    out[0].hold_begins = begins;
    time_s_ += tick_s;
    return out;
  }

 private:
  Vector3d at(double time_s) const { return tip_m_ + std::min(0.02 * time_s, offset_m_) * Vector3d::UnitZ(); }
  double offset_m_, time_s_ = 0;
  Vector3d tip_m_;
};

/// Distances between the two sides of the slit, in the middle of its length.
struct Gap {
  double mean_m = 0, most_m = -1, least_m = 1;
};
inline Gap gapOf(const TissueStepper& solver, const Body& body) {
  const HostState state = solver.readState();
  Gap out;
  int count = 0;
  for (const uint32_t slot : body.lattice.active_slots) {
    const Vector3i node = body.lattice.nodeAt(slot);
    if (node.x() != kSlitLayer || node.y() < 4 || node.y() > 6) continue;
    const auto other = static_cast<size_t>(body.lattice.slotAt(node + Vector3i::UnitX()));
    const double gap_m = static_cast<double>(state.displacement_m[other].x - state.displacement_m[slot].x);
    out.mean_m += gap_m;
    out.most_m = std::max(out.most_m, gap_m);
    out.least_m = std::min(out.least_m, gap_m);
    ++count;
  }
  out.mean_m /= count;
  return out;
}

}  // namespace viscera::test
