// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulator/simulator_settings.h"

#include <ros/node_handle.h>

#include <algorithm>
#include <utility>

#include "model/scene/scene_fields.h"
#include "model/scene/tool_kinds.h"
#include "viscera/session/session.h"

namespace viscera::nodes {
namespace {

constexpr std::chrono::seconds kLimit{10};  ///< enough for a slow tick
constexpr const char* kSwitches[] = {"idle", "button1", "button2"};

/// Visitor of a struct's scene keys that collects ranges and meanings of some numbers.
class SomeKeys {
 public:
  explicit SomeKeys(std::vector<std::string> names) : names_(std::move(names)) {}

  void number(const char* key, double& value, Range range, const char* unit, const char* text) {
    for (const std::string& name : names_) {
      if (name != key) continue;
      settings.push_back({name, std::string(text) + " [" + unit + "]", range.min, range.max, value, {}, ""});
      values.push_back(&value);
    }
  }
  template <class... Other>
  void text(Other&&...) {}
  void integer(const char*, int&, Range, const char*) {}
  template <class... Other>
  void boolean(Other&&...) {}
  void vector(const char*, Vector3d&, Range, const char*, const char*) {}
  template <class... Other>
  void names(Other&&...) {}
  template <class... Other>
  void group(Other&&...) {}
  template <class E>
  void choice(const char*, E&, Choices<E>, const char*) {}
  template <class E, class List>
  void choice(const char*, E&, const List&, const char*) {}

  std::vector<Setting> settings;
  std::vector<double*> values;  ///< [settings] pointers into the struct

 private:
  const std::vector<std::string> names_;
};

SomeKeys limitsOf(StylusConfig& config) {
  SomeKeys keys({"max_force_n", "max_force_rate_n_per_s", "max_torque_nm", "max_torque_rate_nm_per_s"});
  visitFields(keys, config);
  return keys;
}

std::string nameOf(ToolMode mode) {
  return kindOf(mode).name;
}

ToolMode simulatorSettingsModeNamed(const std::string& name) {
  for (const ToolKind& kind : kToolKinds) {
    if (name == kind.name) return kind.mode;
  }
  throw Error("mode '" + name + "' is unknown");
}

Setting modeSetting(const char* name, ToolMode mode) {
  Setting out{name, std::string("tool mode of the stylus: ") + name, 0, 0, 0, {}, nameOf(mode)};
  for (const ToolKind& kind : kToolKinds) out.choices.emplace_back(kind.name);
  return out;
}

}  // namespace

SimulatorSettings::SimulatorSettings(const SimulatorOptions& options, CommandQueue& commands,
                                     const Publishers& publishers)
    : commands_(commands), publishers_(publishers), styluses_(options.scene.styluses), spinner_(1, &queue_) {
  addSurface(options);
  for (size_t s = 0; s < styluses_.size(); ++s) addStylus(s, styluses_[s]);
  for (size_t c = 0; c < options.scene.cameras.size(); ++c) addCamera(c, options.scene.cameras[c]);
  spinner_.start();
}

SimulatorSettings::~SimulatorSettings() {
  spinner_.stop();
}

/// Runs a change on the simulation thread, between ticks. @throws Error  reason of the failure
void SimulatorSettings::change(const std::function<void(Session&)>& make) {
  Command command;
  command.kind = Command::Kind::kChange;
  command.change = [make](Session& session) {
    make(session);
    return std::string();
  };
  const CommandAnswer answer = commands_.call(std::move(command), kLimit);
  if (!answer.success) throw Error(answer.message);
}

void SimulatorSettings::addSurface(const SimulatorOptions& options) {
  ros::NodeHandle node("~");
  node.setCallbackQueue(&queue_);
  const Setting rate = {"surface_rate_hz",
                        "largest rate at which surface and surface_marker are sent [Hz]",
                        SimulatorOptions::kLeastSurfaceRate_hz,
                        SimulatorOptions::kMostSurfaceRate_hz,
                        options.publish.surface_rate_hz,
                        {},
                        ""};
  other_servers_.push_back(
      std::make_unique<SettingsServer>(node, std::vector<Setting>{rate}, [this](const std::vector<Setting>& changed) {
        const double rate_hz = changed.at(0).number;
        change([this, rate_hz](Session&) { publishers_.frames.setSurfaceRate(rate_hz); });
      }));
}

void SimulatorSettings::addCamera(size_t camera, const CameraConfig& config) {
  ros::NodeHandle node("~cameras/" + config.name);
  node.setCallbackQueue(&queue_);
  CameraConfig keys = config;
  SomeKeys rate({"rate_hz"});
  visitFields(rate, keys);
  other_servers_.push_back(
      std::make_unique<SettingsServer>(node, rate.settings, [this, camera](const std::vector<Setting>& changed) {
        const double rate_hz = changed.at(0).number;
        change([this, camera, rate_hz](Session&) { publishers_.frames.setImageRate(camera, rate_hz); });
      }));
}

void SimulatorSettings::addStylus(size_t stylus, const StylusConfig& config) {
  ros::NodeHandle node("~" + config.name);
  node.setCallbackQueue(&queue_);
  std::vector<Setting> settings = limitsOf(styluses_[stylus]).settings;
  // Anyone who reaches the master may only lower forces: scene and device profile say what is safe for the user.
  for (Setting& setting : settings) setting.max = setting.number;
  const ToolMode modes[] = {config.idle, config.button1, config.button2};
  for (size_t i = 0; i < 3; ++i) settings.push_back(modeSetting(kSwitches[i], modes[i]));
  stylus_servers_.push_back(
      std::make_unique<SettingsServer>(node, settings, [this, stylus](const std::vector<Setting>& changed) {
        StylusConfig next = styluses_[stylus];
        const SomeKeys keys = limitsOf(next);
        std::vector<std::pair<ToolSwitch, ToolMode>> modes;
        for (const Setting& setting : changed) {
          for (size_t i = 0; i < keys.settings.size(); ++i) {
            if (keys.settings[i].name == setting.name) *keys.values[i] = setting.number;
          }
          for (size_t i = 0; i < 3; ++i) {
            if (setting.name == kSwitches[i])
              modes.emplace_back(static_cast<ToolSwitch>(i), simulatorSettingsModeNamed(setting.word));
          }
        }
        // The scene may not allow cuts: cutting modes come first, so they are refused before anything has changed.
        std::stable_partition(modes.begin(), modes.end(), [](const auto& it) { return kindOf(it.second).severs(); });
        const ForceLimits limits = ForceLimits::of(next);
        change([this, stylus, modes, limits](Session& session) {
          for (const auto& [when, mode] : modes) session.setToolMode(stylus, when, mode);
          session.setForceLimits(stylus, limits);
          publishers_.wrenches.setLimits(stylus, limits);
        });
        styluses_[stylus] = next;
      }));
}

void SimulatorSettings::recordMode(size_t stylus, ToolSwitch when, ToolMode mode) {
  stylus_servers_[stylus]->recordWord(kSwitches[static_cast<size_t>(when)], nameOf(mode));
}

}  // namespace viscera::nodes
