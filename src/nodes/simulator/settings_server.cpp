// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulator/settings_server.h"

#include <dynamic_reconfigure/ConfigDescription.h>
#include <ros/console.h>

#include <algorithm>
#include <utility>

#include "math/number_text.h"
#include "viscera/math/error.h"

namespace viscera::nodes {
namespace {

/// Returns one value of every setting as a message. @param numberOf, wordOf  callables that take a setting
template <class NumberOf, class WordOf>
dynamic_reconfigure::Config configOf(const std::vector<Setting>& settings, NumberOf numberOf, WordOf wordOf) {
  dynamic_reconfigure::Config out;
  for (const Setting& setting : settings) {
    if (setting.isNumber()) {
      out.doubles.emplace_back();
      out.doubles.back().name = setting.name;
      out.doubles.back().value = numberOf(setting);
    } else {
      out.strs.emplace_back();
      out.strs.back().name = setting.name;
      out.strs.back().value = wordOf(setting);
    }
  }
  out.groups.emplace_back();
  out.groups.back().name = "Default";
  out.groups.back().state = true;
  return out;
}

dynamic_reconfigure::Config valuesOf(const std::vector<Setting>& settings) {
  return configOf(
      settings, [](const Setting& s) { return s.number; }, [](const Setting& s) { return s.word; });
}

/// Returns the words as clients evaluate them: as a Python dictionary.
std::string editMethod(const Setting& setting) {
  if (setting.isNumber()) return "";
  std::string out = "{'enum_description': '" + setting.name + "', 'enum': [";
  for (const std::string& word : setting.choices) {
    out += "{'name': '" + word + "', 'type': 'str', 'value': '" + word +
           "', 'ctype': 'std::string', 'cconsttype': 'const char * const', 'srcline': 0, 'srcfile': '', "
           "'description': '" +
           word + "'}, ";
  }
  return out + "]}";
}

dynamic_reconfigure::ConfigDescription descriptionOf(const std::vector<Setting>& settings) {
  dynamic_reconfigure::ConfigDescription out;
  dynamic_reconfigure::Group group;
  group.name = "Default";
  for (const Setting& setting : settings) {
    dynamic_reconfigure::ParamDescription parameter;
    parameter.name = setting.name;
    parameter.type = setting.isNumber() ? "double" : "str";
    parameter.description = setting.meaning;
    parameter.edit_method = editMethod(setting);
    group.parameters.push_back(parameter);
  }
  out.groups.push_back(group);
  const auto word = [](const Setting& s) { return s.word; };
  const auto none = [](const Setting&) { return std::string(); };
  out.min = configOf(
      settings, [](const Setting& s) { return s.min; }, none);
  out.max = configOf(
      settings, [](const Setting& s) { return s.max; }, none);
  out.dflt = configOf(
      settings, [](const Setting& s) { return s.number; }, word);
  return out;
}

}  // namespace

SettingsServer::SettingsServer(ros::NodeHandle node, std::vector<Setting> settings, Apply apply)
    : namespace_(node.getNamespace()), apply_(std::move(apply)), settings_(std::move(settings)) {
  descriptions_ = node.advertise<dynamic_reconfigure::ConfigDescription>("parameter_descriptions", 1, true);
  updates_ = node.advertise<dynamic_reconfigure::Config>("parameter_updates", 1, true);
  descriptions_.publish(descriptionOf(settings_));
  updates_.publish(valuesOf(settings_));
  server_ = node.advertiseService("set_parameters", &SettingsServer::onSet, this);
}

/// Returns a setting. @throws Error  there is none
const Setting& SettingsServer::find(const std::string& name, bool number) const {
  for (const Setting& setting : settings_) {
    if (setting.name == name && setting.isNumber() == number) return setting;
  }
  std::string known;
  for (const Setting& setting : settings_) known += " " + setting.name;
  throw Error("no " + std::string(number ? "number" : "word") + " '" + name + "'; accepted:" + known);
}

/// Returns the settings that the request changes. @throws Error  an unknown name, a value out of range
std::vector<Setting> SettingsServer::changesOf(const dynamic_reconfigure::Config& request) const {
  std::vector<Setting> out;
  for (const auto& wanted : request.doubles) {
    Setting setting = find(wanted.name, true);
    if (!(wanted.value >= setting.min && wanted.value <= setting.max)) {
      TextOut text;
      text << wanted.name << ": " << wanted.value << " is outside " << setting.min << ".." << setting.max;
      throw Error(text.str());
    }
    if (setting.number == wanted.value) continue;
    setting.number = wanted.value;
    out.push_back(setting);
  }
  for (const auto& wanted : request.strs) {
    Setting setting = find(wanted.name, false);
    if (std::find(setting.choices.begin(), setting.choices.end(), wanted.value) == setting.choices.end()) {
      std::string known;
      for (const std::string& word : setting.choices) known += (known.empty() ? "" : ", ") + word;
      throw Error(wanted.name + ": '" + wanted.value + "' is not one of " + known);
    }
    if (setting.word == wanted.value) continue;
    setting.word = wanted.value;
    out.push_back(setting);
  }
  if (!request.bools.empty() || !request.ints.empty())
    throw Error("flags and whole numbers are not accepted: there are no such settings");
  return out;
}

/// Serves a request. The protocol has no field for an error: it is logged, and the response has the current values.
bool SettingsServer::onSet(dynamic_reconfigure::Reconfigure::Request& request,
                           dynamic_reconfigure::Reconfigure::Response& response) {
  try {
    std::vector<Setting> changed;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      changed = changesOf(request.config);
    }
    if (!changed.empty()) {
      apply_(changed);
      keep(changed);
    }
  } catch (const Error& error) {
    ROS_WARN("%s/set_parameters: refused: %s", namespace_.c_str(), error.what());
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  response.config = valuesOf(settings_);
  updates_.publish(response.config);
  return true;
}

void SettingsServer::keep(const std::vector<Setting>& changed) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const Setting& now : changed) {
    for (Setting& setting : settings_) {
      if (setting.name == now.name) setting = now;
    }
  }
}

void SettingsServer::recordWord(const std::string& name, const std::string& word) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (Setting& setting : settings_) {
    if (setting.name == name) setting.word = word;
  }
  updates_.publish(valuesOf(settings_));
}

}  // namespace viscera::nodes
