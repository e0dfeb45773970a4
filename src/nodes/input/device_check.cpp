// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/input/device_check.h"

#include <poll.h>
#include <ros/spinner.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "devices/device_map.h"
#include "devices/millimetres.h"
#include "math/number_text.h"
#include "math/one_line.h"
#include "math/out_file.h"
#include "model/scene/yaml/yaml_reader.h"
#include "nodes/input/device_choice.h"
#include "nodes/input/device_subscribers.h"
#include "nodes/ros/conversions.h"
#include "nodes/ros/scene_choice.h"

namespace viscera::nodes {
namespace {

using Grade = Verdict::Grade;

constexpr const char* kDevice = "device_";
constexpr const char* kAssign = ":=";
constexpr const char* kWrite = "--write";
constexpr std::chrono::milliseconds kPoll{100};
constexpr std::chrono::milliseconds kConnect{500};  ///< time for subscribers and tf to find the publishers
constexpr std::chrono::seconds kFirstPose{5};       ///< patience for the first pose; a busy machine connects late,
                                                    ///< which is no fault of the device
constexpr double kFeel_s = 12;                      ///< duration for touching tissue [s]
constexpr int kTries = 3;
const Vector3d kFront_m(0, -0.09, 0);  ///< stylus position for devices with an unknown base: in front of the organ [m]
constexpr double kUpwards = 0.5;       ///< smallest cosine for an upward motion: user motions deviate from straight,
                                       ///< axes differ by 90 degrees

void say(const std::string& text) {
  std::printf("%s\n", text.c_str());
  std::fflush(stdout);
}

std::string portText(const ButtonPort& port) {
  return "{type: " + std::string(port.type == ButtonType::kJoy ? "joy" : "omni_button") + ", topic: \"" + port.topic +
         "\", index: " + std::to_string(port.index) + "}";
}

std::string numbers(const std::vector<double>& values) {
  TextOut out;
  for (size_t i = 0; i < values.size(); ++i) out << (i ? "," : "") << std::round(1e6 * values[i]) / 1e6;
  return "[" + out.str() + "]";
}

}  // namespace

DeviceCheckOptions takeArguments(std::vector<std::string>& arguments) {
  DeviceCheckOptions options;
  options.choice.stylus = "left";
  std::vector<std::string> others;
  for (size_t i = 0; i < arguments.size(); ++i) {
    const std::string& text = arguments[i];
    const size_t assign = text.find(kAssign);
    if (text == kWrite) {
      if (++i == arguments.size()) throw ParameterError("--write: must be followed by the file name of the profile");
      options.write = arguments[i];
    } else if (text.rfind(kDevice, 0) == 0 && assign != std::string::npos) {
      if (options.has_profile) throw ParameterError(text + ": accepts one device at a time");
      options.choice.stylus = text.substr(std::string(kDevice).size(), assign - std::string(kDevice).size());
      setProfile(options.choice, text.substr(assign + std::string(kAssign).size()));
      options.has_profile = true;
      if (options.choice.stylus == "options")
        throw ParameterError("device_options: unknown here; use _device_options:=\"pose.unit_m=0.001;...\"");
    } else {
      others.push_back(text);
    }
  }
  arguments = others;
  return options;
}

void readParameters(Parameters& parameters, DeviceCheckOptions& options) {
  options.write = parameters.text("write", options.write);
  options.choice.overrides = parameters.texts("device_options");
  options.tissue_frame = parameters.text("tissue_frame", options.tissue_frame);
  options.window_s = parameters.number("window_s", options.window_s, 0.5, 60);
  parameters.refuseOthers();
  if (!options.write.empty() && std::filesystem::exists(options.write))
    throw ParameterError("--write: " + options.write + " already exists and is not overwritten");
  if (!options.has_profile && !options.choice.overrides.empty())
    throw ParameterError("parameter ~device_options: needs a profile; name it with device_left:=PROFILE");
}

DeviceCheck::DeviceCheck(const DeviceCheckOptions& options) : options_(options), listener_(frames_) {}

std::string DeviceCheck::line() {
  while (true) {
    const size_t at = typed_.find('\n');
    if (at != std::string::npos) {
      const std::string out = typed_.substr(0, at);
      typed_.erase(0, at + 1);
      if (out == "q") throw Left();
      return out;
    }
    pollfd input{STDIN_FILENO, POLLIN, 0};
    const int ready = poll(&input, 1, static_cast<int>(kPoll.count()));
    if (end_->waitFor(std::chrono::milliseconds(0))) throw Left();
    master_.require();
    if (ready <= 0) continue;
    char some[256];
    const ssize_t count = read(STDIN_FILENO, some, sizeof some);
    if (count <= 0) throw Left();
    typed_.append(some, static_cast<size_t>(count));
  }
}

/// Asks the user to continue. @returns false if the step is skipped
bool DeviceCheck::ask(const std::string& text) {
  say("\n" + text);
  return line() != "s";
}

DeviceListener::Heard DeviceCheck::record(const std::string& meanwhile, double span_s) {
  say("   " + meanwhile + " ... " + rounded(span_s, 0) + " s");
  ear_->begin();
  if (end_->waitFor(std::chrono::milliseconds(static_cast<int64_t>(1e3 * span_s)))) throw Left();
  return ear_->end();
}

void DeviceCheck::tell(const Verdict& verdict) {
  const char* const marks[] = {"   right  ", "   note   ", "   WRONG  "};
  say(marks[static_cast<int>(verdict.grade)] + oneLine(verdict.text));
  wrong_ += verdict.grade == Grade::kWrong;
  notes_ += verdict.grade == Grade::kNote;
  helps_ = helps_ && !verdict.beyond_profile;
}

/// Chooses the topic without a profile: the one that moves when the device is moved.
void DeviceCheck::chooseTopic() {
  const std::vector<PoseTopic> topics = poseTopics();
  if (topics.empty())
    throw Error(
        "no node publishes PoseStamped, TransformStamped or Pose: start the device's driver. For a tracker in tf, "
        "name the profile: device_left:=tf:FRAME, device_left:=polhemus:1");
  std::vector<std::vector<Pose>> poses(topics.size());
  std::mutex mutex;
  std::vector<ros::Subscriber> listeners;
  for (size_t i = 0; i < topics.size(); ++i) {
    PosePort port;
    port.topic = topics[i].topic;
    port.type = topics[i].type;
    listeners.push_back(listenToPoses(node_, port, 100, [&, i](const DevicePose& pose, const std::string&) {
      const std::lock_guard<std::mutex> lock(mutex);
      if (poses[i].size() < 100000) poses[i].push_back(pose.pose);
    }));
  }
  ask("No profile was named. Press Enter, then move the device about.");
  say("   move it about ... " + rounded(options_.window_s, 0) + " s");
  if (end_->waitFor(std::chrono::milliseconds(static_cast<int64_t>(1e3 * options_.window_s)))) throw Left();
  for (ros::Subscriber& listener : listeners) listener.shutdown();
  const std::lock_guard<std::mutex> lock(mutex);
  std::optional<size_t> chosen;
  for (size_t i = 0; i < topics.size(); ++i) {
    Eigen::AlignedBox3d box;
    for (const Pose& pose : poses[i]) box.extend(pose.position_m);
    const bool moved = !poses[i].empty() && box.sizes().norm() > 0;
    say("   " + topics[i].topic + ": " + std::to_string(poses[i].size()) + " poses, " +
        (moved ? "it moves: profile " + topics[i].profile : std::string("it does not move")));
    if (moved && (!chosen || poses[i].size() > poses[*chosen].size())) chosen = i;
  }
  if (!chosen) throw Error("no pose changed: does the driver of this device run, and on this master?");
  setProfile(options_.choice, topics[*chosen].profile);
  options_.choice.overrides = {"pose.topic=\"" + topics[*chosen].topic + "\""};
  corrections_ = options_.choice.overrides;
}

void DeviceCheck::open() {
  const DeviceChoice& choice = options_.choice;
  const std::string path =
      namedFile(kDevice + choice.stylus, choice.profile, options_.package_folder + "/config/devices");
  yaml_ = textOf(path, "device profile");
  device_ = loadDevice(path, choice);
  if (device_.pose.type == PoseType::kCrtkArm)
    throw ParameterError("profile " + choice.profile + ": an arm follows commands, so there is nothing to check");
  for (const std::string& text : choice.overrides)
    if (corrections_.empty() || corrections_.front() != text) corrections_.push_back(text);
  if (!choice.name.empty()) corrections_.push_back("name=\"" + choice.name + "\"");
  ear_ = std::make_unique<DeviceListener>(node_, device_, frames_);
  std::this_thread::sleep_for(kConnect);
  const auto late = std::chrono::steady_clock::now() + kFirstPose;
  while (!ear_->heardPose() && std::chrono::steady_clock::now() < late)
    if (end_->waitFor(kPoll)) throw Left();
  const PosePort& port = device_.pose;
  say("profile " + choice.profile + " (" + device_.about + ") for the stylus '" + choice.stylus + "', poses from " +
      (port.type == PoseType::kTf ? "tf, " + port.tf_base + " to " + port.tf_frame : port.topic));
  say("Enter continues, s skips a step, q quits.");
}

DeviceProfile DeviceCheck::corrected() const {
  DeviceChoice choice;
  choice.stylus = options_.choice.stylus;
  return parseDevice(correctedProfile(yaml_, corrections_, {}), options_.choice.profile, choice);
}

bool DeviceCheck::holdStill() {
  if (!ask(std::to_string(++steps_) + ". Hold the handle upright, its tip down, in front of you, and still; Enter."))
    return true;
  const DeviceListener::Heard heard = record("hold still", options_.window_s);
  for (const Verdict& verdict : judgeStream(heard.poses, heard.span_s, device_.pose)) tell(verdict);
  still_ = heard.poses;
  if (!still_.empty()) return true;
  for (const PoseTopic& topic : poseTopics()) say("   found " + topic.topic + ", which fits profile " + topic.profile);
  return false;
}

/// Finds the transform between the frame of the poses and the tissue, as the simulator would.
void DeviceCheck::findBase() {
  if (device_.base.given) {
    base_ = device_.base.orientation;
    return;
  }
  std::string frame = device_.pose.frame;
  if (frame.empty()) frame = device_.pose.type == PoseType::kTf ? device_.pose.tf_base : "";
  if (frame.empty() && !still_.empty()) frame = still_.front().frame;
  if (frame.empty() || frame == options_.tissue_frame) return;
  try {
    const auto found = frames_.lookupTransform(options_.tissue_frame, frame, ros::Time(0));
    base_ = fromMessage(found.transform).orientation.normalized();
    tell({Grade::kRight, "base: tf connects '" + frame + "' to '" + options_.tissue_frame + "'"});
  } catch (const tf2::TransformException&) {
    knows_base_ = false;
    tell({Grade::kNote, "base: tf does not connect '" + frame + "' to '" + options_.tissue_frame +
                            "' (does a simulator run?): a written profile places the position of step 1 in front of "
                            "the organ; register_stylus finds the base of a tracker"});
  }
}

void DeviceCheck::move(Asked asked, const std::string& text) {
  ++steps_;
  for (int i = 0; i < kTries; ++i) {
    if (!ask(std::to_string(steps_) + ". Enter, then " + text + " and stay there.")) return;
    const std::optional<DeviceMotion> motion = motionOf(record(text, options_.window_s).poses);
    const std::optional<std::string> fault =
        motion ? unclear(asked, *motion, trembleOf(still_)) : std::string("too few valid poses arrived");
    if (!fault) {
      motions_.of(asked) = motion;
      return tell(judgeMotion(asked, *motion, device_, base_));
    }
    if (i + 1 == kTries) return tell({Grade::kWrong, *fault});
    say("   again: " + *fault);
  }
}

void DeviceCheck::judgeMap() {
  const FoundMap map = findMap(motions_, device_, base_);
  for (const Verdict& verdict : map.verdicts) tell(verdict);
  for (const std::string& text : correctionsOf(map, device_)) corrections_.push_back(text);
  const DeviceProfile now = corrected();
  if (still_.empty()) return;
  const FoundTip tip = findTip(still_.back().pose, now, base_);
  tell(tip.verdict);
  const Quaterniond q = tip.orientation.value_or(Quaterniond::Identity());
  if (tip.orientation) corrections_.push_back("tip.orientation_xyzw=" + numbers({q.x(), q.y(), q.z(), q.w()}));
  if (knows_base_) return;
  const Vector3d at = kFront_m - DeviceMap(corrected()).tipOf(still_.back().pose).tip.position_m;
  corrections_.push_back("base.position_m=" + numbers({at.x(), at.y(), at.z()}));
}

void DeviceCheck::press(const ButtonPort& port, const std::string& key, const std::string& text) {
  if (!ask(std::to_string(++steps_) + ". Enter, then press " + text + " once and release it; s: the device has none."))
    return;
  const DeviceListener::Heard heard = record("press and let go", options_.window_s);
  tell(judgeButton(heard.buttons, port, key));
  const std::optional<ButtonPort> found = pressedButton(heard.buttons, port);
  if (found && (found->topic != port.topic || found->index != port.index || found->type != port.type))
    corrections_.push_back(key + "=" + portText(*found));
}

/// Checks forces. The simulator sends them, within its limits; this program sends none.
void DeviceCheck::feel() {
  const ForcePort& port = device_.force;
  if (port.type == ForceType::kNone) return say("\nforces: this profile has none");
  const DeviceMap map(corrected());
  const Vector3d up = map.axesFromBase() * (base_.conjugate() * Vector3d::UnitZ());
  say("\nforces: a push of the tissue upwards is sent to the device as " + numbers({up.x(), up.y(), up.z()}) +
      " times the force, along its own axes, on " + port.topic);
  if (motions_.up)
    tell(up.dot(motions_.up->displacement.normalized()) > kUpwards
             ? Verdict{Grade::kRight, "force: up matches the direction in which the device was moved up"}
             : Verdict{Grade::kWrong,
                       "force: this is not the direction in which the device was moved up; do not use forces"});
  if (!ear_->hasForces()) return say("   no simulator sends it forces: start one with this profile to feel them");
  say("\n" + std::to_string(++steps_) + ". A simulator sends it forces, " + rounded(port.max_force_n, 1) +
      " N at most. To feel them type yes, then touch the tissue from above, push in a little, and come out; Enter: "
      "no.");
  if (line() != "yes") return say("   skipped");
  const DeviceListener::Heard heard = record("touch the tissue", kFeel_s);
  tell(judgeForce(heard.forces, heard.poses));
  say("   Did you feel a push out of the tissue? y: yes; n: into it or sideways; Enter: nothing was felt");
  const std::string answered = line();
  if (answered == "y") return tell({Grade::kRight, "force: felt out of the tissue"});
  if (answered != "n") return tell({Grade::kNote, "force: not felt: motors off, another topic, or too weak"});
  tell({Grade::kWrong, "force: felt in another direction than it was sent: the driver has other axes for forces"});
  corrections_.push_back("force={type: none}");
  say("   the written profile sends none until the driver is fixed");
}

void DeviceCheck::write(const std::string& file) {
  const std::string text =
      correctedProfile(yaml_, corrections_,
                       {"Written by `rosrun viscera device_check`, from the profile " + options_.choice.profile + "."});
  if (std::filesystem::exists(file)) throw Error(file + " already exists and is not overwritten");
  writeFile(file, FileKind::kText, text);
  const std::string& stylus = options_.choice.stylus;
  const std::string path = std::filesystem::absolute(file).string();
  say("written: " + file);
  say(stylus == "left" || stylus == "right"
          ? "roslaunch viscera training.launch device_" + stylus + ":=" + path
          : "roslaunch viscera training.launch devices:=\"" + stylus + "=" + path + "\"");
}

/// Prints the summary. @returns whether a profile can correct the device
bool DeviceCheck::finish() {
  say("\n" + std::to_string(wrong_) + " wrong, " + std::to_string(notes_) + " to note");
  if (!helps_) {
    say("No profile makes the tool follow this device: fix its driver first. No profile is written.");
    return false;
  }
  for (const std::string& text : corrections_) say("   " + text);
  if (!options_.write.empty()) {
    write(options_.write);
  } else if (corrections_.empty()) {
    say("the profile is right as it is");
  } else {
    say("Write a profile with these to which file? Enter: none");
    const std::string file = line();
    if (!file.empty()) write(file);
  }
  return true;
}

bool DeviceCheck::run(EndWatch& end) {
  end_ = &end;
  ros::AsyncSpinner spinner(1);
  spinner.start();
  try {
    if (!options_.has_profile) chooseTopic();
    open();
    if (!holdStill()) return false;
    findBase();
    const std::string far = rounded(100 * kAskedMotion_m, 0) + " cm ";
    move(Asked::kRight, "move the handle " + far + "to the right");
    move(Asked::kUp, "move it " + far + "up");
    move(Asked::kTowards, "move it " + far + "towards you");
    move(Asked::kTurnLeft, "turn it by 45 degrees about its upright shaft, counter-clockwise seen from above");
    move(Asked::kTiltRight, "tilt its top by 45 degrees to the right");
    move(Asked::kTiltAway, "tilt its top by 45 degrees away from you");
    judgeMap();
    press(device_.button1, "button1", "the first button");
    press(device_.button2, "button2", "the second button");
    feel();
    return finish();
  } catch (const Left&) {
    say("\nended early; nothing is written");
    return false;
  }
}

}  // namespace viscera::nodes
