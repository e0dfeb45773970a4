// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/received/ros_worker.h"

#include <ros/exception.h>

#include <chrono>
#include <utility>

namespace viscera::received {
namespace {

constexpr size_t kMostJobs = 8;                       // as in the simulator's queue
constexpr std::chrono::milliseconds kCloseAgain{20};  // retries to close a call that was about to begin

}  // namespace

RosWorker::RosWorker(std::function<void(const std::string&)> report)
    : report_(std::move(report)), thread_([this] { main(); }) {}

RosWorker::~RosWorker() {
  {
    std::unique_lock<std::mutex> lock(mutex_);
    ending_ = true;
    jobs_.clear();
    changed_.notify_all();
    while (!changed_.wait_for(lock, kCloseAgain, [this] { return ended_; })) {
      ros::ServiceClient client = client_;
      lock.unlock();
      client.shutdown();
      lock.lock();
    }
  }
  thread_.join();
}

void RosWorker::add(std::function<std::string()> job) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (jobs_.size() >= kMostJobs) return;  // the user keeps clicking
  jobs_.push_back(std::move(job));
  changed_.notify_all();
}

void RosWorker::main() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ending_ || !jobs_.empty(); });
    if (ending_) break;
    const std::function<std::string()> job = std::move(jobs_.front());
    jobs_.pop_front();
    lock.unlock();
    std::string answer;
    try {
      answer = job();
    } catch (const ros::Exception& error) {  // not a valid name of a service
      answer = error.what();
    }
    lock.lock();
    client_ = ros::ServiceClient();
    if (ending_) break;
    lock.unlock();
    if (!answer.empty()) report_(answer);
    lock.lock();
  }
  ended_ = true;
  changed_.notify_all();
}

}  // namespace viscera::received
