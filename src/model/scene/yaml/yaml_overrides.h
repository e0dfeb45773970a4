// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "model/scene/yaml/yaml_reader.h"

namespace viscera {

/// Sets one key of a document by an override such as `bodies[0].spacing_m=0.003`; `source` records it.
/// @throws SceneError  no such list item, not key=value, or no YAML
void applyOverride(YAML::Node root, const std::string& text, YamlSource& source);

}  // namespace viscera
