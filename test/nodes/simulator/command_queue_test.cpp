// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulator/command_queue.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace viscera::nodes {
namespace {

using std::chrono::milliseconds;
constexpr milliseconds kLong{10000};  // never reached in a passing test
constexpr milliseconds kShort{20};

Command command(Command::Kind kind, uint32_t ticks) {
  Command out;
  out.kind = kind;
  out.ticks = ticks;
  return out;
}

TEST(CommandQueue, AnswerComesBackToTheCaller) {
  CommandQueue queue;
  std::thread simulation([&] {
    queue.wait(kLong);
    std::optional<Command> command = queue.take();
    ASSERT_TRUE(command);
    CommandAnswer answer;
    answer.success = true;
    answer.tick = command->ticks + 1;
    command->answer.set_value(answer);
  });
  const CommandAnswer answer = queue.call(command(Command::Kind::kStep, 7), kLong);
  simulation.join();
  EXPECT_TRUE(answer.success);
  EXPECT_EQ(answer.tick, 8u);
}

TEST(CommandQueue, CallerIsNotKeptLongerThanTheLimit) {
  CommandQueue queue;
  const CommandAnswer answer = queue.call(command(Command::Kind::kReset, 0), kShort);
  EXPECT_FALSE(answer.success);
  EXPECT_FALSE(answer.message.empty());
}

TEST(CommandQueue, CommandWhoseCallerGaveUpIsNotExecuted) {
  CommandQueue queue;
  queue.call(command(Command::Kind::kReset, 0), kShort);
  EXPECT_FALSE(queue.take());
}

TEST(CommandQueue, CommandThatBeganInTimeIsAnsweredThoughItTakesLonger) {
  CommandQueue queue;
  std::thread simulation([&] {
    queue.wait(kLong);
    std::optional<Command> step = queue.take();
    ASSERT_TRUE(step);
    std::this_thread::sleep_until(step->deadline + kShort);
    CommandAnswer answer;
    answer.tick = 3;  // fewer than requested
    step->answer.set_value(answer);
  });
  EXPECT_EQ(queue.call(command(Command::Kind::kStep, 1000), 5 * kShort).tick, 3u);
  simulation.join();
}

TEST(CommandQueue, FullQueueRefusesAtOnce) {
  CommandQueue queue;
  std::vector<std::thread> callers;
  for (size_t i = 0; i < CommandQueue::kCapacity; ++i)
    callers.emplace_back([&] { queue.call(command(Command::Kind::kReset, 0), kLong); });
  CommandAnswer answer;
  do {  // until all callers wait; each of these gives up by itself
    answer = queue.call(command(Command::Kind::kReset, 0), milliseconds(1));
  } while (answer.message.find("too many") == std::string::npos);
  EXPECT_FALSE(answer.success);
  queue.close();
  for (std::thread& caller : callers) caller.join();
}

TEST(CommandQueue, ClosingAnswersThoseWhoWait) {
  CommandQueue queue;
  std::thread simulation([&] {
    queue.wait(kLong);
    queue.close();
  });
  EXPECT_FALSE(queue.call(command(Command::Kind::kPause, 0), kLong).success);
  simulation.join();
  EXPECT_FALSE(queue.call(command(Command::Kind::kPause, 0), kLong).success);
}

TEST(CommandQueue, CallerOfACommandThatDiedIsAnswered) {
  CommandQueue queue;
  std::thread simulation([&] {
    queue.wait(kLong);
    queue.take();  // and an error destroys the command without an answer
  });
  EXPECT_FALSE(queue.call(command(Command::Kind::kStep, 1), kLong).success);
  simulation.join();
}

}  // namespace
}  // namespace viscera::nodes
