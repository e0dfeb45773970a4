// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A wound updates only what has changed, tick by tick, and shows the same as if all had been cut at once.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "model/shape/mesh/box_surface.h"
#include "model/skin_shapes.h"
#include "surface/wound_rig.h"

namespace viscera::testing {
namespace {

constexpr double kWoundWorkSpacing_m = 0.01;
constexpr double kMostWork = 2;  // largest work of the cuts of the last stroke, over that of a first one

/// A corner of a shown triangle as its mapping sees it, bit by bit: the nodes that carry it, and how.
using Corner = std::array<unsigned char, sizeof(layout::SkinBinding)>;

/// Returns the triangles regardless of their order and that of their vertices.
std::vector<std::array<Corner, 3>> shownBy(const BodyWound& wound, const std::vector<uint32_t>& triangles) {
  std::vector<std::array<Corner, 3>> out(triangles.size() / 3);
  for (size_t i = 0; i < triangles.size(); ++i)
    std::memcpy(out[i / 3][i % 3].data(), &wound.bindings()[triangles[i]], sizeof(layout::SkinBinding));
  for (std::array<Corner, 3>& corners : out)
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  std::sort(out.begin(), out.end());
  return out;
}

/// Compares a body that was cut tick by tick with one that shows the same cuts for the first time.
void expectTheSame(const Wounded& body) {
  Wounded other(body.lattice, body.skin);
  other.nodes = body.nodes;
  other.axial_cut = body.axial_cut;
  other.update();
  EXPECT_TRUE(shownBy(body.wound, body.wound.skinTriangles()) == shownBy(other.wound, other.wound.skinTriangles()));
  EXPECT_TRUE(shownBy(body.wound, body.wound.wallTriangles()) == shownBy(other.wound, other.wound.wallTriangles()));
  EXPECT_EQ(body.wound.holes(), other.wound.holes());
  EXPECT_EQ(body.wound.slivers(), other.wound.slivers());
}

TEST(WoundWork, CutsTickByTickShowWhatTheyShowAtOnce) {
  constexpr int kTicks = 12;
  const std::vector<Vector3d> normals = anglesOfCuts();
  for (size_t i = 0; i < normals.size(); ++i) {
    SCOPED_TRACE(::testing::Message() << i);
    Wounded body = woundedBox();
    for (int tick = 1; tick <= kTicks; ++tick) {
      const double depth_m = 0.06 * tick / kTicks;
      const auto within = [&](const Vector3d& at) { return at.z() > 0.061 - depth_m; };
      body.cut({0.0403, 0.0352, 0.0304}, normals[i], within);
      if (tick > 4) body.cut({0.0381, 0.0333, 0.0299}, normals[(i + 1) % normals.size()], within);
      if (tick == 9) body.erase([](const Vector3d& at) { return (at - Vector3d(0.03, 0.03, 0.05)).norm() <= 0.013; });
      body.update();
      if (tick % 3 == 0) expectTheSame(body);
    }
    body.makeWhole();
    body.cut({0.0441, 0.0313, 0.0279}, normals[(i + 4) % normals.size()]);
    body.update();
    expectTheSame(body);
  }
}

TEST(WoundWork, OfASkinWithABorderHolesAreCountedAlike) {
  Wounded body = woundedBox(true);
  for (int tick = 1; tick <= 7; ++tick) {
    body.cut({0.0403, 0.0352, 0.0304}, Vector3d(1, 0.2, 0.1).normalized(),
             [&](const Vector3d& at) { return at.y() < 0.01 * tick; });
    body.update();
    expectTheSame(body);
  }
  EXPECT_GT(body.wound.holes(), 0u);
}

/// Cuts springs of nodes within two spacings of a position, as Wounded::cut().
void cutNear(Wounded& body, const Vector3d& position_m, const Vector3d& normal, double reach_m) {
  const Lattice& lattice = body.lattice;
  const Vector3i home = ((position_m - lattice.origin_m) / lattice.spacing_m).array().floor().cast<int>();
  for (int i = 0; i < 125; ++i) {
    const int64_t slot = lattice.slotAt(home + Vector3i(i % 5 - 2, i / 5 % 5 - 2, i / 25 - 2));
    for (uint32_t spring = 0; slot >= 0 && spring < layout::kSpringsPerNode; ++spring) {
      const auto near = static_cast<uint32_t>(slot);
      const int64_t other = lattice.neighborSlot(near, spring);
      if (other < 0 || springCount(body.nodes[near], spring) == 0) continue;
      const Vector3d a = lattice.restPosition(near), b = lattice.restPosition(static_cast<uint32_t>(other));
      const double da = normal.dot(a - position_m), db = normal.dot(b - position_m), share = da / (da - db);
      if ((da >= 0) == (db >= 0) || (a + share * (b - a) - position_m).cwiseAbs().maxCoeff() > reach_m) continue;
      for (const auto& [end, direction] :
           {std::make_pair(near, spring), {static_cast<uint32_t>(other), oppositeSpring(spring)}}) {
        setSpringCount(body.nodes[end], direction, 0);
        body.nodes[end].lo |= layout::kSeveredBit;
        if (direction < layout::kAxialSprings && direction % 2 == 0)
          body.axial_cut[3 * size_t{end} + direction / 2] = static_cast<float>(direction == spring ? share : 1 - share);
      }
    }
  }
}

TEST(WoundWork, OfALaterCutIsThatOfAnEarlyOne) {
  constexpr int kCuts = 1500, kAlong = 25, kDeep = 6, kSome = 150;  // of one stroke
  const Vector3i cells(28, kAlong, 12);
  const Vector3d size_m = kWoundWorkSpacing_m * cells.cast<double>(), normal = Vector3d(1, 0.13, 0.07).normalized();
  Wounded body(
      bindTo(blockSolid(cells, kWoundWorkSpacing_m), boxSurface(Vector3d::Zero(), size_m, cells + Vector3i(3, 2, 1))));
  size_t first = 0, last = 0;
  for (int cut = 0; cut < kCuts; ++cut) {  // adjacent strokes; each cut is a patch of a spacing's size
    const int stroke = cut / (kAlong * kDeep), along = cut / kDeep % kAlong, deep = cut % kDeep;
    Vector3d position_m((2.53 * stroke + 2.5) * kWoundWorkSpacing_m, (along + 0.5) * kWoundWorkSpacing_m,
                        size_m.z() - (deep + 0.5) * kWoundWorkSpacing_m);
    const Vector3d from_middle = position_m - size_m / 2;
    position_m.x() -= (normal.y() * from_middle.y() + normal.z() * from_middle.z()) / normal.x();
    cutNear(body, position_m, normal, 0.51 * kWoundWorkSpacing_m);
    body.update();
    if (cut < kSome) first += body.wound.work().all();
    if (cut >= kCuts - kSome) last += body.wound.work().all();
  }
  EXPECT_GT(first, 0u);
  EXPECT_GT(body.wound.wallTriangles().size(), 3u * kCuts);
  EXPECT_LT(static_cast<double>(last), kMostWork * static_cast<double>(first));
  expectTheSame(body);
}

}  // namespace
}  // namespace viscera::testing
