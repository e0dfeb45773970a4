// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/ros/master_watch.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <ros/init.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>

namespace viscera::nodes {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
constexpr milliseconds kAtOnce{100};  ///< limit for operations that do not wait, on a busy machine too
constexpr milliseconds kNeverLost{8000};

/// Starts a master that accepts connections and never answers, like a stopped one. @returns its port
int listenInSilence() {
  const int listener = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t length = sizeof address;
  if (bind(listener, reinterpret_cast<sockaddr*>(&address), length) != 0 || listen(listener, 10) != 0 ||
      getsockname(listener, reinterpret_cast<sockaddr*>(&address), &length) != 0)
    std::_Exit(EXIT_FAILURE);
  return ntohs(address.sin_port);
}

[[noreturn]] void watchSilentMaster() {
  ros::M_string master{{"__master", "http://127.0.0.1:" + std::to_string(listenInSilence())}};
  ros::init(master, "watcher", ros::init_options::NoSigintHandler);
  Clock::duration longest{};
  const Clock::time_point begun = Clock::now();
  Clock::time_point closing;
  {
    const MasterWatch watch;
    for (bool known = true; known && Clock::now() - begun < kNeverLost;) {
      const Clock::time_point asked = Clock::now();
      known = watch.check();
      longest = std::max(longest, Clock::now() - asked);
      usleep(1000);
    }
    closing = Clock::now();
  }
  const bool lost = closing - begun < kNeverLost;
  std::_Exit(lost && longest < kAtOnce && Clock::now() - closing < 2 * kAtOnce ? EXIT_SUCCESS : EXIT_FAILURE);
}

TEST(MasterWatchDeathTest, WaitsForNoAnswerAndTakesAMasterThatGivesNoneForLost) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(watchSilentMaster(), ::testing::ExitedWithCode(EXIT_SUCCESS), "");
}

}  // namespace
}  // namespace viscera::nodes
