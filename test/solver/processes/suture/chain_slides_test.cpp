// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Channels; their law of friction is in test/bench/suture_suite_test.cpp.
#include "solver/processes/suture/chain/chain_slides.h"

#include <gtest/gtest.h>

#include <limits>

#include "solver/processes/suture/chain/chain.h"

namespace viscera {
namespace {

constexpr double kChainSlidesSubstep_s = 5e-4, kChainSlidesLink_m = 5e-4;
constexpr double kLimit = 1.06;                 // of a limit: iterations end 5 % above
constexpr double kChainSlidesMomentum = 1e-12;  // of the impulses between suture and tissue

ChainMaterial soft() {
  ChainMaterial out;
  out.bending_nm2 = 4e-9;
  out.mass_damping_per_s = 20;
  return out;
}

std::vector<Vector3d> alongX(size_t nodes) {
  std::vector<Vector3d> out;
  for (size_t i = 0; i < nodes; ++i) out.emplace_back(static_cast<double>(i) * kChainSlidesLink_m, 0, 0);
  return out;
}

ChainSlide trackAt(double s) {
  ChainSlide out;
  out.s = s;
  out.to_m = Vector3d(s * kChainSlidesLink_m, 0, 0);
  return out;
}

ChainHold held(const Chain& chain, uint32_t node) {
  ChainHold out;
  out.node = node;
  out.to_m = chain.positions_m()[node];
  return out;
}

/// Tissue that is one free mass at each channel.
struct FreeMasses {
  FreeMasses(ChainAround& around, double mass_kg) : mass_kg(mass_kg) {
    for (ChainSlide& slide : around.slides) {
      slide.mass_kg = mass_kg;
      positions.push_back(slide.to_m);
    }
    speeds.assign(positions.size(), Vector3d::Zero());
    given = speeds;
    around.answer = [this](std::vector<ChainSlide>& slides) {
      for (size_t k = 0; k < slides.size(); ++k) {
        speeds[k] += (slides[k].impulse_ns - given[k]) / this->mass_kg;
        given[k] = slides[k].impulse_ns;
        slides[k].to_m = positions[k] + kChainSlidesSubstep_s * speeds[k];
      }
    };
  }
  void begin(std::vector<ChainSlide>& slides) {
    for (size_t k = 0; k < slides.size(); ++k) slides[k].to_m = positions[k] + kChainSlidesSubstep_s * speeds[k];
    given.assign(given.size(), Vector3d::Zero());
  }
  void end() {
    for (size_t k = 0; k < positions.size(); ++k) positions[k] += kChainSlidesSubstep_s * speeds[k];
  }
  double mass_kg;
  std::vector<Vector3d> positions, speeds, given;
};

TEST(ChainSlides, KeepTheMomentumOfSutureAndTissue) {
  ChainMaterial dragless = soft();
  dragless.mass_damping_per_s = 0;
  Chain chain(dragless, alongX(80));
  std::vector<Vector3d> speeds(chain.nodes());
  for (size_t i = 0; i < speeds.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(speeds.size());
    speeds[i] = Vector3d(0.3, std::sin(9 * share), std::cos(5 * share));
  }
  chain.setVelocities(speeds);
  ChainAround around;
  for (const double s : {20.3, 37.0, 55.8}) {
    around.slides.push_back(trackAt(s));
    around.slides.back().friction = 0.3;
    around.slides.back().through_n = 0.001;
    around.slides.back().most_n = 0.05;
  }
  FreeMasses tissue(around, 2e-5);
  const auto momentum = [&] {
    Vector3d out = Vector3d::Zero();
    for (size_t i = 0; i < chain.nodes(); ++i) out += chain.mass_kg(i) * chain.velocities_m_per_s()[i];
    for (const Vector3d& speed : tissue.speeds) out += tissue.mass_kg * speed;
    return out;
  };
  Vector3d first = Vector3d::Zero();
  double tissue_speed = 0, off_m = 0, exchanged = 0;
  for (int k = 0; k < 1000; ++k) {
    if (k == 3) first = momentum();  // speeds that its links permit
    tissue.begin(around.slides);
    chain.step(kChainSlidesSubstep_s, around);
    tissue.end();
    for (size_t c = 0; c < 3; ++c) {
      tissue_speed = std::max(tissue_speed, tissue.speeds[c].norm());
      const ChainPoint point(around.slides[c].s, chain.nodes());
      if (!around.slides[c].out) off_m = std::max(off_m, (point.of(chain.positions_m()) - tissue.positions[c]).norm());
      tissue.positions[c] += around.slides[c].torn_m;
      exchanged += around.slides[c].impulse_ns.norm();
    }
  }
  EXPECT_LT((momentum() - first).norm(), kChainSlidesMomentum * exchanged);
  EXPECT_GT(tissue_speed, 1e-3);
  EXPECT_LT(off_m, 1e-3);
}

/// Next to the tail of a needle the chain cannot yield: the tissue moves back, on a spring in this test.
TEST(ChainSlides, LeaveTheTailOfANeedleThatGoesOn) {
  constexpr double kSpring_n_per_m = 60, kDamping_per_s = 200, kVelocity_m_per_s = 0.05, kTissue_kg = 6.8e-5;
  constexpr int kSubsteps = 400;
  Chain chain(soft(), alongX(80));
  ChainAround around;
  around.swaged[0] = true;
  around.holds.push_back(held(chain, 0));
  around.slides.push_back(trackAt(0.0131));
  around.slides[0].friction = 0.1;
  around.slides[0].through_n = 0.001;
  around.slides[0].most_n = 0.27;
  FreeMasses tissue(around, kTissue_kg);
  around.slides[0].mass_kg = 0.7 * kTissue_kg;  // effective mass of the tissue below its actual one
  const Vector3d home_m = tissue.positions[0] + Vector3d(0, 0, -0.006);  // as if it had been dragged along so far
  for (int k = 0; k < kSubsteps; ++k) {
    tissue.speeds[0] += kChainSlidesSubstep_s * (kSpring_n_per_m / kTissue_kg * (home_m - tissue.positions[0]) -
                                                 kDamping_per_s * tissue.speeds[0]);
    around.holds[0].to_m += kChainSlidesSubstep_s * kVelocity_m_per_s * Vector3d(-1, 0, 0.5);
    tissue.begin(around.slides);
    chain.step(kChainSlidesSubstep_s, around);
    tissue.end();
  }
  EXPECT_LT((tissue.positions[0] - home_m).norm(), 2e-4);
  EXPECT_GT(around.slides[0].s * kChainSlidesLink_m, 0.8 * kSubsteps * kChainSlidesSubstep_s * kVelocity_m_per_s);
  EXPECT_FALSE(around.slides[0].out);
}

TEST(ChainSlides, HoldASutureThatIsPulledByLessThanTheirFriction) {
  for (const double pull_n : {0.045, 0.06}) {
    Chain chain(soft(), alongX(80));
    ChainAround around;
    around.slides = {trackAt(30.4), trackAt(45.2)};
    for (ChainSlide& slide : around.slides) slide.through_n = 0.025;
    for (int k = 0; k < 140; ++k) {
      around.loads = {{79, Vector3d(pull_n * std::min(1.0, k / 100.0), 0, 0)}};
      chain.step(kChainSlidesSubstep_s, around);
    }
    if (pull_n < 0.05) {
      EXPECT_NEAR(around.slides[1].s, 45.2, 1e-2);
      EXPECT_NEAR((around.slides[0].impulse_ns + around.slides[1].impulse_ns).x() / kChainSlidesSubstep_s, pull_n,
                  1e-3 * pull_n);
    } else {
      EXPECT_LT(around.slides[1].s, 45.2 - 1);
    }
  }
}

TEST(ChainSlides, TearAtWhatTheirTissueBearsAndSayByHowMuch) {
  constexpr double kMost_n = 0.5;
  Chain chain(soft(), alongX(80));
  ChainAround around;
  around.holds = {held(chain, 0), held(chain, 79)};
  around.slides = {trackAt(40.5)};
  around.slides[0].most_n = kMost_n;
  const Vector3d offset(0, 0, 0.05 * kChainSlidesSubstep_s);
  Vector3d torn = Vector3d::Zero();
  for (int k = 0; k < 200; ++k) {
    around.slides[0].to_m += offset;  // the suture is straight: it cannot follow
    chain.step(kChainSlidesSubstep_s, around);
    torn += around.slides[0].torn_m;
    around.slides[0].to_m += around.slides[0].torn_m;
  }
  EXPECT_NEAR(around.slides[0].impulse_ns.norm() / kChainSlidesSubstep_s, kMost_n, (kLimit - 1) * kMost_n);
  EXPECT_NEAR((torn + 200 * offset).z(), 0, 2e-3);
  EXPECT_LT(torn.z(), -3e-3);
}

TEST(ChainSlides, LetAnEndPassOutAndThenDoNothing) {
  Chain chain(soft(), alongX(40));
  ChainAround around;
  around.slides = {trackAt(2.5), trackAt(20.5)};
  around.slides[0].friction = around.slides[1].friction = 0.2;
  around.holds = {held(chain, 39)};
  int left = 0;
  for (int k = 0; k < 400 && !around.slides[1].out; ++k) {
    around.holds[0].to_m.x() += 0.1 * kChainSlidesSubstep_s;
    chain.step(kChainSlidesSubstep_s, around);
    if (around.slides[0].out && left++ > 0) {
      EXPECT_EQ(around.slides[0].impulse_ns.norm(), 0);
    }
  }
  EXPECT_TRUE(around.slides[1].out);
  EXPECT_GT(left, 100);
  EXPECT_LT(chain.worstLink(), 1e-3);
}

TEST(ChainSlides, LetNothingSlideOffAnEndThatIsSwaged) {
  Chain chain(soft(), alongX(40));
  ChainAround around;
  around.slides = {trackAt(2.5)};
  around.swaged = {true, false};
  around.holds = {held(chain, 39)};
  around.holds[0].most_n = 1;
  for (int k = 0; k < 100; ++k) {
    around.holds[0].to_m.x() += 0.1 * kChainSlidesSubstep_s;
    chain.step(kChainSlidesSubstep_s, around);
  }
  EXPECT_FALSE(around.slides[0].out);
  EXPECT_GT(around.slides[0].s, 0);
  EXPECT_NEAR(around.slides[0].impulse_ns.norm() / kChainSlidesSubstep_s, 1, kLimit - 1);
}

TEST(ChainSlides, KeepTheirOrderAndDistance) {
  constexpr double kRest_m = 4e-3;
  Chain chain(soft(), alongX(80));
  ChainAround around;
  around.slides = {trackAt(30), trackAt(38), trackAt(39.5)};
  around.slides[0].between_rest_m = kRest_m;
  around.slides[1].through_n = around.slides[2].through_n = 1;
  around.loads = {{0, Vector3d(-0.01, 0, 0)}};
  for (int k = 0; k < 200; ++k) {
    around.slides[0].to_m.x() += 0.2 * kChainSlidesSubstep_s;  // slides along the suture, up to the next
    chain.step(kChainSlidesSubstep_s, around);
    EXPECT_GT(around.slides[1].s - around.slides[0].s, 0.4 * kRest_m / kChainSlidesLink_m - 1e-2);
    EXPECT_GT(around.slides[2].s - around.slides[1].s, 1 - 1e-2);
  }
}

/// A tear is reported once: a rejected substep tears nothing, gives no impulses, and changes nothing.
TEST(ChainSlides, NothingIsTornOrGivenWhereThereIsNoSolution) {
  Chain chain(soft(), alongX(80));
  ChainAround around;
  around.holds = {held(chain, 0), held(chain, 79)};
  around.slides = {trackAt(40.5)};
  around.slides[0].most_n = 0.5;
  Vector3d given = Vector3d::Zero();
  around.answer = [&given](std::vector<ChainSlide>& slides) { given = slides[0].impulse_ns; };
  for (int k = 0; k < 200; ++k) {
    around.slides[0].to_m.z() += 0.05 * kChainSlidesSubstep_s;
    chain.step(kChainSlidesSubstep_s, around);
  }
  ASSERT_FALSE(chain.waited());
  ASSERT_FALSE(around.slides[0].torn_m.isZero(0));
  ASSERT_FALSE(given.isZero(0));
  const std::vector<Vector3d> positions = chain.positions_m();
  const double s = around.slides[0].s;
  around.holds[0].to_m.setConstant(std::numeric_limits<double>::quiet_NaN());
  chain.step(kChainSlidesSubstep_s, around);
  EXPECT_TRUE(chain.waited());
  EXPECT_EQ(chain.positions_m(), positions);
  EXPECT_EQ(around.slides[0].s, s);
  EXPECT_TRUE(around.slides[0].torn_m.isZero(0));
  EXPECT_TRUE(around.holds[0].impulse_ns.isZero(0));
  EXPECT_TRUE(given.isZero(0));
}

}  // namespace
}  // namespace viscera
