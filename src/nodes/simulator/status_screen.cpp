// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulator/status_screen.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "math/number_text.h"
#include "math/one_line.h"

namespace viscera::nodes {
namespace {

constexpr size_t kIndent = 14;         ///< column of the text, after the name
constexpr size_t kFewestColumns = 40;  ///< a narrower window wraps lines itself
const std::string kDropped = "dropped_";
const std::string kImageRate = "image_rate_hz_";

bool begins(const std::string& text, const std::string& with) {
  return text.compare(0, with.size(), with) == 0;
}

/// Formats a number. @param as  text with one of %.Nf or %.Ng
std::string format(const std::string& as, double number) {
  const size_t at = as.find("%.");
  const int digits = as[at + 2] - '0';
  return as.substr(0, at) + (as[at + 3] == 'f' ? fixedText(number, digits) : numberText(number, digits)) +
         as.substr(at + 4);
}

std::string textOf(const ReceivedStatus& status, const std::string& key) {
  const auto found = status.values.find(key);
  return found == status.values.end() ? "" : found->second;
}

double numberOf(const ReceivedStatus& status, const std::string& key) {
  return readNumber(textOf(status, key)).value_or(0);
}

bool isTrue(const ReceivedStatus& status, const std::string& key) {
  return textOf(status, key) == "True" || textOf(status, key) == "1";
}

bool isStylus(const ReceivedStatus& status) {
  return status.values.count("poses_accepted") > 0;
}

const ReceivedStatus* partOf(const std::vector<ReceivedStatus>& statuses, const std::string& node,
                             const std::string& part) {
  const auto found = std::find_if(statuses.begin(), statuses.end(),
                                  [&](const ReceivedStatus& it) { return it.node == node && it.part == part; });
  return found == statuses.end() ? nullptr : &*found;
}

std::vector<std::string> simulatorsOf(const std::vector<ReceivedStatus>& statuses, const StatusView& view) {
  std::vector<std::string> out;
  for (const ReceivedStatus& status : statuses)
    if (status.part == "simulation" && (view.simulator.empty() || view.simulator == status.node))
      out.push_back(status.node);
  return out;
}

/// Lines of a name and a text, broken between words.
class Screen {
 public:
  explicit Screen(size_t columns) : columns_(std::max(columns, kFewestColumns)) {}
  void title(const std::string& text) { text_ += (text_.empty() ? "" : "\n") + oneLine(text) + "\n"; }
  void say(const std::string& whose, const std::string& said) {
    std::string line = "  " + oneLine(whose);
    line.resize(std::max(line.size() + 1, kIndent), ' ');
    size_t words = 0;
    TextIn in(oneLine(said));
    for (std::string word; in >> word; ++words) {
      if (words > 0 && line.size() + 1 + word.size() > columns_) {
        text_ += line + "\n";
        line.assign(kIndent, ' ');
        words = 0;
      }
      line += (words > 0 ? " " : "") + word;
    }
    text_ += line + "\n";
  }
  std::string text() const { return text_; }

 private:
  const size_t columns_;
  std::string text_;
};

std::string simulationText(const ReceivedStatus& status) {
  std::string out = status.message;
  if (status.values.count("tick")) out += ", tick " + textOf(status, "tick");
  if (status.values.count("stepped_by")) out += ", stepped by " + textOf(status, "stepped_by");
  return out;
}

std::string paceText(const ReceivedStatus& status) {
  if (!status.values.count("real_time_factor")) return status.message;
  std::string out = format("%.2f of real time", numberOf(status, "real_time_factor"));
  out += format(": a step takes %.3g ms", numberOf(status, "step_mean_ms"));
  out += format(", %.3g ms at most", numberOf(status, "step_max_ms"));
  return out;
}

std::string ratesText(const ReceivedStatus& pace) {
  std::string out = format("surface and markers %.3g /s", numberOf(pace, "surface_rate_hz"));
  bool none = numberOf(pace, "surface_rate_hz") == 0;
  for (const auto& [key, value] : pace.values) {
    if (!begins(key, kImageRate)) continue;
    const double rate_hz = readNumber(value).value_or(0);
    none = none || rate_hz == 0;
    out += ", pictures of " + key.substr(kImageRate.size()) + format(" %.3g /s", rate_hz);
  }
  return none ? out + " (topics without a subscriber are not made)" : out;
}

std::string stylusText(const ReceivedStatus& stylus) {
  if (numberOf(stylus, "poses_accepted") == 0) {
    const std::string device = " (" + textOf(stylus, "device") + ")";
    return isTrue(stylus, "has_publisher") ? "no pose yet, although a device is connected" + device
                                           : "no device: no poses arrive" + device;
  }
  std::string out = stylus.message;
  if (!isTrue(stylus, "has_publisher")) out += ", poses no longer arrive";
  if (stylus.values.count("force_n")) out += format("; force %.3g N", numberOf(stylus, "force_n"));
  if (isTrue(stylus, "force_saturated")) out += " (the limit)";
  if (isTrue(stylus, "clutched")) out += "; clutched";
  if (stylus.values.count("nodes_touched")) {
    out += format("; touches %.0f nodes", numberOf(stylus, "nodes_touched"));
    out += format(", holds %.0f", numberOf(stylus, "nodes_held"));
  }
  if (stylus.values.count("haptic_rate_hz")) out += format("; %.0f forces/s", numberOf(stylus, "haptic_rate_hz"));
  return out + format("; last pose %.0f ms ago", 1e3 * numberOf(stylus, "input_age_s"));
}

void sayDrops(Screen& screen, const ReceivedStatus& stylus) {
  for (const auto& [key, value] : stylus.values) {
    if (!begins(key, kDropped) || readNumber(value).value_or(0) == 0) continue;
    const std::string reason = key.substr(kDropped.size());
    const std::string meaning = meaningOfDrop(reason);
    screen.say("", value + " messages dropped since the start, " + reason + (meaning.empty() ? "" : ": " + meaning));
  }
}

void saySimulator(Screen& screen, const std::vector<ReceivedStatus>& statuses, const std::string& node) {
  const ReceivedStatus& simulation = *partOf(statuses, node, "simulation");
  screen.title(node + format(", heard %.1f s ago", simulation.age_s));
  if (simulation.age_s > kSilent_s)
    screen.say(
        "WRONG",
        "it is silent, although it should send every second: it has ended, hangs, or the network is down. The values "
        "below are old");
  screen.say("simulation", simulationText(simulation));
  if (const ReceivedStatus* pace = partOf(statuses, node, "pace")) {
    screen.say("pace", paceText(*pace));
    if (pace->values.count("surface_rate_hz")) screen.say("sends", ratesText(*pace));
  }
  for (const ReceivedStatus& status : statuses) {
    if (status.node != node || !isStylus(status)) continue;
    screen.say(status.part, stylusText(status));
    sayDrops(screen, status);
  }
  bool well = simulation.age_s <= kSilent_s;
  for (const ReceivedStatus& status : statuses) {
    if (status.node != node || status.level == 0) continue;
    screen.say(status.level > 1 ? "ERROR" : "WARNING", status.part + ": " + status.message);
    well = false;
  }
  if (well) screen.say("wrong", "nothing");
}

void sayNobody(Screen& screen, const std::vector<ReceivedStatus>& statuses, const StatusView& view) {
  const std::string wanted = view.simulator.empty() ? "simulator" : "simulator '" + view.simulator + "'";
  if (view.watched_s < kSilent_s) return screen.title("waiting for /diagnostics of a " + wanted);
  std::vector<std::string> others;
  for (const ReceivedStatus& status : statuses)
    if (std::find(others.begin(), others.end(), status.node) == others.end()) others.push_back(status.node);
  screen.title("no " + wanted);
  if (others.empty()) {
    screen.say("WRONG", format("no /diagnostics for %.0f s: no simulator runs on the master ", kSilent_s) +
                            view.master_uri + ", or it cannot reach this machine (ROS_IP, ROS_HOSTNAME)");
    return screen.say("", "start one with roslaunch viscera training.launch");
  }
  std::string names;
  for (const std::string& other : others) names += " " + other;
  screen.say("WRONG", "nodes that send /diagnostics:" + names);
}

}  // namespace

std::string meaningOfDrop(const std::string& reason) {
  static const std::map<std::string, std::string> kMeanings = {
      {"stamp_zero", "the device says that its pose is invalid"},
      {"not_finite", "a pose, or the transform to the tissue, is NaN or infinite"},
      {"bad_quaternion", "its length is not 1: the message is not filled in, or not in the order x, y, z, w"},
      {"no_transform",
       "tf does not connect the frame of the poses to the tissue frame: publish a transform, or set frame"},
      {"old_transform", "the transform of the frame is old: its broadcaster has died, or clocks differ"},
      {"repeated_stamp", "the stamp does not change: the driver hangs"},
      {"delayed", "poses are late: the network, or the machine of the driver, is busy"},
      {"outside_workspace", "too far from the tissue: the wrong frame or unit (millimetres?), or workspace_m is small"},
      {"no_buttons", "the message lacks the button or joint that the profile names"},
      {"button_value", "the value of a button is not 0, 1 or 2"},
      {"jaw_angle", "jaws are open by more than half a turn; see gripper.rad_per_unit"},
      {"joint_count", "the message has more or fewer joints than the arm"}};
  const auto found = kMeanings.find(reason);
  return found == kMeanings.end() ? "" : found->second;
}

bool isSimulatorKnown(const std::vector<ReceivedStatus>& statuses, const StatusView& view) {
  const std::vector<std::string> nodes = simulatorsOf(statuses, view);
  return std::any_of(nodes.begin(), nodes.end(),
                     [&](const std::string& node) { return partOf(statuses, node, "simulation")->age_s <= kSilent_s; });
}

std::string statusScreen(const std::vector<ReceivedStatus>& statuses, const StatusView& view) {
  Screen screen(view.columns);
  const std::vector<std::string> simulators = simulatorsOf(statuses, view);
  for (const std::string& node : simulators) saySimulator(screen, statuses, node);
  if (simulators.empty()) sayNobody(screen, statuses, view);
  return screen.text();
}

}  // namespace viscera::nodes
