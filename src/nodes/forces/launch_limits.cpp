// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/forces/launch_limits.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <limits>
#include <sstream>

namespace viscera::nodes {
namespace {

constexpr std::pair<const char*, double StylusConfig::*> kLimits[] = {
    {"max_force_n", &StylusConfig::max_force_n},
    {"max_force_rate_n_per_s", &StylusConfig::max_force_rate_n_per_s},
    {"max_torque_nm", &StylusConfig::max_torque_nm},
    {"max_torque_rate_nm_per_s", &StylusConfig::max_torque_rate_nm_per_s}};

/// Returns whether an override sets this key of a stylus: the key itself, the whole stylus, or the list of all
/// styluses.
bool sets(const std::string& override_text, size_t stylus, const std::string& key) {
  const size_t equals = override_text.find('=');
  const std::string path = override_text.substr(0, equals), one = "styluses[" + std::to_string(stylus) + "]";
  if (path == one + "." + key) return true;
  if (path != one && path != "styluses") return false;
  const YAML::Node value = YAML::Load(override_text.substr(equals + 1));
  const YAML::Node keys = path == one ? value : value[stylus];
  return keys.IsMap() && keys[key].IsDefined();
}

}  // namespace

LaunchLimits::LaunchLimits(const std::vector<StylusConfig>& styluses, const Overrides& overrides) {
  for (size_t s = 0; s < styluses.size(); ++s) {
    Named named{styluses[s].name, {}};
    for (const auto& [name, key] : kLimits) {
      const auto set = [&, name = name](const std::string& text) { return sets(text, s, name); };
      if (std::any_of(overrides.begin(), overrides.end(), set)) named.limits.emplace_back(key, styluses[s].*key);
    }
    styluses_.push_back(std::move(named));
  }
}

double LaunchLimits::limitOf(const std::string& stylus, Key key) const {
  const auto is = [&](const Named& named) { return named.stylus == stylus; };
  const bool known = std::any_of(styluses_.begin(), styluses_.end(), is);
  double least = std::numeric_limits<double>::infinity();
  for (const Named& named : styluses_) {
    if (known && !is(named)) continue;
    for (const auto& [which, limit] : named.limits)
      if (which == key) least = std::min(least, limit);
  }
  return least;
}

std::vector<std::string> LaunchLimits::bound(std::vector<StylusConfig>& styluses) const {
  std::vector<std::string> notes;
  for (StylusConfig& stylus : styluses) {
    for (const auto& [name, key] : kLimits) {
      const double limit = limitOf(stylus.name, key);
      if (stylus.*key <= limit) continue;
      std::ostringstream note;
      note << "stylus " << stylus.name << ": " << name << " is " << limit
           << ", as set by the ~overrides of the launch file, not " << stylus.*key;
      notes.push_back(note.str());
      stylus.*key = limit;
    }
  }
  return notes;
}

}  // namespace viscera::nodes
