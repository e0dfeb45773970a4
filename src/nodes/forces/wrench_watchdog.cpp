// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/forces/wrench_watchdog.h"

#include <ros/console.h>

#include <utility>

#include "nodes/input/device_choice.h"
#include "nodes/input/force_messages.h"
#include "nodes/ros/master_watch.h"
#include "nodes/ros/scene_choice.h"
#include "nodes/ros/thread_name.h"

namespace viscera::nodes {
namespace {

constexpr std::chrono::milliseconds kRepeat{20};  ///< period of repeated zeros, for a driver that starts late
/// roscpp writes to sockets on its own thread and does not report when; it has done so after this time.
constexpr std::chrono::milliseconds kWrenchWatchdogFlush{10};
constexpr std::chrono::milliseconds kPoll{20};  ///< time until a lost master is detected
constexpr double kMinTimeout_s = 0.005, kMaxTimeout_s = 10;

}  // namespace

WatchdogOptions watchdogOptions(Parameters& parameters, const std::string& package_folder) {
  WatchdogOptions options;
  options.timeout_s = parameters.number("timeout_s", options.timeout_s, kMinTimeout_s, kMaxTimeout_s);
  DeviceChoice choice;
  setProfile(choice, parameters.text("device", choice.profile));
  choice.stylus = parameters.text("stylus", "");
  const bool finds_topic = !choice.stylus.empty();
  for (const std::string& option : parameters.texts("device_options"))
    if (option.rfind(choice.stylus + ".", 0) == 0) choice.overrides.push_back(option.substr(choice.stylus.size() + 1));
  parameters.refuseOthers();
  options.port = loadDevice(namedFile("device", choice.profile, package_folder + "/config/devices"), choice).force;
  if (finds_topic) {
    options.topic = options.port.topic;
  } else if (options.port.type == ForceType::kNone) {
    throw ParameterError("parameter ~device: " + choice.profile + " accepts no forces");
  }
  return options;
}

/// Relay for messages of one type.
class WrenchWatchdog::Line {
 public:
  virtual ~Line() = default;
  virtual void listen(ros::NodeHandle& node, WrenchWatchdog& watchdog) = 0;
  virtual void sendZero() = 0;  ///< sends zero force in place of the last message
};

template <class Message>
class WrenchWatchdog::LineOf : public Line {
 public:
  LineOf(ros::NodeHandle& node, const WatchdogOptions& options)
      : port_(options.port), out_(advertiseForce<Message>(node, options.topic, options.port)) {}

  void listen(ros::NodeHandle& node, WrenchWatchdog& watchdog) override {
    const boost::function<void(const boost::shared_ptr<Message const>&)> take =
        [this, &watchdog](const boost::shared_ptr<Message const>& message) {
          watchdog.pass([&] {
            last_ = *message;
            out_.publish(last_);
          });
        };
    ros::SubscribeOptions options;
    options.init<Message>("wrench_in", 1, take);
    options.datatype = forceDatatype<Message>(port_);
    options.transport_hints.tcpNoDelay();
    in_ = node.subscribe(options);
  }
  void sendZero() override {
    setZero(last_);
    out_.publish(last_);
  }

 private:
  const ForcePort port_;
  Message last_;
  ros::Publisher out_;
  ros::Subscriber in_;
};

WrenchWatchdog::WrenchWatchdog(const WatchdogOptions& options, EndWatch& end)
    : timeout_(std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options.timeout_s))),
      end_(end),
      line_([&] {
        std::unique_ptr<Line> line;
        withForceMessage(options.port.type,
                         [&](auto message) { line = std::make_unique<LineOf<decltype(message)>>(node_, options); });
        return line;
      }()),
      act_(
          end, [this] { stop(); }, [this] { suspend(); }, [this] { resume(); }),
      watch_([this] { watch(); }),
      spinner_(1, &queue_) {
  if (!line_) {
    ROS_INFO("the device accepts no forces, so there is nothing to watch");
    return;
  }
  ros::NodeHandle input(node_);
  input.setCallbackQueue(&queue_);
  line_->listen(input, *this);
  spinner_.start();
}

WrenchWatchdog::~WrenchWatchdog() {
  stop();
  spinner_.stop();
  watch_.join();
}

void WrenchWatchdog::run() {
  MasterWatch master;
  uint64_t warned = 0;
  while (!end_.waitFor(kPoll)) {
    const uint64_t silences = silences_;
    if (std::exchange(warned, silences) != silences)
      ROS_WARN("no wrench for %.3f s; zeros are sent until wrenches arrive again",
               std::chrono::duration<double>(timeout_).count());
    master.require();
  }
}

void WrenchWatchdog::pass(const std::function<void()>& send) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (stopped_ || suspended_) return;
  heard_ = Clock::now();
  if (std::exchange(silent_, false)) changed_.notify_all();  // the time-out must now be waited for
  send();
}

void WrenchWatchdog::sendZero() {
  if (line_) line_->sendZero();
  sent_ = Clock::now();
}

void WrenchWatchdog::watch() {
  nameThread("zeros");
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopped_) {
    const Clock::time_point due = silent_ ? sent_ + kRepeat : heard_ + timeout_;
    if (Clock::now() < due) {
      changed_.wait_until(lock, due);
      continue;
    }
    if (!std::exchange(silent_, true)) ++silences_;
    sendZero();
  }
}

void WrenchWatchdog::suspend() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (stopped_) return;
    suspended_ = silent_ = true;
    sendZero();
  }
  changed_.notify_all();
  std::this_thread::sleep_for(kWrenchWatchdogFlush);
}

void WrenchWatchdog::resume() {
  const std::lock_guard<std::mutex> lock(mutex_);
  suspended_ = false;
}

void WrenchWatchdog::stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (stopped_) return;
    stopped_ = true;
    sendZero();
  }
  changed_.notify_all();
  std::this_thread::sleep_for(kWrenchWatchdogFlush);
}

}  // namespace viscera::nodes
