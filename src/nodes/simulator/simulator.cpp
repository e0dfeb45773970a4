// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulator/simulator.h"

#include <ros/console.h>
#include <ros/spinner.h>

#include <algorithm>
#include <optional>
#include <thread>

#include "math/one_line.h"
#include "nodes/ros/clock_watch.h"
#include "nodes/ros/conversions.h"
#include "nodes/ros/master_watch.h"

namespace viscera::nodes {
namespace {

constexpr std::chrono::milliseconds kWatchPeriod{10};  ///< time until a lost master is detected
constexpr double kWarnPeriod_s = 5;
/// Lower limit for short ticks: other work on the machine may delay a thread for this time.
constexpr double kShortestStall_s = 0.015;

double stallTime_s(const SimulatorOptions& options) {
  return std::max(options.stall_ticks / options.scene.solver.tick_hz, kShortestStall_s);
}

/// Returns whether anything depends on tf frames. Its frame may depend on one that this node sends, like a camera on a
/// tool.
bool followsFrames(const SimulatorOptions& options) {
  const auto carried = [](const auto& item) { return !item.frame.empty(); };
  const auto tracked = [](const DeviceProfile& device) { return !device.pose.tf_frame.empty(); };
  return std::any_of(options.scene.obstacles.begin(), options.scene.obstacles.end(), carried) ||
         std::any_of(options.scene.cameras.begin(), options.scene.cameras.end(), carried) ||
         std::any_of(options.devices.begin(), options.devices.end(), tracked);
}

}  // namespace

Simulator::Simulator(const SimulatorOptions& options, EndWatch& end, SceneSwitch& scenes, RecordingSwitch& recordings)
    : end_(end),
      scenes_(scenes),
      recordings_(recordings),
      listener_(frames_, !followsFrames(options)),
      obstacles_(options.scene, frames_, options.max_transform_age_s),
      camera_frames_(options.scene, frames_, options.max_transform_age_s),
      inputs_(makeInputs(options, frames_)),
      wrenches_(node_, mailboxes(), stallTime_s(options), options.scene, options.haptics),
      release_(
          end_, [this] { wrenches_.release(); }, [this] { wrenches_.suspend(); }, [this] { wrenches_.resume(); }),
      preparation_(options.scene),
      tool_frames_(options.scene.environment.tissue_frame, toolFrames(options.scene, options.publish.frame_prefix)),
      publisher_(node_, options.scene, options.publish, [this](std::exception_ptr error) { fail(error); }),
      ticks_(node_, options.scene, [this] { return publisher_.isViewed(); }),
      samples_(node_, options.scene, options.choice),
      obstacle_forces_(node_, options.scene),
      tasks_(node_, options.scene, options.choice, options.package_folder,
             {options.saved_folder, options.saved_limit_gb}, options.trainee),
      loop_(options.scene, scenes.takeMade(), ports(),
            [this](const std::string& stage, double fraction) { reportProgress(stage, fraction); }),
#ifdef VISCERA_RECONFIGURE
      settings_(std::in_place, options, loop_.commands(), SimulatorSettings::Publishers{publisher_, wrenches_}),
#endif
      services_(std::in_place, node_, options.scene.styluses, SavedFolder(options.saved_folder, options.saved_limit_gb),
                loop_.commands(), SimulatorServices::Switches{recordings_, tasks_}, modeSet()),
      diagnostics_(std::in_place, node_, options.scene, loop_,
                   SimulatorDiagnostics::Publishers{publisher_, wrenches_, recordings_, scenes_.adaptiveResolution(),
                                                    [this] { return preparingPercent(); }},
                   inputs_, obstacles_, camera_frames_),
      device_spinner_(1, &device_queue_) {
}

Simulator::~Simulator() {
  wrenches_.release();
}

/// Reports progress in the log, and in rviz, which has nothing else to show.
void Simulator::reportProgress(const std::string& stage, double fraction) {
  ROS_INFO_THROTTLE(1, "preparing: %s %.0f %%", stage.c_str(), 100 * fraction);
  preparing_percent_ = preparation_.percentAt(stage, fraction);
  publisher_.tell("preparing: " + std::to_string(preparing_percent_) + " %");
}

/// Returns the progress of this scene, or of the next one that load_scene creates [%]; below 0: none.
int Simulator::preparingPercent() const {
  const int next = scenes_.madePercent();
  return next >= 0 || ready_ ? next : preparing_percent_.load();
}

SimulatorDiagnostics::Inputs Simulator::makeInputs(const SimulatorOptions& options, tf2_ros::Buffer& frames) {
  SimulatorDiagnostics::Inputs inputs;
  for (size_t s = 0; s < options.scene.styluses.size(); ++s)
    inputs.push_back(std::make_unique<StylusInput>(options.scene.styluses[s], options.devices[s],
                                                   options.scene.environment.tissue_frame, frames,
                                                   options.max_transform_age_s));
  return inputs;
}

SimulatorServices::ModeSet Simulator::modeSet() {
#ifdef VISCERA_RECONFIGURE
  return [this](size_t stylus, ToolSwitch when, ToolMode mode) { settings_->recordMode(stylus, when, mode); };
#else
  return {};
#endif
}

std::vector<std::string> Simulator::toolFrames(const Scene& scene, const std::string& prefix) {
  std::vector<std::string> out;
  for (const StylusConfig& stylus : scene.styluses) out.push_back(toolFrame(stylus, prefix));
  return out;
}

std::vector<const StylusMailbox*> Simulator::mailboxes() const {
  std::vector<const StylusMailbox*> out;
  for (const auto& input : inputs_) out.push_back(&input->mailbox());
  return out;
}

LoopPorts Simulator::ports() {
  LoopPorts ports;
  if (!obstacles_.empty()) ports.place = [this](Session& session) { obstacles_.apply(session); };
  ports.samples = [this] {
    const auto now = std::chrono::steady_clock::now();
    StylusSamples samples;
    for (size_t i = 0; i < inputs_.size(); ++i) {
      inputs_[i]->beginTick();
      samples[i] = inputs_[i]->mailbox().take(now);
    }
    return samples;
  };
  if (!camera_frames_.empty()) ports.aim = [this](Session& session) { return camera_frames_.apply(session); };
  ports.outputs = [this] { return placed(tasks_.with(publisher_.beginTick())); };
  ports.stills = [this](bool changed, bool aimed) { return placed(publisher_.stills(changed, aimed)); };
  ports.ready = [this](Session& session, bool pictures) {
    scenes_.begin(session);
    recordings_.follow(session);
    tasks_.follow(session, pictures);
    ROS_INFO("ready: %zu nodes, %zu springs, %zu triangles, substep %.3g ms", session.model().activeNodes(),
             session.model().springs(), session.model().skinTriangles(), 1e3 * session.solver().dt_s());
    ROS_INFO("stepped by: %s", session.backendNote().c_str());
    for (const Body& body : session.model().bodies)
      for (const std::string& note : body.notes) ROS_INFO("%s: %s", body.name.c_str(), note.c_str());
    if (!wrenches_.scheduling().empty()) ROS_INFO("forces between ticks: %s", wrenches_.scheduling().c_str());
    publisher_.start(session.wholeSkin());
    ready_ = true;
  };
  ports.addTo = [this](const Session& session, Frame& frame) { publisher_.addTo(session, frame); };
  ports.leave = [this](const Session& session) {
    scenes_.leave(session);
    tasks_.leave();
    recordings_.leave();
  };
  ports.stepped = [this](uint64_t tick, const StylusSamples& samples, const ToolMotions& tools, bool input_reset) {
    samples_.publish(tick, samples, tools, input_reset);
  };
  ports.deliver = [this](Frame&& frame, const StylusSamples& samples, bool live) {
    deliver(std::move(frame), samples, live);
  };
  ports.rest = [this] { wrenches_.rest(); };
  ports.resetInput = [this] {
    for (const auto& input : inputs_) input->mailbox().clearButtons();
  };
  ports.failed = [this] { wrenches_.release(); };
  return ports;
}

/// Returns the outputs without images of cameras with unknown poses.
FrameRequest Simulator::placed(FrameRequest outputs) const {
  for (size_t k = 0; k < kPictureKinds; ++k) {
    std::vector<bool>& wanted = outputs.of(static_cast<PictureKind>(k));
    for (size_t c = 0; c < wanted.size(); ++c) wanted[c] = wanted[c] && camera_frames_.isPlaced(c);
  }
  return outputs;
}

void Simulator::deliver(Frame&& frame, const StylusSamples& samples, bool live) {
  if (live) {
    WrenchPublisher::Inputs inputs;
    for (size_t s = 0; s < inputs_.size(); ++s) {
      // a stylus that is not tracked, or has its clutch pressed, must not be pushed
      if (samples[s].valid && !inputs_[s]->mailbox().clutched())
        inputs[s] = {frame.reactions[s], frame.poses_received[s], true, frame.contacts[s]};
    }
    wrenches_.put(inputs);
  } else {
    wrenches_.rest();
  }
  for (size_t s = 0; s < inputs_.size(); ++s)
    inputs_[s]->endTick(frame.tools[s], frame.jaw_moments_nm[s], publisher_.tickStamp());
  tool_frames_.put(samples, publisher_.tickStamp());
  ticks_.publish(frame.tick);
  tasks_.notice(frame);
  obstacle_forces_.publish(frame, publisher_.tickStamp());
  publisher_.deliver(std::move(frame), samples);
}

void Simulator::fail(std::exception_ptr error) {
  wrenches_.release();
  const std::lock_guard<std::mutex> lock(error_mutex_);
  if (!error_) error_ = error;
}

void Simulator::listen() {
  if (listening_ || !ready_) return;
  listening_ = true;
  scenes_.recordReady();
  ros::NodeHandle devices(node_);
  devices.setCallbackQueue(&device_queue_);
  for (const auto& input : inputs_) input->subscribe(devices);
  device_spinner_.start();
}

void Simulator::warnOfStalls() {
  const uint64_t stalls = wrenches_.stalls();
  if (stalls == stalls_) return;
  stalls_ = stalls;
  ROS_WARN_THROTTLE(
      kWarnPeriod_s,
      "no tick arrived in time (~stall_ticks): forces are zero until ticks are in time again; stalls so far: %lu",
      static_cast<unsigned long>(stalls));
}

void Simulator::warnOfRecording() {
  const std::string fault = recordings_.fault();
  if (fault != recording_fault_ && !fault.empty()) ROS_WARN("the recording has ended: %s", fault.c_str());
  recording_fault_ = fault;
}

void Simulator::stepAside(ros::AsyncSpinner& spinner) {
  scenes_.holdTopics();
  spinner.stop();
  diagnostics_.reset();
  services_.reset();
#ifdef VISCERA_RECONFIGURE
  settings_.reset();
#endif
  wrenches_.release();      // no forces from here on
  device_queue_.disable();  // otherwise the spinner would wait for a message
  device_spinner_.stop();
  for (const auto& input : inputs_) input->unsubscribe();
}

/// Shows a failure in place of the tissue.
void Simulator::tellFailure(const std::string& why) {
  constexpr std::chrono::milliseconds kFlush{50};  // roscpp writes on its own thread; it has done so after this time
  publisher_.tell(why);
  std::this_thread::sleep_for(kFlush);
}

void Simulator::run() {
  ros::AsyncSpinner diagnostics(1);
  diagnostics.start();
  MasterWatch master;
  ClockWatch clock;
  bool known = true;
  const auto failed = [this] {
    const std::lock_guard<std::mutex> lock(error_mutex_);
    return error_ != nullptr;
  };
  while (!end_.waitFor(kWatchPeriod) && !loop_.ended() && !failed() && known && !scenes_.isRequested()) {
    listen();
    warnOfStalls();
    warnOfRecording();
    known = master.check();
    clock.check();
  }
  if (known && !failed() && scenes_.isRequested()) stepAside(diagnostics);
  wrenches_.release();
  std::optional<MasterLost> lost;
  if (!known) lost.emplace();
  try {
    loop_.stop();
  } catch (const std::exception& error) {
    if (!ready_) tellFailure(oneLine(error.what()));
    throw;
  }
  scenes_.retire(loop_.takeSession());
  if (failed()) std::rethrow_exception(error_);
  if (lost) throw *lost;
}

}  // namespace viscera::nodes
