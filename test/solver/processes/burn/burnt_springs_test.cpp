// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Coagulated springs together with fresh ones, stepped by a target of the test: how short tissue becomes, and how
// stiff.
#include "solver/processes/burn/burnt_springs.h"
#include "viscera/model/scene/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace viscera {
namespace {

constexpr double kLength = 2e-3;     // of a length: float32 positions, and remaining oscillation
constexpr double kStiffness = 1e-2;  // of a stiffness, between stretches of a hundredth: springs are not linear
constexpr double kDone = 20;         // dose at which tissue is fully coagulated

/// Fresh springs, stepped by leapfrog with drag.
class Stepped : public TissuePort {
 public:
  explicit Stepped(const Model& model)
      : graph_(model, HeatConstants{}.conductivity_w_per_m_k),
        u_(model.slots(), Vector3d::Zero()),
        v_(u_),
        pulls_(u_),
        model_(model) {
    double rate = 0;
    std::vector<double> sums(model.slots(), 0);
    for (const BurntSpring& s : graph_.springs) {
      sums[s.a] += s.stiffness_n_per_m;
      sums[s.b] += s.stiffness_n_per_m;
    }
    for (size_t i = 0; i < sums.size(); ++i)
      if (graph_.mass_kg[i] > 0) rate = std::max(rate, 2 * sums[i] / graph_.mass_kg[i]);
    dt_s = 0.8 * 2 / std::sqrt(rate);
  }
  Vector3d at(uint32_t slot) const { return restPosition(model_.bodies[0], slot) + u_[slot]; }
  void pullEnds(double force_n) {
    double end_kg = 0;
    for (int pass = 0; pass < 2; ++pass) {
      for (uint32_t i = 0; i < u_.size(); ++i) {
        const double x = restPosition(model_.bodies[0], i).x();
        if (graph_.mass_kg[i] <= 0 || std::abs(x) < 0.006 - 1e-6) continue;
        if (pass == 0) end_kg += 0.5 * graph_.mass_kg[i];
        if (pass == 1) pulls_[i].x() = std::copysign(force_n, x) * graph_.mass_kg[i] / end_kg;
      }
    }
  }
  bool has(uint32_t slot) const { return graph_.mass_kg[slot] > 0; }
  void substep() {
    std::vector<Vector3d> f = forces();
    for (uint32_t i = 0; i < u_.size(); ++i) {
      if (graph_.mass_kg[i] <= 0) continue;
      v_[i] = kDrag * (v_[i] + dt_s * f[i] / graph_.mass_kg[i]);
      u_[i] += dt_s * v_[i];
    }
  }
  std::vector<Vector3d> forces() const {
    std::vector<Vector3d> f = pulls_;
    for (const BurntSpring& s : graph_.springs) {
      const Vector3d direction = at(s.b) - at(s.a);
      const Vector3d force = s.stiffness_n_per_m * (direction.norm() - s.rest_length_m) * direction.normalized();
      f[s.a] += force;
      f[s.b] -= force;
    }
    return f;
  }
  void readNodes(const std::vector<uint32_t>& slots, std::vector<Vector3f>& u,
                 std::vector<Vector3f>& v) const override {
    for (size_t i = 0; i < slots.size(); ++i) {
      u[i] = u_[slots[i]].cast<float>();
      v[i] = v_[slots[i]].cast<float>();
    }
  }
  void pushNodes(uint32_t, float dt, const std::vector<uint32_t>& slots, const std::vector<Vector3f>& dv) override {
    given_ns.assign(u_.size(), Vector3d::Zero());
    for (size_t i = 0; i < slots.size(); ++i) {
      given_ns[slots[i]] = graph_.mass_kg[slots[i]] * dv[i].cast<double>();
      v_[slots[i]] += dv[i].cast<double>();
      u_[slots[i]] += dt * dv[i].cast<double>();
    }
  }
  void selectBody(size_t) override {}
  void cutAtRest(const layout::ToolMotion&, bool) override {}

  double dt_s = 0;
  std::vector<Vector3d> given_ns;

 private:
  static constexpr double kDrag = 0.98;
  HeatGraph graph_;
  std::vector<Vector3d> u_, v_, pulls_;
  const Model& model_;
};

Model blockOf(const std::string& structure) {
  return buildModel(parseScene("bodies: [{source: box, structure: " + structure +
                                   ", box_size_m: [0.012, 0.006, 0.006], spacing_m: 0.002, "
                                   "material: {young_modulus_pa: 10000}}]",
                               "burnt.yaml"));
}

HeatField coagulated(const Model& model) {
  HeatConstants constants;
  constants.perfusion_per_s = constants.air_w_per_m2_k = 0;
  HeatField heat(model, constants);
  for (uint32_t slot = 0; slot < model.slots(); ++slot)
    if (heat.graph().mass_kg[slot] > 0) heat.give(slot, 50 * constants.heat_j_per_kg_k * heat.graph().mass_kg[slot]);
  for (int t = 0; t < 600 && heat.coagulated(0) < 1 - std::exp(-kDone); ++t) heat.step(0.01);
  return heat;
}

/// Returns the length between the outermost nodes.
double lengthOf(const Model& model, const Stepped& stepped, int axis) {
  double low = 1, high = -1;
  for (uint32_t slot = 0; slot < model.slots(); ++slot) {
    if (!stepped.has(slot)) continue;
    low = std::min(low, stepped.at(slot)[axis]);
    high = std::max(high, stepped.at(slot)[axis]);
  }
  return high - low;
}

TEST(BurntSprings, FreeTissueShrinksEvenlyByItsShare) {
  for (const std::string structure : {"lattice", "explicit"}) {
    SCOPED_TRACE(structure);
    const Model model = blockOf(structure);
    const HeatField heat = coagulated(model);
    Stepped stepped(model);
    BurntSprings burnt(model);
    burnt.find(heat, {});
    for (int i = 0; i < 3000; ++i) {
      stepped.substep();
      burnt.pull(stepped, stepped.dt_s);
    }
    const double left = 1 - BurntSprings::kShrunk;
    EXPECT_NEAR(lengthOf(model, stepped, 0), left * 0.012, kLength * 0.012);
    EXPECT_NEAR(lengthOf(model, stepped, 1), left * 0.006, kLength * 0.006);
    EXPECT_NEAR(lengthOf(model, stepped, 2), left * 0.006, kLength * 0.006);
  }
}

TEST(BurntSprings, TakeNoMomentum) {
  const Model model = blockOf("lattice");
  const HeatField heat = coagulated(model);
  Stepped stepped(model);
  BurntSprings burnt(model);
  burnt.find(heat, {});
  burnt.pull(stepped, stepped.dt_s);
  Vector3d sum = Vector3d::Zero();
  double size = 0;
  for (const Vector3d& given : stepped.given_ns) {
    sum += given;
    size += given.norm();
  }
  EXPECT_GT(size, 0);
  EXPECT_LT(sum.norm(), 1e-6 * size) << "float32";
}

/// Returns the length of a bar in tension.
double lengthUnder(const Model& model, BurntSprings* burnt, double force_n) {
  Stepped stepped(model);
  stepped.pullEnds(force_n);
  for (int n = 0; n < 4000; ++n) {
    stepped.substep();
    if (burnt) burnt->pull(stepped, stepped.dt_s);
  }
  return lengthOf(model, stepped, 0);
}

TEST(BurntSprings, CoagulatedTissueIsStifferByItsFactor) {
  const Model model = blockOf("lattice");
  const HeatField heat = coagulated(model);
  BurntSprings burnt(model);
  burnt.find(heat, {});
  const double force_n = 0.004;
  const double fresh_m = lengthUnder(model, nullptr, force_n) - lengthUnder(model, nullptr, 0);
  const double stiff_m = lengthUnder(model, &burnt, force_n) - lengthUnder(model, &burnt, 0);
  EXPECT_GT(fresh_m, 1e-4);
  EXPECT_NEAR(fresh_m / stiff_m, BurntSprings::kStiffened, kStiffness * BurntSprings::kStiffened);
}

TEST(BurntSprings, CutOnesPullNoMore) {
  const Model model = blockOf("lattice");
  const HeatField heat = coagulated(model);
  BurntSprings burnt(model);
  CutSprings cuts;
  cuts.nodes.resize(model.slots());  // no spring is left
  burnt.find(heat, cuts);
  EXPECT_TRUE(burnt.empty());
}

}  // namespace
}  // namespace viscera
