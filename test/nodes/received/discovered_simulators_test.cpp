// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/received/discovered_simulators.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace viscera::received {
namespace {

using std::chrono::seconds;

void tell(DiscoveredSimulators& found, DiscoveredSimulators::Time now, const std::string& name,
          const std::string& message, int level, const std::vector<std::pair<std::string, std::string>>& values) {
  diagnostic_msgs::DiagnosticArray array;
  array.status.resize(1);
  array.status[0].name = name;
  array.status[0].message = message;
  array.status[0].level = static_cast<int8_t>(level);
  for (const auto& [key, value] : values) {
    array.status[0].values.emplace_back();
    array.status[0].values.back().key = key;
    array.status[0].values.back().value = value;
  }
  found.take(array, now);
}

TEST(DiscoveredSimulators, PartsOfANodeAreOneSimulator) {
  DiscoveredSimulators found;
  const DiscoveredSimulators::Time now{};
  tell(found, now, "left/simulator: simulation", "paused", 0,
       {{"scene", "heart"}, {"tick", "7"}, {"paused", "True"}, {"recording", "/tmp/a.viscera"}});
  tell(found, now, "left/simulator: pace", "slower than real time", 1, {{"real_time_factor", "0.5"}});
  tell(found, now, "left/simulator: probe", "tracked", 0,
       {{"poses_accepted", "1"}, {"idle", "probe"}, {"button1", "grab"}, {"button2", "cut"}, {"force_n", "1.5"}});
  tell(found, now, "camera_driver: lens", "dirty", 1, {});
  tell(found, now, "no colon", "", 2, {});
  ASSERT_EQ(found.at(now).size(), 1U);
  const DiscoveredSimulator simulator = found.at(now)[0];
  EXPECT_EQ(simulator.node, "/left/simulator");
  EXPECT_EQ(simulator.space(), "/left/");
  EXPECT_EQ(simulator.scene, "heart");
  EXPECT_TRUE(simulator.paused);
  EXPECT_EQ(simulator.real_time_factor, "0.5");
  EXPECT_EQ(simulator.warnings, std::vector<std::string>{"pace: slower than real time"});
  ASSERT_EQ(simulator.styluses.size(), 1U);
  EXPECT_EQ(simulator.styluses[0].modes[2], "cut");
  EXPECT_EQ(simulator.styluses[0].state, "tracked");
  EXPECT_EQ(simulator.styluses[0].force_n, "1.5");
  EXPECT_EQ(simulator.recording, "/tmp/a.viscera");
}

TEST(DiscoveredSimulators, WhoIsSilentIsGone) {
  DiscoveredSimulators found;
  const DiscoveredSimulators::Time now{};
  tell(found, now, "a: simulation", "running", 0, {});
  tell(found, now, "a: old stylus", "tracked", 0, {{"poses_accepted", "1"}});
  tell(found, now + seconds(2), "a: simulation", "running", 0, {});
  EXPECT_EQ(found.at(now + seconds(4)).size(), 1U);
  EXPECT_TRUE(found.at(now + seconds(4))[0].styluses.empty());
  EXPECT_TRUE(found.at(now + seconds(6)).empty());
}

}  // namespace
}  // namespace viscera::received
