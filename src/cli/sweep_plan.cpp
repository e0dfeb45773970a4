// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/sweep_plan.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "cli/scene_lookup.h"
#include "math/nearest_names.h"
#include "model/scene/yaml/yaml_reader.h"
#include "viscera/math/error.h"

namespace viscera::cli {

namespace {

constexpr size_t kMostRuns = 1000000;
constexpr const char* kKeys = "scene, mesh, strokes, seconds, view, keep, set, grid, list";

class PlanFile {
 public:
  explicit PlanFile(std::string file) : file_(std::move(file)) {
    const std::string text = textOf(file_, "a sweep's plan");
    try {
      root_ = YAML::Load(text);
    } catch (const YAML::Exception& error) {
      throw SceneError(yamlFault(file_, error, text));
    }
    if (!root_.IsMap()) fail(root_, "a plan must be a map with keys out of " + std::string(kKeys));
    for (const auto& entry : root_) {
      const std::string key = entry.first.Scalar();
      static const std::vector<std::string> known = {"scene", "mesh", "strokes", "seconds", "view",
                                                     "keep",  "set",  "grid",    "list"};
      if (std::find(known.begin(), known.end(), key) == known.end())
        fail(entry.first, "unknown key '" + key + "'; accepted here: " + nearestFirstText(key, known));
    }
  }

  std::string scalar(const char* key) const {
    const YAML::Node node = root_[key];
    if (!node) return "";
    if (!node.IsScalar() || node.Scalar().empty()) fail(node, std::string("'") + key + "' must be a single value");
    return node.Scalar();
  }
  /// Returns the path of a file relative to the plan, or as on the command line.
  std::string path(const char* key) const {
    const std::string given = scalar(key);
    const auto beside = std::filesystem::path(file_).parent_path() / given;
    std::error_code error;
    return !given.empty() && std::filesystem::exists(beside, error) ? beside.string() : given;
  }
  bool flag(const char* key) const {
    const std::string given = scalar(key);
    if (given != "" && given != "true" && given != "false")
      fail(root_[key], std::string("'") + key + "' must be true or false; found '" + given + "'");
    return given == "true";
  }
  KeyValues set() const { return root_["set"] ? keyValues(root_["set"], "'set'") : KeyValues{}; }

  std::vector<KeyValues> list() const {
    const YAML::Node node = root_["list"];
    if (!node) return {{}};
    if (!node.IsSequence() || node.size() == 0) fail(node, "'list' must be a list of maps of scene keys, one per run");
    std::vector<KeyValues> out;
    for (const YAML::Node& run : node) out.push_back(keyValues(run, "an entry of 'list'"));
    return out;
  }
  std::vector<std::pair<std::string, std::vector<std::string>>> grid() const {
    std::vector<std::pair<std::string, std::vector<std::string>>> out;
    const YAML::Node node = root_["grid"];
    if (!node) return out;
    if (!node.IsMap()) fail(node, "'grid' must be a map of scene keys, each with a list of values");
    for (const auto& entry : node) {
      const std::string key = entry.first.Scalar();
      if (!entry.second.IsSequence() || entry.second.size() == 0)
        fail(entry.second.IsDefined() ? entry.second : entry.first, "'grid: " + key + "' must be a list of values");
      out.push_back({key, {}});
      for (const YAML::Node& value : entry.second) out.back().second.push_back(valueText(value));
    }
    return out;
  }
  /// Returns the line of the first occurrence of each scene key.
  std::map<std::string, int> lines() const {
    std::map<std::string, int> out;
    const auto add = [&](const YAML::Node& map) {
      for (const auto& entry : map) out.emplace(entry.first.Scalar(), entry.first.Mark().line + 1);
    };
    if (root_["set"]) add(root_["set"]);
    if (root_["grid"]) add(root_["grid"]);
    if (root_["list"]) {
      for (const YAML::Node& run : root_["list"]) add(run);
    }
    return out;
  }
  [[noreturn]] void fail(const YAML::Node& at, const std::string& what) const {
    throw SceneError(file_ + ":" + std::to_string(at.Mark().line + 1) + ": " + what);
  }
  [[noreturn]] void failAsAWhole(const std::string& what) const { throw SceneError(file_ + ": " + what); }

 private:
  static std::string valueText(const YAML::Node& value) {
    if (value.IsScalar()) return value.Scalar();
    YAML::Emitter out;
    out << YAML::Flow << value;
    return out.c_str();
  }
  KeyValues keyValues(const YAML::Node& map, const std::string& what) const {
    if (!map.IsMap()) fail(map, what + " must be a map of scene keys, as in {solver.tick_hz: 500}");
    KeyValues out;
    for (const auto& entry : map) out.push_back({entry.first.Scalar(), valueText(entry.second)});
    return out;
  }

  std::string file_;
  YAML::Node root_;
};

bool holds(const KeyValues& values, const std::string& key) {
  return std::any_of(values.begin(), values.end(), [&](const auto& value) { return value.first == key; });
}

/// Reads the scene with some of its values.
/// @return whether a value is refused, here or because others are missing: the run will report it
/// @throws UnknownKeyError
bool refusesValue(const std::string& scene, const Overrides& overrides) {
  try {
    loadScene(scene, overrides);
    return false;
  } catch (const UnknownKeyError&) {
    throw;
  } catch (const Error&) {
    return true;
  }
}

/// Checks every key once, in the first run that has it. @throws SceneError  no such scene, or no such key in it
void requireKnownKeys(const SweepPlan& plan, const std::string& file) {
  const std::string scene = findScene(plan.scene);
  std::set<std::string> seen;
  for (const KeyValues& run : plan.runs) {
    KeyValues values = plan.set;
    values.insert(values.end(), run.begin(), run.end());
    const auto is_seen = [&](const auto& value) { return seen.count(value.first) > 0; };
    if (std::all_of(values.begin(), values.end(), is_seen)) continue;
    Overrides overrides = meshOverrides(plan.mesh);
    for (const auto& [key, value] : values) {
      seen.insert(key);
      overrides.push_back(key + "=" + value);
      try {
        const bool is_scalar = value.find_first_of("[{") != 0;
        if (refusesValue(scene, overrides) && is_scalar) overrides.pop_back();  // it would hide errors in other keys
      } catch (const UnknownKeyError& error) {
        throw SceneError(file + ":" + std::to_string(plan.lines.at(key)) + ": " + error.what());
      }
    }
  }
}

void addValues(std::vector<std::string>& arguments, const KeyValues& values) {
  for (const auto& [key, value] : values) arguments.insert(arguments.end(), {"--set", key + "=" + value});
}

}  // namespace

bool SweepPlan::sets(const std::string& key) const {
  return holds(set, key) || std::count(varied.begin(), varied.end(), key) > 0;
}

std::vector<std::string> SweepPlan::arguments(size_t run) const {
  std::vector<std::string> out = {"run", scene};
  if (!mesh.empty()) out.insert(out.end(), {"--mesh", mesh});
  if (!strokes.empty()) out.insert(out.end(), {"--strokes", strokes});
  if (!seconds.empty()) out.insert(out.end(), {"--seconds", seconds});
  if (!view) out.push_back("--no-view");
  addValues(out, set);
  addValues(out, runs[run]);
  return out;
}

std::string SweepPlan::text() const {
  std::string out = std::string("keep ") + (keep ? "true" : "false") + "\n";
  for (size_t run = 0; run < runs.size(); ++run) {
    for (const std::string& argument : arguments(run)) out += argument + '\t';
    out += '\n';
  }
  return out;
}

SweepPlan readSweepPlan(const std::string& file) {
  const PlanFile from(file);
  SweepPlan plan;
  plan.scene = from.path("scene");
  if (plan.scene.empty())
    from.failAsAWhole("'scene' is missing; it must be a scene file or the name of a shipped scene");
  plan.mesh = from.path("mesh");
  plan.strokes = from.path("strokes");
  plan.seconds = from.scalar("seconds");
  plan.view = from.flag("view");
  plan.keep = from.flag("keep");
  plan.set = from.set();
  plan.runs = from.list();
  for (const auto& [key, values] : from.grid()) {
    if (plan.runs.size() * values.size() > kMostRuns)
      from.failAsAWhole("more than " + std::to_string(kMostRuns) + " runs");
    std::vector<KeyValues> product;
    for (const KeyValues& run : plan.runs) {
      for (const std::string& value : values) {
        product.push_back(run);
        product.back().push_back({key, value});
      }
    }
    plan.runs = std::move(product);
  }
  for (const KeyValues& run : plan.runs) {
    for (const auto& [key, value] : run) {
      if (std::count(plan.varied.begin(), plan.varied.end(), key) == 0) plan.varied.push_back(key);
      const auto same = [&, name = key](const auto& other) { return other.first == name; };
      if (holds(plan.set, key) || std::count_if(run.begin(), run.end(), same) > 1)
        from.failAsAWhole("'" + key + "' has two values in one run; give it in only one of 'set', 'list' and 'grid'");
    }
  }
  plan.lines = from.lines();
  requireKnownKeys(plan, file);
  return plan;
}

}  // namespace viscera::cli
