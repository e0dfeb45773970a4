// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Which cuts of a part bleed, and how much.
#include "solver/processes/bleed/vessels.h"
#include "viscera/model/scene/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

namespace viscera {
namespace {

constexpr double kMl_per_min = 1e-6 / 60;  // m3/s
constexpr double kFlow = 60;               // ml/min
constexpr double kNick = 0.02;             // of the flow out of a nick: lengths of vessels are from corner to corner
constexpr double kSum = 1e-6;              // of flows: shares of cells are float32

/// A block of tissue with a vessel of 4 by 4 mm along x through its middle.
class Vessel : public ::testing::Test {
 protected:
  explicit Vessel(const std::string& fixed = "{shape: plane, point_m: [-0.019, 0, 0], normal: [1, 0, 0]}",
                  double calibre_m = 0)
      : model_(buildModel(parseScene("bodies: [{source: box, box_size_m: [0.04, 0.012, 0.012], spacing_m: 0.002, "
                                     "fixed: [" +
                                         fixed + "]}]",
                                     "vessel.yaml"))) {
    Body& body = model_.bodies[0];
    body.lattice.part_names = {"tissue", "artery"};
    for (const uint32_t cell : body.lattice.active_slots) {
      const Vector3d at = body.lattice.restPosition(cell);  // its lowest corner
      const auto isInside = [](double lowest_m) { return lowest_m > -0.0021 && lowest_m < 0.0019; };
      if (body.lattice.cell_labels[cell] != 0 && isInside(at.y()) && isInside(at.z()))
        body.lattice.cell_labels[cell] = 2;
    }
    PartConfig artery{"artery", 20e3, 0.25, 1060};
    artery.bleeding = {kFlow, calibre_m};
    body.parts = {artery};
  }
  Vector3d at(uint32_t slot) const { return restPosition(model_.bodies[0], slot); }
  using IsSo = std::function<bool(const Vector3d&)>;
  /// Returns the leaks of a cut. @param isOnOneSide  of the cut   @param isClosed, isInReach  of nodes; of the blade
  Vessels::Leaks cut(const IsSo& isOnOneSide, const IsSo& isClosed = {}, const IsSo& isInReach = {}) const {
    const HeatGraph graph(model_, 1);
    const Vessels vessels(model_, graph);
    std::vector<uint8_t> is_cut(graph.links.size()), is_closed(model_.slots(), 0);
    for (size_t i = 0; i < graph.links.size(); ++i) {
      const Vector3d a = at(graph.links[i].a), b = at(graph.links[i].b);
      is_cut[i] = isOnOneSide(a) != isOnOneSide(b) && (!isInReach || (isInReach(a) && isInReach(b)));
    }
    for (const uint32_t slot : vessels.nodes()) is_closed[slot] = isClosed && isClosed(at(slot));
    return vessels.find(is_cut, is_closed);
  }
  static double flow(const Vessels::Leaks& leaks) {
    double out = 0;
    for (const Vessels::Leak& leak : leaks.of_nodes) out += leak.m3_per_s / kMl_per_min;
    return out;
  }
  static bool isLeft(const Vector3d& at_m) { return at_m.x() < 0.001; }

  Model model_;
};

TEST_F(Vessel, ThatIsCutThroughBleedsOnTheSideThatIsHeld) {
  const Vessels::Leaks leaks = cut(isLeft);
  EXPECT_EQ(leaks.stumps, 1U);
  EXPECT_NEAR(flow(leaks), kFlow, kSum * kFlow);
  for (const Vessels::Leak& leak : leaks.of_nodes) EXPECT_NEAR(at(leak.slot).x(), 0, 1e-6);
}

TEST_F(Vessel, BesideWhichTissueIsCutDoesNotBleed) {
  EXPECT_EQ(cut([](const Vector3d& at_m) { return at_m.z() > 0.0025; }).of_nodes.size(), 0U);
  EXPECT_EQ(cut([](const Vector3d& at_m) { return at_m.z() > 0.0025 && at_m.x() < 0; }).of_nodes.size(), 0U);
}

TEST_F(Vessel, ThatIsCutObliquelyBleedsNoMore) {
  EXPECT_NEAR(flow(cut([](const Vector3d& at_m) { return at_m.x() + at_m.z() < 0.001; })), kFlow, kSum * kFlow);
}

TEST_F(Vessel, ThatIsNickedBleedsByWhatIsOpenOfItOnEitherSide) {
  const Vessels::Leaks leaks = cut(isLeft, {}, [](const Vector3d& at_m) { return at_m.z() > 0.001; });
  EXPECT_EQ(leaks.stumps, 1U);
  EXPECT_NEAR(flow(leaks), 2 * kFlow / 4, kNick * kFlow) << "half of the upper two of four cells, from both sides";
}

TEST_F(Vessel, IsClosedByAWholeLayerAndNotByHalfOfOne) {
  const auto isThere = [](const Vector3d& at_m) { return std::abs(at_m.x() + 0.01) < 0.0005; };
  EXPECT_EQ(cut(isLeft, isThere).stumps, 0U);
  EXPECT_NEAR(flow(cut(isLeft, [&](const Vector3d& at_m) { return isThere(at_m) && at_m.y() > -0.001; })), kFlow,
              kSum * kFlow);
  EXPECT_NEAR(flow(cut(isLeft, [](const Vector3d& at_m) { return std::abs(at_m.x() - 0.01) < 0.0005; })), kFlow,
              kSum * kFlow)
      << "beyond the cut";
}

TEST_F(Vessel, HasAGroupWhereItIs) {
  const HeatGraph graph(model_, 1);
  const Vessels vessels(model_, graph);
  for (const uint32_t slot : model_.bodies[0].lattice.active_slots) {
    const bool is_in = std::count(vessels.nodes().begin(), vessels.nodes().end(), slot) > 0;
    EXPECT_EQ(vessels.groupOf(slot).has_value(), is_in);
  }
}

/// Parts with another fluid are no part of a vessel; a part's fluid is that of its vessel.
TEST_F(Vessel, HasTheFluidOfItsParts) {
  const HeatGraph graph(model_, 1);
  model_.bodies[0].parts[0].bleeding.volume_ml = 40;
  EXPECT_TRUE(Vessels(model_, graph, Fluid::kBile).nodes().empty());
  PartConfig duct{"tissue", 20e3, 0.25, 1060};
  duct.bleeding = {kFlow, 0.003, Fluid::kBile, 0};
  model_.bodies[0].parts.push_back(duct);
  const Vessels blood(model_, graph), bile(model_, graph, Fluid::kBile);
  ASSERT_EQ(blood.supplies_m3().size(), 1U);
  EXPECT_DOUBLE_EQ(blood.supplies_m3()[0], 40e-6);
  EXPECT_EQ(bile.supplies_m3(), std::vector<double>{0}) << "any amount";
}

class LooseVessel : public Vessel {
 protected:
  LooseVessel() : Vessel("") {}
};

TEST_F(LooseVessel, BleedsOutOfItsLargestPiece) {
  const Vessels::Leaks leaks = cut([](const Vector3d& at_m) { return at_m.x() < 0.005; });
  EXPECT_EQ(leaks.stumps, 1U);
  EXPECT_NEAR(flow(leaks), kFlow, kSum * kFlow);
  for (const Vessels::Leak& leak : leaks.of_nodes) EXPECT_LT(at(leak.slot).x(), 0.005);
}

class WideVessel : public Vessel {
 protected:
  WideVessel() : Vessel("{shape: plane, point_m: [-0.019, 0, 0], normal: [1, 0, 0]}", 0.01) {}
};

TEST_F(WideVessel, GivesItsFlowByItsCalibre) {
  constexpr double kSection_m2 = 0.25 * 3.14159265358979323846 * 0.01 * 0.01;
  EXPECT_NEAR(flow(cut(isLeft)), kFlow * 1.6e-5 / kSection_m2, kSum * kFlow);
}

}  // namespace
}  // namespace viscera
