// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulator/command_queue.h"

#include <utility>

namespace viscera::nodes {
namespace {

CommandAnswer failure(const std::string& message) {
  CommandAnswer answer;
  answer.message = message;
  return answer;
}

}  // namespace

CommandAnswer CommandQueue::call(Command&& command, std::chrono::milliseconds limit) {
  command.deadline = std::chrono::steady_clock::now() + limit;
  std::future<CommandAnswer> answer = command.answer.get_future();
  const std::shared_ptr<std::atomic<bool>> begun = command.begun;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (closed_) return failure("the simulation has ended");
    if (commands_.size() >= kCapacity) return failure("too many commands are waiting; try again later");
    commands_.push_back(std::move(command));
  }
  changed_.notify_one();
  const bool late = answer.wait_for(limit) != std::future_status::ready;
  if (late && (!hasBegun(*begun) || answer.wait_for(kGrace) != std::future_status::ready))
    return failure("no answer within " + std::to_string(limit.count()) + " ms");
  try {
    return answer.get();
  } catch (const std::future_error&) {  // an error ended the simulation during this command
    return failure("the simulation has ended");
  }
}

/// Returns whether a command has begun. After the deadline the result does not change.
bool CommandQueue::hasBegun(const std::atomic<bool>& begun) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return begun;
}

std::optional<Command> CommandQueue::take() {
  const std::lock_guard<std::mutex> lock(mutex_);
  while (!commands_.empty()) {
    Command command = std::move(commands_.front());
    commands_.pop_front();
    if (command.deadline <= std::chrono::steady_clock::now()) continue;
    *command.begun = true;
    return command;
  }
  return std::nullopt;
}

void CommandQueue::wait(std::chrono::milliseconds limit) {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait_for(lock, limit, [this] { return closed_ || !commands_.empty(); });
}

void CommandQueue::close() {
  const std::lock_guard<std::mutex> lock(mutex_);
  closed_ = true;
  for (Command& command : commands_) command.answer.set_value(failure("the simulation has ended"));
  commands_.clear();
  changed_.notify_all();
}

}  // namespace viscera::nodes
