// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/ros/end_watch.h"

#include <gtest/gtest.h>
#include <ros/init.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstring>
#include <fstream>
#include <string>
#include <thread>

#include "nodes/ros/thread_name.h"

// Last moments of a process: each test is a process that ends, and prints "zero" in place of a device's last force.

namespace viscera::nodes {
namespace {

using std::chrono::milliseconds;
constexpr milliseconds kOnTheWay{30};  ///< time to send zeros in these tests: less than a crash waits for them

class EndWatchDeathTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ::testing::FLAGS_gtest_death_test_style = "threadsafe";
    getrlimit(RLIMIT_CORE, &before_);
    const rlimit none{0, before_.rlim_max};
    setrlimit(RLIMIT_CORE, &none);  // these crashes are intended
  }
  void TearDown() override { setrlimit(RLIMIT_CORE, &before_); }

 private:
  rlimit before_{};
};

void sayZero() {
  constexpr char kZero[] = "zero\n";
  if (write(STDERR_FILENO, kZero, sizeof kZero - 1) < 0) std::_Exit(EXIT_FAILURE);
}

/// Uses more stack than available.
int descend(int depth) {
  volatile char room[4096];
  room[0] = static_cast<char>(depth);
  return depth == 0 ? 0 : descend(depth - 1) + room[0];
}

void overflow() {
  std::_Exit(descend(1'000'000'000));
}

TEST_F(EndWatchDeathTest, StackOverflowOfTheMainThreadReleases) {
  const auto die = [] {
    EndWatch end;
    const EndWatch::Act act(end, sayZero);
    overflow();
  };
  EXPECT_EXIT(die(), ::testing::KilledBySignal(SIGSEGV), "zero");
}

TEST_F(EndWatchDeathTest, StackOverflowOfAThreadReleases) {
  const auto die = [] {
    EndWatch end;
    const EndWatch::Act act(end, sayZero);
    std::thread([] {
      nameThread("deep");
      overflow();
    }).join();
  };
  EXPECT_EXIT(die(), ::testing::KilledBySignal(SIGSEGV), "zero");
}

TEST_F(EndWatchDeathTest, SecondCrashWaitsForTheZerosOfTheFirst) {
  const auto die = [] {
    EndWatch end;
    const EndWatch::Act act(end, [] {
      std::this_thread::sleep_for(kOnTheWay);
      sayZero();
    });
    std::thread second([] {
      std::this_thread::sleep_for(kOnTheWay / 3);
      raise(SIGSEGV);
    });
    raise(SIGSEGV);
    second.join();
  };
  EXPECT_EXIT(die(), ::testing::KilledBySignal(SIGSEGV), "zero");
}

TEST_F(EndWatchDeathTest, CrashOfAnActWaitsForWhatItHasBegun) {
  const auto die = [] {
    EndWatch end;
    std::atomic<bool> asked{false};
    std::thread sender([&asked] {
      while (!asked) std::this_thread::sleep_for(milliseconds(1));
      std::this_thread::sleep_for(kOnTheWay);
      sayZero();
    });
    const EndWatch::Act act(end, [&asked] {
      asked = true;
      raise(SIGSEGV);
    });
    raise(SIGSEGV);
    sender.join();
  };
  EXPECT_EXIT(die(), ::testing::KilledBySignal(SIGSEGV), "zero");
}

/// Moves the process into a process group of its own, as a shell does: its parent's session can continue it, so signals
/// of the terminal stop it.
/// @returns the process that continues this one after it has stopped
pid_t continueOnceStopped() {
  setpgid(0, 0);
  const pid_t watched = getpid(), watcher = fork();
  if (watcher != 0) return watcher;
  for (std::string state; state != "T"; usleep(1000)) {
    std::string number, name;
    std::ifstream("/proc/" + std::to_string(watched) + "/stat") >> number >> name >> state;
  }
  kill(watched, SIGCONT);
  std::_Exit(EXIT_SUCCESS);
}

void sayOn() {
  constexpr char kOn[] = "on\n";
  if (write(STDERR_FILENO, kOn, sizeof kOn - 1) < 0) std::_Exit(EXIT_FAILURE);
}

void beStoppedAndGoOn(int signal) {
  const pid_t watcher = continueOnceStopped();
  EndWatch end;
  std::atomic<bool> goes_on{false};
  const EndWatch::Act act(
      end, [] {}, sayZero,
      [&goes_on] {
        sayOn();
        goes_on = true;
      });
  kill(getpid(), signal);
  while (!goes_on) std::this_thread::sleep_for(milliseconds(1));
  kill(watcher, SIGKILL);
  const bool just_now = std::chrono::steady_clock::now() - EndWatch::continued() < EndWatch::kLimit;
  std::_Exit(just_now && !end.waitFor(milliseconds(0)) ? EXIT_SUCCESS : EXIT_FAILURE);
}

TEST_F(EndWatchDeathTest, ProcessThatATerminalStopsReleasesBeforeAndGoesOn) {
  for (const int signal : {SIGTSTP, SIGTTIN, SIGTTOU})
    EXPECT_EXIT(beStoppedAndGoOn(signal), ::testing::ExitedWithCode(EXIT_SUCCESS), "zero\non\n") << strsignal(signal);
}

TEST_F(EndWatchDeathTest, ProcessThatDoesNotComeToItsEndIsEndedWithTheStatusThatItHasAskedFor) {
  const auto die = [] {
    ros::init(ros::M_string{{"__master", "http://127.0.0.1:1"}}, "ending", ros::init_options::NoSigintHandler);
    EndWatch end;
    const EndWatch::Act act(end, sayZero);
    EndWatch::begin(3);
    std::this_thread::sleep_for(10 * EndWatch::kLimit);
  };
  EXPECT_EXIT(die(), ::testing::ExitedWithCode(3), "zero");
}

}  // namespace
}  // namespace viscera::nodes
