// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/tissue_points.h"

#include <gtest/gtest.h>

#include <random>

#include "support/lattices.h"
#include "support/networks.h"
#include "viscera/model/body/elasticity.h"

namespace viscera {
namespace {

constexpr double kSpacing_m = 0.003, kDt_s = 5e-4;
constexpr double kRounding = 1e-6;                // float32 of weights and positions, over their size
constexpr double kTissuePointsPosition_m = 1e-7;  // the same of a position
constexpr double kFound_m = 2e-6;                 // find() stops within kArrived of a spacing

/// A state of the tissue that tests set.
class Nodes : public TissuePort {
 public:
  explicit Nodes(const Model& model) : u(model.slots(), Vector3f::Zero()), v(u) {}
  void readNodes(const std::vector<uint32_t>& slots, std::vector<Vector3f>& u_m,
                 std::vector<Vector3f>& v_m_per_s) const override {
    most_read = std::max(most_read, slots.size());
    for (size_t i = 0; i < slots.size(); ++i) {
      u_m[i] = u[slots[i]];
      v_m_per_s[i] = v[slots[i]];
    }
  }
  void pushNodes(uint32_t stylus, float dt_s, const std::vector<uint32_t>& slots,
                 const std::vector<Vector3f>& dv_m_per_s) override {
    by = stylus;
    for (size_t i = 0; i < slots.size(); ++i) {
      v[slots[i]] += dv_m_per_s[i];
      u[slots[i]] += dt_s * dv_m_per_s[i];
    }
  }
  void selectBody(size_t) override {}
  void cutAtRest(const layout::ToolMotion&, bool) override {}
  std::vector<Vector3f> u, v;
  uint32_t by = 99;
  mutable size_t most_read = 0;
};

/// Maps a rest position: rotated and strained; a sheet keeps its thickness.
Vector3d mapped(const Vector3d& rest_m) {
  Eigen::Matrix3d by;
  by << 0.8, -0.5, 0.1, 0.6, 0.9, -0.1, 0.05, 0.1, 1.2;
  return by * rest_m + Vector3d(0.01, -0.02, 0.03);
}

void deform(const Model& model, Nodes& nodes) {
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    for (const uint32_t slot : model.bodies[b].lattice.active_slots) {
      const Vector3d rest = restPosition(model.bodies[b], slot);
      nodes.u[model.slotOffset(b) + slot] = (mapped(rest) - rest).cast<float>();
    }
  }
}

Vector3d middleOf(const Body& body) {
  Vector3d sum = Vector3d::Zero();
  for (const uint32_t slot : body.lattice.active_slots) sum += restPosition(body, slot);
  return sum / static_cast<double>(body.lattice.active_slots.size());
}

class OnStructures : public ::testing::TestWithParam<int> {
 protected:
  OnStructures() {
    Body bodies[] = {test::boxBody({6, 5, 4}, kSpacing_m), test::clothBody(7, 7, kSpacing_m)};
    Body other = test::boxBody({1, 1, 1}, kSpacing_m);
    other.lattice.origin_m = Vector3d::Constant(-0.03);
    model_ = test::modelOf({other, bodies[GetParam()]});
  }
  Model model_;
};

TEST_P(OnStructures, PointsFollowTheTissueAndAreFoundAgainWhereItIs) {
  Nodes nodes(model_);
  deform(model_, nodes);
  TissuePoints points(model_);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(-0.9, 0.9);
  const Vector3d middle = middleOf(model_.bodies[1]);
  const Vector3d half = GetParam() == 1 ? Vector3d(0.008, 0.008, 0) : Vector3d(0.006, 0.005, 0.004);
  for (int i = 0; i < 100; ++i) {
    const Vector3d rest = middle + half.cwiseProduct(Vector3d(share(random), share(random), share(random)));
    const auto point = points.embed(1, rest);
    ASSERT_TRUE(point) << rest.transpose();
    float sum = 0;
    for (uint32_t c = 0; c < point->count; ++c) sum += point->weights[c];
    EXPECT_NEAR(sum, 1, kRounding);
    points.read(nodes, {&*point});
    EXPECT_LT((points.position_m(*point) - mapped(rest)).norm(), kTissuePointsPosition_m);
    const auto again = points.find(nodes, mapped(rest));
    ASSERT_TRUE(again) << rest.transpose();
    EXPECT_EQ(again->body, 1U);
    EXPECT_LT((again->rest_m - rest).norm(), kFound_m);
  }
  EXPECT_LE(nodes.most_read, 256U);
  EXPECT_FALSE(points.embed(1, middle + Vector3d(0.1, 0, 0)));
  EXPECT_FALSE(points.find(nodes, mapped(middle + Vector3d(0, 0, 0.02))));
}

TEST_P(OnStructures, ImpulsesMoveThemByTheirMobilityAndKeepMomentum) {
  Nodes nodes(model_);
  TissuePoints points(model_);
  const Vector3d middle = middleOf(model_.bodies[1]), impulse(1e-6, 2e-6, -3e-6);
  const auto one = points.embed(1, middle), other = points.embed(1, middle + Vector3d(0.001, 0, 0));
  ASSERT_TRUE(one && other);
  points.read(nodes, {&*one, &*other});
  const Vector3d before = points.position_m(*other);
  points.give(*one, impulse, kDt_s);
  const Vector3d dv = points.mobility(*one, *other) * impulse;
  EXPECT_GT(dv.norm(), 0);
  EXPECT_LT((points.velocity_m_per_s(*other) - dv).norm(), kRounding * dv.norm());
  EXPECT_LT((points.position_m(*other) - before - kDt_s * dv).norm(), kRounding * kDt_s * dv.norm() + 1e-15);
  points.write(nodes, layout::kMaxStyluses, kDt_s);
  EXPECT_EQ(nodes.by, layout::kMaxStyluses);
  const Body& body = model_.bodies[1];
  Vector3d momentum = Vector3d::Zero();
  for (const uint32_t slot : body.lattice.active_slots) {
    const bool lattice = GetParam() == 0;
    const double kg = lattice ? static_cast<double>(strengths(body).mass_kg[slot]) : body.network->masses_kg[slot];
    momentum += kg * nodes.v[model_.slotOffset(1) + slot].cast<double>();
  }
  EXPECT_LT((momentum - impulse).norm(), kRounding * impulse.norm());
}

std::string structureSuffix(const ::testing::TestParamInfo<int>& info) {
  constexpr const char* kNames[] = {"lattice", "sheet"};
  return kNames[info.param];
}
INSTANTIATE_TEST_SUITE_P(TissuePoints, OnStructures, ::testing::Values(0, 1), structureSuffix);

TEST(TissuePoints, BesideACutAreCarriedByWholeCellsOfTheirSide) {
  const Model model = test::modelOf({test::boxBody({6, 4, 4}, kSpacing_m)});
  Body cut = model.bodies[0];
  test::slit(cut, 0, 2, 0);  // between the third layer of nodes and the fourth
  Nodes nodes(model);
  for (const uint32_t slot : cut.lattice.active_slots) {
    if (restPosition(cut, slot).x() > 2.5 * kSpacing_m) nodes.u[slot] = {0.01f, 0, 0};
  }
  TissuePoints points(model);
  CutSprings cuts;
  cuts.nodes = cut.lattice.nodes;
  points.setCuts(cuts);
  for (const double x : {1.2, 2.2, 2.45, 2.55, 2.8, 3.4}) {
    const Vector3d rest = kSpacing_m * Vector3d(x, 2.3, 1.7);
    const auto point = points.embed(0, rest);
    ASSERT_TRUE(point) << x;
    points.read(nodes, {&*point});
    const Vector3d moved(x > 2.5 ? 0.01 : 0, 0, 0);
    EXPECT_LT((points.position_m(*point) - rest - moved).norm(), kTissuePointsPosition_m) << x;
    const auto again = points.find(nodes, rest + moved);
    ASSERT_TRUE(again) << x;
    EXPECT_LT((again->rest_m - rest).norm(), kFound_m) << x;
  }
  EXPECT_FALSE(points.find(nodes, kSpacing_m * Vector3d(2.5, 2, 2) + Vector3d(0.005, 0, 0)));  // in the wound
}

}  // namespace
}  // namespace viscera
