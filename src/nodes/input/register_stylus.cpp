// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/input/register_stylus.h"

#include <ros/console.h>
#include <ros/spinner.h>

#include <chrono>
#include <filesystem>
#include <thread>
#include <utility>

#include "devices/millimetres.h"
#include "nodes/input/device_choice.h"
#include "nodes/input/device_subscribers.h"
#include "nodes/input/stylus_mailbox.h"
#include "nodes/ros/conversions.h"
#include "nodes/ros/scene_choice.h"

namespace viscera::nodes {
namespace {

using Clock = std::chrono::steady_clock;
using Mode = RegisterOptions::Mode;

constexpr std::chrono::milliseconds kPeriod{4};  ///< period of tf lookups; half of the period of the fastest trackers
constexpr size_t kLeastHeldPoses = 5;            ///< fewer poses do not show whether a point was held still
constexpr double kPointWindow_s = 0.5, kPivotWindow_s = 10;
constexpr double kMostMm = 1000;
constexpr size_t kMostPoses = 100000;  ///< largest number of poses in a window: 100 s of a device of 1 kHz
constexpr uint32_t kPoseQueue = 1000;  ///< queue of poses; none may be lost while another is processed
constexpr int kThreads = 3;            ///< threads for a waiting collect, another call, and the poses

Clock::duration span(double seconds) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace

/// Returns units and axes of the device. The transform to the tissue is left out, since it is to be found.
DeviceProfile deviceOf(Parameters& parameters, const std::string& stylus, const std::string& package_folder) {
  DeviceChoice choice;
  choice.stylus = stylus;
  setProfile(choice, parameters.text("device", "crtk"));
  choice.overrides = parameters.texts("device_options");
  DeviceProfile device = loadDevice(namedFile("device", choice.profile, package_folder + "/config/devices"), choice);
  if (device.pose.type == PoseType::kCrtkArm)
    throw ParameterError("parameter ~device: an arm follows commands and needs no registration");
  device.tip = device.base = {};
  device.scale = 1;
  return device;
}

RegisterOptions registerOptions(Parameters& parameters, const std::string& package_folder) {
  RegisterOptions options;
  const std::string mode = parameters.text("mode", "");
  if (mode != "pivot" && mode != "points") throw ParameterError("parameter ~mode: must be pivot or points");
  options.mode = mode == "pivot" ? Mode::kPivot : Mode::kPoints;
  options.stylus = parameters.text("stylus", options.stylus);
  options.device = deviceOf(parameters, options.stylus, package_folder);
  options.tf_frame = parameters.text("tf_frame", options.device.pose.tf_frame);
  options.tf_base = parameters.text("tf_base", options.device.pose.tf_base);
  options.file = parameters.text("file", "");
  const std::string points = parameters.text("points", "");
  options.window_s =
      parameters.number("window_s", options.mode == Mode::kPivot ? kPivotWindow_s : kPointWindow_s, 0.1, 100);
  options.max_residual_m = 1e-3 * parameters.number("max_residual_mm", 3, 1e-3, kMostMm);
  options.max_motion_m = 1e-3 * parameters.number("max_motion_mm", 1, 1e-3, kMostMm);
  parameters.refuseOthers();

  if (options.file.empty()) throw ParameterError("parameter ~file: must name the file to write");
  if (options.tf_frame.empty() != options.tf_base.empty())
    throw ParameterError("parameters ~tf_frame and ~tf_base: set both or neither");
  if (options.mode == Mode::kPoints) {
    if (points.empty()) throw ParameterError("parameter ~points: must name a file of known points in mode points");
    options.points = loadKnownPoints(points);
  } else if (!points.empty()) {
    throw ParameterError("parameter ~points: is not used in mode pivot; remove it");
  }
  if (std::filesystem::exists(options.file)) options.known = loadRegistration(options.file);
  return options;
}

RegisterStylus::RegisterStylus(const RegisterOptions& options)
    : options_(options), private_("~"), map_(options.device), found_(options.known) {
  if (options_.tf_frame.empty())
    pose_subscriber_ = listenToPoses(node_, options_.device.pose, kPoseQueue,
                                     [this](const DevicePose& pose, const std::string&) { onPose(pose); });
  else
    listener_ = std::make_unique<tf2_ros::TransformListener>(frames_);
  button_subscriber_ = listenToButtons(node_, options_.device.button1,
                                       [this](const std::vector<int32_t>& values) { onButtons(values); });
  services_ = {private_.advertiseService("collect", &RegisterStylus::collect, this),
               private_.advertiseService("discard", &RegisterStylus::discard, this),
               private_.advertiseService("solve", &RegisterStylus::solve, this)};
}

void RegisterStylus::run() {
  ros::AsyncSpinner spinner(kThreads);
  spinner.start();
  if (options_.mode == Mode::kPoints && !found_.tip_m)
    ROS_WARN("%s has no tip; poses are assumed to be those of the tip itself (run ~mode:=pivot first)",
             options_.file.c_str());
  ROS_INFO("%s", next().c_str());
  while (ros::ok()) {
    master_.require();
    if (!options_.tf_frame.empty()) updateFromTf();
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (is_open_ && Clock::now() >= end_) {
        last_ = close();
        if (last_.good)
          ROS_INFO("%s", last_.text.c_str());
        else
          ROS_WARN("%s", last_.text.c_str());
      }
    }
    std::this_thread::sleep_for(kPeriod);
  }
  closed_.notify_all();
}

std::string RegisterStylus::next() const {
  if (options_.mode == Mode::kPivot)
    return "keep the tip in one place and tilt the device to all sides for " + rounded(options_.window_s, 1) +
           " s; start with button 1 or `collect`, then call `solve`";
  if (touched_.size() == options_.points.size()) return "all points are touched; call `solve`";
  return "touch '" + options_.points[touched_.size()].name + "' (" + std::to_string(touched_.size() + 1) + " of " +
         std::to_string(options_.points.size()) + "), hold still, then press button 1 or call `collect`";
}

void RegisterStylus::onPose(const DevicePose& pose) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (pose.stamp.isZero()) {
    ++refused_;
    return;
  }
  take(pose.frame, pose.pose);
}

void RegisterStylus::updateFromTf() {
  try {
    const auto found = frames_.lookupTransform(options_.tf_base, options_.tf_frame, ros::Time(0));
    const std::lock_guard<std::mutex> lock(mutex_);
    if (std::exchange(tf_stamp_, found.header.stamp) != found.header.stamp)
      take(options_.tf_base, fromMessage(found.transform));
  } catch (const tf2::TransformException&) {  // not there yet; a window without poses reports it
  }
}

void RegisterStylus::take(const std::string& frame, const Pose& said) {
  if (!is_open_) return;
  if (!isFinite(said) || !isUnit(said.orientation) || poses_.size() >= kMostPoses) {
    ++refused_;
    return;
  }
  Pose pose = map_.toBase(said);
  pose.orientation.normalize();
  if (frame_.empty()) frame_ = frame;
  frame_changed_ = frame_changed_ || frame != frame_;
  poses_.push_back(pose);
}

void RegisterStylus::onButtons(const std::vector<int32_t>& values) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const size_t index = static_cast<size_t>(options_.device.button1.index);
  const bool down = index < values.size() && values[index] != 0;
  if (down && !std::exchange(pressed_, down)) open();
  pressed_ = down && values[index] != 2;  // CRTK: 2 is a click, pressed and released
}

/// Opens a window. @return  whether it was closed before
bool RegisterStylus::open() {
  if (is_open_) return false;
  is_open_ = true;
  frame_changed_ = false;
  refused_ = 0;
  poses_.clear();
  end_ = Clock::now() + span(options_.window_s);
  return true;
}

RegisterStylus::Outcome RegisterStylus::close() {
  is_open_ = false;
  ++windows_;
  closed_.notify_all();
  const Outcome out = judge();
  if (pivots_.empty() && touched_.empty()) frame_.clear();  // the frame may change if nothing in it is kept
  return out;
}

RegisterStylus::Outcome RegisterStylus::judge() {
  const std::string refused =
      refused_ ? "; " + std::to_string(refused_) + " invalid poses were left out" : std::string();
  if (frame_changed_) return {false, "the frame of the poses changed (it was '" + frame_ + "'); nothing is kept"};
  if (poses_.size() < kLeastHeldPoses) {
    const std::string from = options_.tf_frame.empty() ? node_.resolveName(options_.device.pose.topic)
                                                       : "tf, " + options_.tf_base + " to " + options_.tf_frame;
    return {false, std::to_string(poses_.size()) + " poses came from " + from + " in " + rounded(options_.window_s, 1) +
                       " s; " + std::to_string(kLeastHeldPoses) + " are needed" + refused};
  }
  Outcome out = options_.mode == Mode::kPivot ? closePivot(poses_) : closePoint(poses_);
  out.text += refused;
  return out;
}

RegisterStylus::Outcome RegisterStylus::closePivot(const std::vector<Pose>& poses) {
  pivots_.push_back(poses);
  return {true, std::to_string(poses.size()) + " poses; call `collect` again, or `solve`"};
}

RegisterStylus::Outcome RegisterStylus::closePoint(const std::vector<Pose>& poses) {
  if (touched_.size() == options_.points.size()) return {false, next()};
  const Vector3d tip_m = found_.tip_m.value_or(Vector3d::Zero());
  Vector3d mean_m = Vector3d::Zero();
  for (const Pose& pose : poses) mean_m += pose * tip_m / static_cast<double>(poses.size());
  double squares = 0;
  for (const Pose& pose : poses) squares += (pose * tip_m - mean_m).squaredNorm();
  const double spread_m = std::sqrt(squares / static_cast<double>(poses.size()));
  const std::string& name = options_.points[touched_.size()].name;
  if (!(spread_m <= options_.max_motion_m))
    return {false, "'" + name + "': the tip moved by " + millimetres(spread_m) + " mm (RMS); at most " +
                       millimetres(options_.max_motion_m) + " mm is accepted. Touch it again"};
  touched_.push_back(mean_m);
  return {true, "'" + name + "' is touched; the tip moved by " + millimetres(spread_m) + " mm (RMS); " + next()};
}

bool RegisterStylus::collect(Trigger::Request&, Trigger::Response& response) {
  std::unique_lock<std::mutex> lock(mutex_);
  response.success = open();
  response.message = "poses are being collected already";
  if (!response.success) return true;
  const uint64_t before = windows_;
  while (windows_ == before && ros::ok()) closed_.wait_for(lock, kPeriod);
  response.success = last_.good && windows_ != before;
  response.message = last_.text;
  return true;
}

bool RegisterStylus::discard(Trigger::Request&, Trigger::Response& response) {
  const std::lock_guard<std::mutex> lock(mutex_);
  response.success = !(options_.mode == Mode::kPivot ? pivots_.empty() : touched_.empty());
  if (response.success && options_.mode == Mode::kPivot) pivots_.pop_back();
  if (response.success && options_.mode == Mode::kPoints) touched_.pop_back();
  if (pivots_.empty() && touched_.empty()) frame_.clear();
  response.message = response.success ? "the last one is discarded; " + next() : "there is nothing to discard";
  return true;
}

bool RegisterStylus::solve(Trigger::Request&, Trigger::Response& response) {
  const std::lock_guard<std::mutex> lock(mutex_);
  Outcome out;
  try {
    out = solveAndSave();
  } catch (const RegistrationError& error) {
    out = {false, error.what()};
  }
  if (out.good)
    ROS_INFO("%s", out.text.c_str());
  else
    ROS_WARN("%s", out.text.c_str());
  response.success = out.good;
  response.message = out.text;
  return true;
}

RegisterStylus::Outcome RegisterStylus::solveAndSave() {
  RegistrationFile found = found_;
  std::string text;
  if (options_.mode == Mode::kPivot) {
    std::vector<Pose> poses;
    for (const std::vector<Pose>& window : pivots_) poses.insert(poses.end(), window.begin(), window.end());
    const Pivot pivot = solvePivot(poses, {options_.max_residual_m});
    text = "tip at [" + millimetres(pivot.tip_m.x()) + ", " + millimetres(pivot.tip_m.y()) + ", " +
           millimetres(pivot.tip_m.z()) + "] mm, residual " + millimetres(pivot.residual_m) + " mm, turned " +
           rounded(pivot.turned, 2);
    if (found.base) text += "; the base was found with another tip and is dropped";
    found = {pivot.tip_m, std::nullopt, pivot.residual_m};
  } else {
    const Registration registration = solveRegistration(options_.points, touched_, {options_.max_residual_m});
    text = "base of '" + frame_ + "' found, residual " + millimetres(registration.residual_m) +
           " mm (each: " + distancesText(options_.points, registration) + " mm)";
    found.base = registration.base;
    found.residual_m = registration.residual_m;
  }
  saveRegistration(found, options_.file);
  found_ = found;
  return {true, text + "; written to " + options_.file};
}

}  // namespace viscera::nodes
