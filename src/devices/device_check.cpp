// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "devices/device_check.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "devices/millimetres.h"
#include "math/number_text.h"
#include "model/scene/yaml/yaml_overrides.h"

namespace viscera {
namespace {

using Grade = Verdict::Grade;

constexpr double kLowRate_hz = 30, kGoodRate_hz = 60;  ///< rates [Hz]: below the first the tool jerks, below the second
                                                       ///< forces on stiff tissue buzz
constexpr double kLongGap_s = 0.05, kLongGaps = 3;     ///< long gap [s], and relative to the mean one
constexpr double kLost_s = 0.2;                        ///< time after which poses are stale in scenes [s]
constexpr double kOldStamp_s = 0.2;
constexpr double kTremble_m = 0.003;  ///< tremor of a device that is held still, RMS [m]
constexpr double kNorm = 0.1;         ///< tolerance of a quaternion's norm, as in the simulator
constexpr double kLeastForce_n = 0.05;
constexpr double kAgainst = 0.5;   ///< cosine
constexpr double kBefore_s = 0.5;  ///< time before a touch in which the device approaches [s]

Verdict rate(const std::vector<ReceivedPose>& heard, double span_s) {
  const double rate_hz = static_cast<double>(heard.size()) / span_s;
  const std::string text = "rate: " + rounded(rate_hz, 0) + " poses a second";
  if (rate_hz < kLowRate_hz) return {Grade::kWrong, text + ", too low: the tool moves in jerks; 100 or more is good"};
  if (rate_hz < kGoodRate_hz) return {Grade::kNote, text + ", low: stiff tissue may vibrate; 100 or more is good"};
  return {Grade::kRight, text};
}

Verdict gaps(const std::vector<ReceivedPose>& heard, double span_s) {
  double longest_s = 0;
  for (size_t i = 1; i < heard.size(); ++i) longest_s = std::max(longest_s, heard[i].came_s - heard[i - 1].came_s);
  const double mean_s = span_s / static_cast<double>(heard.size());
  const std::string text = "gaps: the longest " + rounded(1e3 * longest_s, 0) + " ms";
  if (longest_s > kLost_s)
    return {Grade::kWrong, text + ": the tool releases tissue in such a gap; the driver or the network hangs"};
  if (longest_s > std::max(kLongGap_s, kLongGaps * mean_s))
    return {Grade::kNote, text + ", jitter: the driver or the network is busy"};
  return {Grade::kRight, text};
}

Verdict stamps(const std::vector<ReceivedPose>& heard) {
  if (!heard.front().stamp_s)
    return {Grade::kNote, "stamps: messages of this type have none; the time of arrival is used"};
  std::set<double> different;
  std::vector<double> ages_s;
  for (const ReceivedPose& it : heard) {
    different.insert(*it.stamp_s);
    ages_s.push_back(it.clock_s - *it.stamp_s);
  }
  if (different.count(0) > 0)
    return {Grade::kWrong, "stamps: 0, which marks invalid poses; they are dropped", different.size() == 1};
  if (different.size() == 1)
    return {Grade::kWrong, "stamps: always the same; the driver hangs, and poses are dropped", heard.size() > 1};
  std::nth_element(ages_s.begin(), ages_s.begin() + static_cast<std::ptrdiff_t>(ages_s.size() / 2), ages_s.end());
  const double age_s = ages_s[ages_s.size() / 2];
  if (std::abs(age_s) > kOldStamp_s)
    return {Grade::kNote,
            "stamps: stale, " + rounded(age_s, 2) +
                " s old when poses arrive: another clock, which does no harm, or a driver that sends old poses"};
  return {Grade::kRight, "stamps: " + rounded(1e3 * age_s, 1) + " ms old when poses arrive"};
}

Verdict frames(const std::vector<ReceivedPose>& heard, const PosePort& port) {
  if (!port.frame.empty()) return {Grade::kRight, "frames: '" + port.frame + "', as the profile says"};
  std::set<std::string> names;
  for (const ReceivedPose& it : heard) names.insert(it.frame);
  if (names.size() > 1) {
    std::string text = "frames: poses come in several frames:";
    for (const std::string& name : names) text += " '" + name + "'";
    return {Grade::kWrong, text + "; several drivers on one topic?"};
  }
  if (names.begin()->empty())
    return {Grade::kNote, "frames: poses name no frame; `pose.frame` is used, or else the tissue frame"};
  return {Grade::kRight, "frames: '" + *names.begin() + "'"};
}

void judgeNumbers(const std::vector<ReceivedPose>& heard, double unit_m, std::vector<Verdict>& out) {
  size_t bad = 0, odd = 0;
  for (const ReceivedPose& it : heard) {
    const double norm = it.pose.orientation.norm();
    if (!it.pose.position_m.allFinite() || !std::isfinite(norm)) ++bad;
    if (!(std::abs(norm - 1) < kNorm)) ++odd;
  }
  const bool none_good = std::max(bad, odd) == heard.size();
  if (bad > 0)
    return out.push_back({Grade::kWrong, "numbers: " + std::to_string(bad) + " poses are not finite", none_good});
  if (odd > 0)
    out.push_back({Grade::kWrong,
                   "quaternions: the length of " + std::to_string(odd) +
                       " poses is not 1: not filled in, or not in the order x, y, z, w; they are dropped",
                   none_good});
  const double tremble_m = unit_m * trembleOf(heard);
  out.push_back(tremble_m > kTremble_m
                    ? Verdict{Grade::kNote, "still: it moved by " + millimetres(tremble_m) +
                                                " mm (RMS): not held still, another unit, or metal near the tracker"}
                    : Verdict{Grade::kRight, "still: within " + millimetres(tremble_m) + " mm (RMS)"});
}

std::string portText(const ButtonPort& port) {
  return port.topic + ", number " + std::to_string(port.index);
}

bool isSame(const ButtonPort& a, const ButtonPort& b) {
  return a.type == b.type && a.topic == b.topic && a.index == b.index;
}

}  // namespace

std::vector<Verdict> judgeStream(const std::vector<ReceivedPose>& heard, double span_s, const PosePort& port) {
  if (heard.empty()) return {{Grade::kWrong, "no pose arrived: does the driver run, and is the name right?"}};
  std::vector<Verdict> out = {rate(heard, span_s), gaps(heard, span_s), stamps(heard), frames(heard, port)};
  judgeNumbers(heard, port.unit_m, out);
  return out;
}

double trembleOf(const std::vector<ReceivedPose>& still) {
  Vector3d mean = Vector3d::Zero();
  for (const ReceivedPose& it : still) mean += it.pose.position_m / static_cast<double>(still.size());
  double squares = 0;
  for (const ReceivedPose& it : still) squares += (it.pose.position_m - mean).squaredNorm();
  return still.empty() ? 0 : std::sqrt(squares / static_cast<double>(still.size()));
}

std::optional<ButtonPort> pressedButton(const std::vector<ReceivedButton>& events, const ButtonPort& expected) {
  struct Course {
    ButtonPort port;
    int last = 0, changes = 0;
    bool down = false, up = false;
  };
  std::map<std::tuple<int, std::string, int>, Course> courses;
  for (const ReceivedButton& event : events) {
    Course& course = courses[{static_cast<int>(event.port.type), event.port.topic, event.port.index}];
    course.port = event.port;
    course.up = course.up || (course.down && event.value == 0) || event.value == 2;  // CRTK: 2 is a click
    course.down = course.down || event.value != 0;
    course.changes += event.value != course.last;
    course.last = event.value;
  }
  const Course* best = nullptr;
  for (const auto& [key, course] : courses) {
    if (!course.up) continue;
    if (isSame(course.port, expected)) return course.port;
    if (!best || course.changes < best->changes) best = &course;
  }
  return best ? std::optional<ButtonPort>(best->port) : std::nullopt;
}

Verdict judgeButton(const std::vector<ReceivedButton>& events, const ButtonPort& expected, const std::string& name) {
  const std::optional<ButtonPort> found = pressedButton(events, expected);
  const bool has = expected.type != ButtonType::kNone;
  if (found && isSame(*found, expected)) return {Grade::kRight, name + ": seen on " + portText(*found)};
  if (found)
    return {Grade::kWrong, name + ": not seen " + (has ? "on " + portText(expected) : std::string("in the profile")) +
                               ", but on " + portText(*found)};
  const bool silent = std::none_of(events.begin(), events.end(),
                                   [&](const ReceivedButton& event) { return event.port.topic == expected.topic; });
  return {Grade::kWrong, name + ": not seen" + (has ? " on " + portText(expected) : std::string()) +
                             (has && silent ? ", where no message arrived" : "") + ", nor on another button topic"};
}

Verdict judgeForce(const std::vector<ReceivedForce>& forces, const std::vector<ReceivedPose>& heard) {
  const auto positionAt = [&](double came_s) {
    Vector3d at = heard.empty() ? Vector3d(Vector3d::Zero()) : heard.front().pose.position_m;
    for (const ReceivedPose& it : heard) {
      if (it.came_s > came_s) break;
      at = it.pose.position_m;
    }
    return at;
  };
  bool touches = false;
  double most_n = 0, begun_s = 0;
  Vector3d displacement = Vector3d::Zero(), strongest_n = Vector3d::Zero();
  for (const ReceivedForce& force : forces) {
    const double size_n = force.force_n.norm();
    if (!std::exchange(touches, size_n >= kLeastForce_n) && touches) begun_s = force.came_s;
    if (size_n <= most_n) continue;
    most_n = size_n;
    strongest_n = force.force_n;
    displacement = positionAt(force.came_s) - positionAt(begun_s - kBefore_s);
  }
  const double cosine = strongest_n.dot(displacement) / std::max(most_n * displacement.norm(), 1e-300);
  if (forces.empty()) return {Grade::kNote, "force: none was sent; does a simulator run with this device?"};
  if (most_n < kLeastForce_n || displacement.norm() == 0)
    return {Grade::kNote, "force: " + rounded(most_n, 2) + " N at most; the tip did not enter tissue"};
  const std::string text = "force: up to " + rounded(most_n, 2) + " N, ";
  if (cosine < -kAgainst) return {Grade::kRight, text + "against the motion, out of the tissue"};
  if (cosine > kAgainst) return {Grade::kWrong, text + "along the motion: it would pull the device into the tissue"};
  return {Grade::kNote, text + "across the motion: push straight in and try again"};
}

Overrides correctionsOf(const FoundMap& map, const DeviceProfile& profile) {
  Overrides out;
  if (map.unit_m && *map.unit_m != profile.pose.unit_m) {
    TextOut unit;
    unit << *map.unit_m;
    out.push_back("pose.unit_m=" + unit.str());
  }
  const auto quoted = [](const std::string& axes) { return "\"" + axes + "\""; };
  const std::string axes = map.axes.value_or(profile.pose.axes);
  const std::string turns_now = profile.pose.turn_axes.empty() ? profile.pose.axes : profile.pose.turn_axes;
  const std::string turns = map.turn_axes.value_or(map.axes && profile.pose.turn_axes.empty() ? axes : turns_now);
  if (axes != profile.pose.axes) out.push_back("pose.axes=" + quoted(axes));
  if (turns != (profile.pose.turn_axes.empty() ? axes : profile.pose.turn_axes))
    out.push_back("pose.turn_axes=" + quoted(turns));
  return out;
}

std::string correctedProfile(const std::string& yaml, const Overrides& overrides,
                             const std::vector<std::string>& about) {
  YAML::Node root = YAML::Load(yaml);
  YamlSource source{"the corrected profile", {}};
  for (const std::string& text : overrides) applyOverride(root, text, source);
  YAML::Emitter out;
  out << root;
  std::string text;
  for (const std::string& line : about) text += "# " + line + "\n";
  text += std::string(out.c_str()) + "\n";
  DeviceChoice choice;
  choice.stylus = "left";
  parseDevice(text, source.name, choice);
  return text;
}

}  // namespace viscera
