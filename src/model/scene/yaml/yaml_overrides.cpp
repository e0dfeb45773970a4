// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scene/yaml/yaml_overrides.h"

#include <vector>

#include "math/number_text.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

struct PathStep {
  std::string key;
  int index = -1;  ///< -1: no [index]
};

/// Removes numbers of the file where a preset was set as an override, except numbers that are overrides too.
void clearNumbers(YAML::Node map, const std::string& path, const YamlSource& source) {
  for (const char* key : {"young_modulus_pa", "poisson_ratio", "density_kg_per_m3"}) {
    if (!source.sets(path + "." + key)) map.remove(key);
  }
}

/// Splits "bodies[0].material.density_kg_per_m3" into steps.
std::vector<PathStep> splitPath(const std::string& path, const std::string& override_text) {
  std::vector<PathStep> steps;
  TextIn parts(path);
  std::string part;
  while (std::getline(parts, part, '.')) {
    PathStep step;
    const size_t open = part.find('[');
    step.key = part.substr(0, open);
    if (open != std::string::npos) {
      const std::string digits = part.substr(open + 1, part.size() - open - 2);
      if (part.back() != ']' || digits.empty() || digits.size() > 4 ||
          digits.find_first_not_of("0123456789") != std::string::npos) {
        throw UnknownKeyError("override '" + override_text + "': '" + part + "' must be name[index]");
      }
      step.index = std::stoi(digits);
    }
    if (step.key.empty()) throw UnknownKeyError("override '" + override_text + "': the key contains an empty name");
    steps.push_back(step);
  }
  return steps;
}

}  // namespace

void applyOverride(YAML::Node root, const std::string& text, YamlSource& source) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw SceneError("override '" + text + "' must be key=value, as in bodies[0].spacing_m=0.003");
  }
  const std::string path = text.substr(0, equals);
  const std::vector<PathStep> steps = splitPath(path, text);
  YAML::Node value;
  try {
    value = YAML::Load(text.substr(equals + 1));
  } catch (const YAML::Exception& e) {
    throw SceneError("override '" + text + "': " + e.msg);
  }
  YAML::Node at = root;
  for (size_t i = 0; i < steps.size(); ++i) {
    const bool last = i + 1 == steps.size();
    YAML::Node next = at[steps[i].key];
    if (steps[i].index >= 0) {
      if (!next.IsSequence() || static_cast<size_t>(steps[i].index) >= next.size()) {
        throw UnknownKeyError("override '" + text + "': the scene has no " + steps[i].key + "[" +
                              std::to_string(steps[i].index) + "]");
      }
      next.reset(next[steps[i].index]);
    }
    if (next.IsDefined() && !next.IsNull() && !last && !next.IsMap()) {
      throw UnknownKeyError("override '" + text + "': '" + steps[i].key + "' has no keys below it");
    }
    if (last) next = value;
    if (last && steps[i].key == "tissue") clearNumbers(at, path.substr(0, path.rfind('.')), source);
    at.reset(next);
  }
  source.overridden.insert(path);
}

}  // namespace viscera
