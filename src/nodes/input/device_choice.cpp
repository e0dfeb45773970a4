// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/input/device_choice.h"

#include <algorithm>
#include <utility>

#include "nodes/ros/scene_choice.h"
#include "viscera/model/scene/stylus_config.h"

namespace viscera::nodes {
namespace {

/// Splits each item of a list at the first `mark`.
std::vector<std::pair<std::string, std::string>> itemsOf(Parameters& parameters, const std::string& key, char mark,
                                                         const std::string& as_in) {
  std::vector<std::pair<std::string, std::string>> out;
  for (const std::string& item : parameters.texts(key)) {
    const size_t at = item.find(mark);
    if (at == std::string::npos || at == 0 || at + 1 == item.size())
      throw ParameterError("parameter ~" + key + ": '" + item + "' does not have the form " + as_in);
    out.emplace_back(item.substr(0, at), item.substr(at + 1));
  }
  return out;
}

}  // namespace

void setProfile(DeviceChoice& choice, const std::string& text) {
  const size_t colon = text.find(':');
  choice.profile = text.substr(0, colon);
  if (colon != std::string::npos) choice.name = text.substr(colon + 1);
}

DeviceChoice& DeviceChoices::of(const std::string& stylus, const std::string& parameter) {
  for (Named& named : named_)
    if (named.choice.stylus == stylus) return named.choice;
  named_.push_back({{}, parameter});
  named_.back().choice.stylus = stylus;
  return named_.back().choice;
}

DeviceChoices DeviceChoices::read(Parameters& parameters) {
  DeviceChoices out;
  for (const auto& [stylus, device] : itemsOf(parameters, "devices", '=', "left=polhemus:2"))
    setProfile(out.of(stylus, "devices"), device);
  for (const auto& [stylus, option] : itemsOf(parameters, "device_options", '.', "left.scale=0.5"))
    out.of(stylus, "device_options").overrides.push_back(option);
  for (const auto& [stylus, file] : itemsOf(parameters, "registrations", '=', "left=/path/to/registration.yaml"))
    out.of(stylus, "registrations").registration = file;
  return out;
}

void DeviceChoices::requireKnown(const std::vector<StylusConfig>& styluses) const {
  std::string known;
  for (const StylusConfig& stylus : styluses) known += " " + stylus.name;
  for (const Named& named : named_) {
    const std::string& name = named.choice.stylus;
    if (std::none_of(styluses.begin(), styluses.end(), [&](const StylusConfig& stylus) { return stylus.name == name; }))
      throw ParameterError("parameter ~" + named.parameter + ": the scene has no stylus '" + name + "'; it has" +
                           (known.empty() ? " none" : known));
  }
}

std::vector<DeviceProfile> DeviceChoices::load(const std::vector<StylusConfig>& styluses,
                                               const std::string& package_folder) const {
  std::vector<DeviceProfile> out;
  for (const StylusConfig& stylus : styluses) {
    DeviceChoice choice;
    choice.stylus = stylus.name;
    for (const Named& named : named_)
      if (named.choice.stylus == stylus.name) choice = named.choice;
    out.push_back(loadDevice(namedFile("devices", choice.profile, package_folder + "/config/devices"), choice));
  }
  return out;
}

}  // namespace viscera::nodes
