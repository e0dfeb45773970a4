// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/ros/end_watch.h"

#include <fcntl.h>
#include <ros/console.h>
#include <ros/init.h>
#include <ros/xmlrpc_manager.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <utility>

#include "nodes/ros/thread_name.h"
#include "viscera/math/error.h"

namespace viscera::nodes {
namespace {

constexpr int kEndSignals[] = {SIGINT, SIGTERM, SIGHUP};
constexpr int kCrashSignals[] = {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT};  // SIGABRT includes std::terminate()
constexpr int kStopSignals[] = {SIGTSTP, SIGTTIN, SIGTTOU};
constexpr char kEnd = 'e', kCrash = 'c', kClose = 'q', kStop = 's';
/// Time for acts after a crash: enough for zeros to reach the devices.
constexpr long kCrashWait_ns = 60'000'000;
/// Time to unregister from a master that answers.
constexpr std::chrono::milliseconds kFarewell{200};

int wake_pipe[2] = {-1, -1};  // accessible to signal handlers
std::atomic_flag crashed = ATOMIC_FLAG_INIT;
std::atomic<int> forced_status{EXIT_SUCCESS};
std::atomic_flag stopping = ATOMIC_FLAG_INIT;
std::atomic<std::chrono::steady_clock::rep> continued_at{0};

void wake(char why) {
  const int saved = errno;
  const ssize_t written = write(wake_pipe[1], &why, 1);
  static_cast<void>(written);  // the pipe is full: the watch is awake already
  errno = saved;
}

void onEnd(int) {
  wake(kEnd);
}

void onStop(int) {
  if (!stopping.test_and_set()) wake(kStop);  // the terminal may repeat the signal until the process has stopped
}

void onContinue(int) {
  continued_at = std::chrono::steady_clock::now().time_since_epoch().count();
}

void sleep(timespec left) {
  while (nanosleep(&left, &left) != 0 && errno == EINTR) {
  }
}

/// Ends the process after the first crash, with time for the acts. Other threads that crash are suspended, including
/// that of EndWatch: other threads may complete acts that it has begun.
void onCrash(int signal) {
  while (crashed.test_and_set()) sleep({1, 0});
  wake(kCrash);
  sleep({0, kCrashWait_ns});
  std::signal(signal, SIG_DFL);
  raise(signal);
}

void onMastersDemand(XmlRpc::XmlRpcValue& parameters, XmlRpc::XmlRpcValue& result) {
  std::string reason = "no reason given";
  if (parameters.getType() == XmlRpc::XmlRpcValue::TypeArray && parameters.size() > 1 &&
      parameters[1].getType() == XmlRpc::XmlRpcValue::TypeString)
    reason = static_cast<std::string&>(parameters[1]);
  wake(kEnd);
  ROS_WARN("the ROS master requests a shutdown of this node: %s", reason.c_str());
  result = ros::xmlrpc::responseInt(1, "", 0);
}

void handle(int signal, void (*handler)(int), int flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  sigaction(signal, &action, nullptr);
}

}  // namespace

EndWatch::EndWatch() {
  if (pipe2(wake_pipe, O_CLOEXEC) != 0) throw Error("cannot create a pipe for signals");
  fcntl(wake_pipe[1], F_SETFL, O_NONBLOCK);
  CrashStack::give();
  thread_ = std::thread([this] { main(); });
  for (const int signal : kEndSignals) handle(signal, onEnd, SA_RESTART);
  for (const int signal : kStopSignals) handle(signal, onStop, SA_RESTART);
  handle(SIGCONT, onContinue, SA_RESTART);
  for (const int signal : kCrashSignals) handle(signal, onCrash, SA_ONSTACK);
  ros::XMLRPCManager::instance()->unbind("shutdown");
  ros::XMLRPCManager::instance()->bind("shutdown", onMastersDemand);
}

EndWatch::~EndWatch() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closing_ = true;
  }
  changed_.notify_all();
  wake(kClose);
  thread_.join();
}

EndWatch::Act::Act(EndWatch& watch, std::function<void()> run, std::function<void()> suspend,
                   std::function<void()> resume)
    : watch_(watch), run_(std::move(run)), suspend_(std::move(suspend)), resume_(std::move(resume)) {
  const std::lock_guard<std::mutex> lock(watch_.acts_mutex_);
  watch_.acts_.push_back(this);
}

EndWatch::Act::~Act() {
  const std::lock_guard<std::mutex> lock(watch_.acts_mutex_);
  watch_.acts_.erase(std::remove(watch_.acts_.begin(), watch_.acts_.end(), this), watch_.acts_.end());
}

void EndWatch::runActs() {
  const std::lock_guard<std::mutex> lock(acts_mutex_);
  for (const Act* act : acts_) act->run_();
}

/// Stops the process as the signal would have done, after the acts.
void EndWatch::beStopped() {
  const std::lock_guard<std::mutex> lock(acts_mutex_);
  for (const Act* act : acts_)
    if (act->suspend_) act->suspend_();
  handle(SIGTSTP, SIG_DFL, 0);
  raise(SIGTSTP);  // the process stops here, unless it is orphaned and no terminal could continue it
  handle(SIGTSTP, onStop, SA_RESTART);
  stopping.clear();
  for (const Act* act : acts_)
    if (act->resume_) act->resume_();
}

std::chrono::steady_clock::time_point EndWatch::continued() {
  using std::chrono::steady_clock;
  return steady_clock::time_point(steady_clock::duration(continued_at));
}

void EndWatch::main() {
  nameThread("end_watch");
  char why = 0;
  while (why != kEnd && why != kClose) {
    const ssize_t got = read(wake_pipe[0], &why, 1);
    if (got < 0 && errno == EINTR) continue;
    if (got != 1) return;
    if (why == kStop) beStopped();
    if (why == kEnd || why == kCrash) runActs();
  }
  std::unique_lock<std::mutex> lock(mutex_);
  if (why == kClose) return;
  begun_ = true;
  changed_.notify_all();
  if (!changed_.wait_for(lock, kLimit, [this] { return closing_; })) endByForce();
}

/// Ends a process that hangs: creating a model, in a driver, or waiting for a master that does not answer.
void EndWatch::endByForce() {
  std::thread([] { ros::shutdown(); }).detach();
  std::this_thread::sleep_for(kFarewell);
  std::_Exit(forced_status);
}

void EndWatch::begin(int status) {
  forced_status = status;
  wake(kEnd);
}

bool EndWatch::waitFor(std::chrono::milliseconds limit) {
  std::unique_lock<std::mutex> lock(mutex_);
  return changed_.wait_for(lock, limit, [this] { return begun_; });
}

}  // namespace viscera::nodes
