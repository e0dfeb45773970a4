// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulator/simulator_diagnostics.h"

#include <ros/console.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <utility>

#include "model/scene/tool_kinds.h"

namespace viscera::nodes {
namespace {

using Level = diagnostic_msgs::DiagnosticStatus;

constexpr double kPeriod_s = 1;

float fromBits(uint32_t bits) {
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

void addLatency(const std::string& name, const LatencyMeter::Reading& reading,
                diagnostic_updater::DiagnosticStatusWrapper& status) {
  status.add(name + "_mean_ms", 1e3 * reading.mean_s);
  status.add(name + "_max_ms", 1e3 * reading.max_s);
  status.add(name + "_p50_ms", 1e3 * reading.p50_s);
  status.add(name + "_p99_ms", 1e3 * reading.p99_s);
}

void warnOfSlowness(const PaceMeter::Reading& pace, double tick_s) {
  ROS_WARN(
      "slower than real time: factor %.2g for 2 s, a tick of %.3g ms takes %.3g ms. Possible remedies: a coarser "
      "bodies[].spacing_m, or 'auto'; a larger solver.dt_fraction, or solver.integrator 'pd'; fewer or smaller images "
      "(cameras[].rate_hz, width_px, height_px) and a lower ~surface_rate_hz; fewer other programs",
      pace.real_time_factor, 1e3 * tick_s, 1e3 * pace.step_mean_s);
}

}  // namespace

SimulatorDiagnostics::SimulatorDiagnostics(ros::NodeHandle node, const Scene& scene, SimulationLoop& loop,
                                           const Publishers& publishers, const Inputs& inputs,
                                           const ObstacleFrames& obstacles, const CameraFrames& camera_frames)
    : loop_(loop),
      publishers_(publishers),
      inputs_(inputs),
      obstacles_(obstacles),
      camera_frames_(camera_frames),
      scene_(scene.name),
      tick_s_(1 / scene.solver.tick_hz),
      pictures_(scene.cameras),
      dropped_before_(inputs.size(), 0),
      updater_(node) {
  for (const CameraConfig& camera : scene.cameras) cameras_.push_back(camera.name);
  takeLatencies();
  updater_.setHardwareID("none");
  updater_.add("simulation", this, &SimulatorDiagnostics::simulation);
  updater_.add("pace", this, &SimulatorDiagnostics::pace);
  updater_.add("latency", this, &SimulatorDiagnostics::latency);
  for (size_t i = 0; i < inputs_.size(); ++i)
    updater_.add(inputs_[i]->mailbox().config().name, [this, i](Status& status) { stylus(i, status); });
  if (!obstacles_.empty()) updater_.add("obstacles", this, &SimulatorDiagnostics::obstacles);
  if (!camera_frames_.empty()) updater_.add("cameras", this, &SimulatorDiagnostics::cameras);
  // Uses the steady clock: the updater's own period follows ROS time, which may stand still.
  timer_ = node.createSteadyTimer(ros::WallDuration(kPeriod_s), [this](const ros::SteadyTimerEvent&) { update(); });
}

void SimulatorDiagnostics::update() {
  now_ = loop_.takeStatus();
  takeLatencies();
  if (now_) updater_.setHardwareID(now_->pictures ? now_->gpu : "none");
  addProcesses();
  watchPictures();
  updater_.force_update();
}

/// Adds a status for each process of the scene once the session exists.
void SimulatorDiagnostics::addProcesses() {
  if (!now_) return;
  for (const FactGroup& group : now_->facts) {
    if (!processes_.insert(group.name).second) continue;
    updater_.add(group.name, [this, name = group.name](Status& status) { process(name, status); });
  }
}

/// Warns of slow images. A simulation slower than real time makes fewer; while paused, images are sent on changes only.
void SimulatorDiagnostics::watchPictures() {
  if (!now_ || !now_->pictures) return;
  if (!std::exchange(logged_paths_, true)) {
    for (const std::string& path : pictures_.renderPaths(now_->software_gpu)) ROS_INFO("%s", path.c_str());
  }
  std::vector<double> wanted_hz = latencies_.images_wanted_hz;
  for (double& rate_hz : wanted_hz) rate_hz *= now_->paused ? 0 : std::min(1.0, now_->pace.real_time_factor);
  for (const std::string& line : pictures_.record(wanted_hz, latencies_.image_rates_hz)) ROS_WARN("%s", line.c_str());
}

void SimulatorDiagnostics::takeLatencies() {
  latencies_ = publishers_.frames.takeLatencies();
  force_latencies_ = publishers_.wrenches.takeLatencies();
  stats_before_ = std::move(stats_);
  stats_ = publishers_.wrenches.stats();
}

void SimulatorDiagnostics::simulation(Status& status) {
  if (const int percent = publishers_.preparing_percent(); percent >= 0) status.add("preparing_percent", percent);
  if (!now_) return status.summary(Level::OK, "preparing");
  status.summary(Level::OK, now_->paused ? "paused" : "running");
  if (now_->stats.crowded)
    status.summaryf(Level::WARN, "%u nodes have no contacts: too many are at one position for the collision search",
                    now_->stats.crowded);
  if (now_->health.recovering) status.summary(Level::WARN, "recovering from an instability: no forces");
  if (now_->stats.nonfinite) status.summary(Level::ERROR, "nodes are not finite; call reset");
  status.add("gpu", now_->gpu);
  status.add("gpu_is_software", now_->software_gpu);
  status.add("backend", now_->backend);
  status.add("stepped_by", now_->stepped_by);
  status.add("scene", scene_);
  status.add("tick", now_->tick);
  status.add("paused", now_->paused);
  status.add("recording", publishers_.recordings.file());
  status.add("dt_s", now_->dt_s);
  status.add("dt_safe_s", now_->dt_safe_s);
  status.add("dt_limit_s", now_->dt_limit_s);
  status.add("nonfinite_nodes", now_->stats.nonfinite);
  status.add("max_stretch", fromBits(now_->stats.max_stretch_bits));
  status.add("max_speed_m_per_s", fromBits(now_->stats.max_speed_bits));
  status.add("roll_backs", now_->health.trips);
  status.add("recovering", now_->health.recovering);
  status.add("strained", now_->health.strained);
  status.add("kinetic_energy_j", now_->stats.kinetic_j);
  status.add("elastic_energy_j", now_->stats.elastic_j);
  status.add("springs_collapsed", now_->stats.collapsed);
  status.add("cells_inverted", now_->stats.inverted);
  status.add("nodes_crowded", now_->stats.crowded);
  status.add("springs_cut", now_->stats.springs_cut);
  status.add("wound_holes", now_->counters.wound_holes);
  status.add("wound_slivers", now_->counters.wound_slivers);
  status.add("ticks", now_->counters.ticks);
  status.add("substeps", now_->counters.substeps);
  status.add("mappings", now_->counters.mappings);
  status.add("renders", now_->counters.renders);
  status.add("read_backs", now_->counters.readbacks);
  status.add("images_repeated", now_->counters.repeats);
  status.add("frames_skipped", now_->counters.skipped);
}

void SimulatorDiagnostics::pace(Status& status) {
  if (!now_) return status.summary(Level::OK, "preparing");
  const PaceMeter::Reading& pace = now_->pace;
  const bool slow = !now_->paused && pace.real_time_factor < AdaptiveResolution::kSlow;
  status.summary(slow ? Level::WARN : Level::OK, slow ? "slower than real time" : "real time");
  if (!now_->paused && slowness_.record(slow)) warnOfSlowness(pace, tick_s_);
  const std::string finer =
      now_->paused ? "" : publishers_.adaptive_resolution.record(pace.real_time_factor, now_->tick);
  if (!finer.empty()) ROS_WARN("%s", finer.c_str());
  if (!slow && pictures_.areBehind())
    status.summary(Level::WARN, "real time, but pictures have less than a third of their rate");
  if (publishers_.wrenches.stalled()) status.summary(Level::WARN, "ticks are late: forces are zero");
  status.add("real_time_factor", pace.real_time_factor);
  status.add("step_mean_ms", 1e3 * pace.step_mean_s);
  status.add("step_max_ms", 1e3 * pace.step_max_s);
  status.add("stalls", publishers_.wrenches.stalls());
  const std::string scheduling = publishers_.wrenches.scheduling();
  status.add("haptic_scheduling", scheduling.empty() ? "none" : scheduling);
  status.add("surface_rate_hz", latencies_.surface_rate_hz);
  for (size_t i = 0; i < cameras_.size(); ++i) status.add("image_rate_hz_" + cameras_[i], latencies_.image_rates_hz[i]);
}

void SimulatorDiagnostics::latency(Status& status) {
  status.summary(Level::OK, "from the arrival of a pose to the sending of the response");
  for (size_t i = 0; i < inputs_.size(); ++i)
    addLatency("pose_to_force_" + inputs_[i]->mailbox().config().name, force_latencies_[i], status);
  addLatency("pose_to_surface", latencies_.surface, status);
  for (size_t i = 0; i < cameras_.size(); ++i) addLatency("pose_to_image_" + cameras_[i], latencies_.images[i], status);
}

void SimulatorDiagnostics::obstacles(Status& status) {
  const uint64_t missed = obstacles_.missed();
  const bool missing = missed > missed_before_;
  missed_before_ = missed;
  const uint64_t speed_limited = obstacles_.speedLimited();
  const bool jumping = speed_limited > speed_limited_before_;
  speed_limited_before_ = speed_limited;
  status.summary(missing || jumping ? Level::WARN : Level::OK,
                 missing   ? "a frame is unknown or too old: its obstacle keeps its pose"
                 : jumping ? "faster than tissue can follow: speed limited"
                           : "carried");
  status.add("frames_found", obstacles_.found());
  status.add("frames_missed", missed);
  status.add("ticks_speed_limited", speed_limited);
}

void SimulatorDiagnostics::cameras(Status& status) {
  const uint64_t missed = camera_frames_.missed();
  const bool missing = missed > std::exchange(cameras_missed_before_, missed);
  status.summary(missing ? Level::WARN : Level::OK,
                 missing ? "a frame is unknown or too old: its camera keeps its pose" : "carried");
  status.add("frames_found", camera_frames_.found());
  status.add("frames_missed", missed);
}

/// Reports all facts of a process, as in metrics.json.
void SimulatorDiagnostics::process(const std::string& name, Status& status) {
  status.summary(Level::OK, "preparing");
  for (const FactGroup& group : now_ ? now_->facts : FactGroups{}) {
    if (group.name != name) continue;
    status.summary(group.warns ? Level::WARN : Level::OK, group.summary);
    for (const auto& [key, value] : flatFacts(group)) status.add(key, value);
  }
}

void SimulatorDiagnostics::stylus(size_t index, Status& status) {
  StylusInput& input = *inputs_[index];
  const StylusStatus in = input.mailbox().status(std::chrono::steady_clock::now());
  const uint64_t dropped = std::accumulate(in.dropped.begin(), in.dropped.end(), uint64_t{0});
  const bool dropping = dropped > dropped_before_[index];
  dropped_before_[index] = dropped;

  status.summary(Level::OK, in.seen ? "tracked" : "no pose yet");
  if (in.stale) status.summary(input.hasPublisher() ? Level::WARN : Level::OK, "the last pose is stale");
  if (now_ && now_->speed_limited[index]) status.summary(Level::WARN, "faster than tissue can follow: speed limited");
  const std::string rivals = input.rivals();
  if (!rivals.empty()) status.summary(Level::WARN, "several nodes send poses: " + rivals);
  if (now_ && now_->inside[index])
    status.summary(Level::WARN, "appeared inside tissue: no force until the tip has been outside");
  if (now_ && now_->shafts_touch) status.summary(Level::WARN, "its shaft pushes the other stylus's shaft");
  if (dropping) status.summary(Level::WARN, "messages are dropped");
  status.add("device", input.mailbox().device().about);
  status.add("has_publisher", input.hasPublisher());
  status.add("input_age_s", in.input_age_s);
  status.add("poses_accepted", in.accepted);
  status.add("button_presses_ignored", in.button_presses_ignored);
  status.add("clutched", in.clutched);
  status.add("base_moves", in.base_moves);
  for (size_t i = 0; i < kDropReasons; ++i)
    status.add(std::string("dropped_") + text(static_cast<Drop>(i)), in.dropped[i]);
  if (index < stats_.size()) {
    const ForceLoop::HapticStats& stats = stats_[index];
    const uint64_t before = index < stats_before_.size() ? stats_before_[index].updates : 0;
    status.add("haptic_answers", stats.updates);
    status.add("haptic_rate_hz", static_cast<double>(stats.updates - before) / kPeriod_s);
    status.add("energy_j", stats.energy_j);
    status.add("least_energy_j", stats.least_j);
    status.add("stiffness_scale", stats.stiffness_scale);
  }
  if (!now_) return;
  const char* const switches[] = {"idle", "button1", "button2"};
  for (size_t i = 0; i < now_->modes[index].size(); ++i) status.add(switches[i], kindOf(now_->modes[index][i]).name);
  status.add("force_n", now_->reactions[index].force_n.norm());
  status.add("force_saturated", now_->reactions[index].saturated);
  status.add("nodes_touched", now_->stats.touched[index]);
  status.add("nodes_held", now_->stats.grabbed[index]);
}

}  // namespace viscera::nodes
