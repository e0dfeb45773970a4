// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// The laws of docs/physics.md 13; `viscera bench suture` measures more of them.
#include <gtest/gtest.h>

#include "bench/suites/suture/suture_trials.h"
#include "bench/suites/suture/tearing_trial.h"
#include "bench/suites/suture/track_trials.h"

namespace viscera::bench {
namespace {

constexpr double kBent = 0.02, kSag = 0.005, kTension = 0.01, kCapstan = 0.05, kSutureSuiteRipple = 0.03, kLink = 1e-3,
                 kMomentum = 1e-6;

TEST(SutureSuite, BendsAsAnElastica) {
  struct Known {
    double load, across;
  };
  for (const Known known : {Known{1, 0.30172}, {2, 0.49346}, {3, 0.60325}, {5, 0.71379}, {10, 0.81061}})
    EXPECT_NEAR(bentByForce(known.load, 40).across, known.across, kBent * known.across);
  EXPECT_NEAR(bentByMoment(0.25, 60), 0.25, kBent * 0.25);
  EXPECT_NEAR(bentByMoment(1, 60), 1, kBent);
}

TEST(SutureSuite, HangsAsACatenary) {
  const CatenaryTrial hung = hungUp(0.12, 101);
  EXPECT_NEAR(hung.sag, hung.exact_sag, kSag * hung.exact_sag);
  EXPECT_NEAR(hung.tension, hung.exact_tension, kTension * hung.exact_tension);
}

TEST(SutureSuite, SlidesAsOverACapstan) {
  for (const double angle_deg : {90.0, 180.0, 360.0}) EXPECT_NEAR(drawnOverCylinder(angle_deg), 1, kCapstan);
}

TEST(SutureSuite, SlidesThroughTracksAsOverACapstan) {
  for (const double share : {1e-3, 1.0}) {
    for (const size_t count : {1, 2, 4}) {
      const TrackTrial drawn = drawnThroughTracks(count, share, 0.1);
      EXPECT_NEAR(drawn.ratio, 1, kCapstan) << count << " channels, " << share;
      EXPECT_LT(drawn.ripple, kSutureSuiteRipple) << count << " channels, " << share;
    }
  }
}

TEST(SutureSuite, KeepsItsMomentumAndThatOfTissue) {
  const TissueTrial thrown = thrownThroughTissue();
  EXPECT_LT(thrown.momentum, kMomentum);
  EXPECT_LT(thrown.off_m, 1e-3);
}

TEST(SutureSuite, KnotsHoldAndSlip) {
  const KnotTrial pulled = pulledKnot();
  EXPECT_LT(pulled.moved, 0.01);
  EXPECT_NEAR(pulled.slips, 1, kCapstan);
  EXPECT_LT(pulled.worst_link, kLink);
}

TEST(SutureSuite, DoesNotStretch) {
  for (const double force_n : {0.01, 20.0}) {
    const PullTrial pulled = pulledBy(force_n);
    EXPECT_LT(pulled.worst_link, kLink);
    EXPECT_NEAR(pulled.tension, 1, kTension);
    EXPECT_LT(pulled.iterations, 1.5);
  }
}

TEST(SutureSuite, KeepsItsMomentum) {
  const FlightTrial flight = thrown();
  EXPECT_LT(flight.momentum, kMomentum);
  EXPECT_LT(flight.worst_link, kLink);
}

TEST(SutureSuite, StaysWholeAndOutsideWhateverAToolDoes) {
  const StressTrial drawn = drawnAbout(2, 0.1);
  EXPECT_EQ(drawn.nonfinite, 0);
  EXPECT_EQ(drawn.bad, 0);
  EXPECT_LT(drawn.most_force_n, 1.06 * 20);
  EXPECT_LT(drawn.deepest_m, 1e-4);
}

TEST(SutureSuite, TearsOutOfTissueWhateverAToolDoes) {
  constexpr double kSeconds = 4, kOneTrack = 1.5;  // duration [s]; distance [links] below which two tracks are one
  const TearingTrial torn = tornOut(kSeconds, 1e3, 1);
  EXPECT_EQ(torn.trips, 0);
  EXPECT_EQ(torn.nonfinite, 0);
  EXPECT_GT(torn.torn, 0);
  EXPECT_GT(torn.springs, 0);
  EXPECT_LT(torn.off, kLink * torn.substeps);
  EXPECT_GE(torn.nearest_links, kOneTrack);  // tracks that come closer are one
  EXPECT_EQ(tornOut(kSeconds, 1e3, 2).hash, torn.hash);
}

}  // namespace
}  // namespace viscera::bench
