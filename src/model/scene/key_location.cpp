// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scene/key_location.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>

#include "model/scene/yaml/yaml_reader.h"

namespace viscera {

std::string locationOf(const std::string& file, const std::string& path) {
  try {
    YAML::Node node = YAML::Load(textOf(file, "scene"));
    for (size_t at = 0; at < path.size();) {
      const size_t end = std::min(path.find_first_of(".[", at + 1), path.size());
      const std::string step = path.substr(at, end - at);
      if (step[0] == '[')
        node.reset(node[static_cast<size_t>(std::stoul(step.substr(1)))]);
      else
        node.reset(node[step[0] == '.' ? step.substr(1) : step]);
      at = end;
    }
    if (node.IsDefined() && !node.Mark().is_null())
      return file + ":" + std::to_string(node.Mark().line + 1) + ": " + path;
  } catch (const std::exception&) {  // the key was an override, or the file has changed since
  }
  return file + ": " + path;
}

}  // namespace viscera
