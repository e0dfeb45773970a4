// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulator/status_screen.h"

#include <gtest/gtest.h>

#include <sstream>

#include "nodes/input/stylus_mailbox.h"

namespace viscera::nodes {
namespace {

ReceivedStatus simulation(const std::string& node, double age_s) {
  return {node, "simulation", 0, "running", {{"tick", "1234"}, {"stepped_by", "cpu, leapfrog"}}, age_s};
}

std::vector<ReceivedStatus> session() {
  return {{"simulator",
           "left",
           1,
           "messages are dropped",
           {{"poses_accepted", "12"},
            {"has_publisher", "True"},
            {"device", "crtk"},
            {"input_age_s", "0.25"},
            {"force_n", "0.53"},
            {"force_saturated", "True"},
            {"nodes_touched", "7"},
            {"nodes_held", "3"},
            {"haptic_rate_hz", "998"},
            {"dropped_no_transform", "41"},
            {"dropped_delayed", "0"}},
           0.3},
          {"simulator",
           "pace",
           0,
           "real time",
           {{"real_time_factor", "0.98"},
            {"step_mean_ms", "4.2"},
            {"step_max_ms", "9.1"},
            {"surface_rate_hz", "29.97"},
            {"image_rate_hz_camera", "0"}},
           0.3},
          {"simulator",
           "right",
           0,
           "no pose yet",
           {{"poses_accepted", "0"}, {"has_publisher", "False"}, {"device", "polhemus"}},
           0.3},
          simulation("simulator", 0.3)};
}

void expectSays(const std::string& screen, const std::string& words) {
  EXPECT_NE(screen.find(words), std::string::npos) << "'" << words << "' in:\n" << screen;
}

TEST(StatusScreen, ReportsPaceRatesStylusesForcesAndWhyPosesWereDropped) {
  StatusView view;
  view.columns = 200;  // no line is wrapped
  const std::string screen = statusScreen(session(), view);
  expectSays(screen, "simulator, heard 0.3 s ago");
  expectSays(screen, "running, tick 1234, stepped by cpu, leapfrog");
  expectSays(screen, "0.98 of real time: a step takes 4.2 ms, 9.1 ms at most");
  expectSays(screen, "surface and markers 30 /s, pictures of camera 0 /s (topics without a subscriber are not made)");
  expectSays(screen, "messages are dropped; force 0.53 N (the limit); touches 7 nodes, holds 3; 998 forces/s;");
  expectSays(screen, "41 messages dropped since the start, no_transform: tf does not connect the frame");
  EXPECT_EQ(screen.find("delayed"), std::string::npos) << screen;
  expectSays(screen, "no device: no poses arrive (polhemus)");
  expectSays(screen, "WARNING     left: messages are dropped");
  EXPECT_EQ(screen.find("nothing"), std::string::npos) << screen;
}

TEST(StatusScreen, SaysThatNothingIsWrong) {
  const std::vector<ReceivedStatus> reports{simulation("simulator", 0.5)};
  expectSays(statusScreen(reports, {}), "wrong       nothing");
  EXPECT_TRUE(isSimulatorKnown(reports, {}));
}

TEST(StatusScreen, SaysThatThereIsNoSimulator) {
  StatusView view;
  view.master_uri = "http://lab:11311";
  EXPECT_EQ(statusScreen({}, view), "waiting for /diagnostics of a simulator\n");
  view.watched_s = kSilent_s;
  const std::string screen = statusScreen({}, view);
  expectSays(screen, "no simulator");
  expectSays(screen, "no /diagnostics for 3 s");
  expectSays(screen, "http://lab:11311");
  expectSays(screen, "roslaunch viscera training.launch");
  EXPECT_FALSE(isSimulatorKnown({}, view));
  expectSays(statusScreen({{"camera_driver", "rate", 0, "", {}, 0}}, view), "nodes that send /diagnostics: camera_d");
}

TEST(StatusScreen, SaysThatASimulatorHasFallenSilent) {
  const std::vector<ReceivedStatus> reports{simulation("simulator", 7.5)};
  const std::string screen = statusScreen(reports, {});
  expectSays(screen, "heard 7.5 s ago");
  expectSays(screen, "it is silent");
  EXPECT_EQ(screen.find("nothing"), std::string::npos) << screen;
  EXPECT_FALSE(isSimulatorKnown(reports, {}));
}

TEST(StatusScreen, ShowsTheSimulatorThatIsAskedFor) {
  const std::vector<ReceivedStatus> reports{simulation("a/simulator", 0), simulation("b/simulator", 0)};
  StatusView view;
  expectSays(statusScreen(reports, view), "a/simulator,");
  expectSays(statusScreen(reports, view), "b/simulator,");
  view.simulator = "b/simulator";
  EXPECT_EQ(statusScreen(reports, view).find("a/simulator,"), std::string::npos);
}

TEST(StatusScreen, KeepsToTheColumnsAndMovesNoCursor) {
  StatusView view;
  view.columns = 60;
  std::vector<ReceivedStatus> reports = session();
  reports[0].message = "\033[2Jevil";
  const std::string screen = statusScreen(reports, view);
  expectSays(screen, "\\x1b[2Jevil");
  std::istringstream in(screen);
  for (std::string line; std::getline(in, line);) EXPECT_LE(line.size(), view.columns) << line;
}

TEST(StatusScreen, KnowsEveryReasonOfDropping) {
  for (size_t i = 0; i < kDropReasons; ++i) {
    const char* reason = text(static_cast<Drop>(i));
    EXPECT_FALSE(meaningOfDrop(reason).empty()) << reason;
  }
}

}  // namespace
}  // namespace viscera::nodes
