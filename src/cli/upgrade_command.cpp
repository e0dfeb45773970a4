// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <yaml-cpp/exceptions.h>

#include <iostream>

#include "cli/commands.h"
#include "math/out_file.h"
#include "model/scene/yaml/renamed_keys.h"
#include "model/scene/yaml/yaml_fault.h"
#include "model/scene/yaml/yaml_reader.h"
#include "viscera/math/error.h"

namespace viscera::cli {

namespace {

UpgradedText upgradedFile(const std::string& file) {
  const std::string text = textOf(file, "file");
  try {
    return upgradedText(text);
  } catch (const YAML::Exception& error) {
    throw Error(yamlFault(file, error, text));
  }
}

}  // namespace

int upgrade(const std::vector<std::string>& files) {
  std::vector<UpgradedText> upgraded;
  for (const std::string& file : files) upgraded.push_back(upgradedFile(file));
  for (size_t f = 0; f < files.size(); ++f) {
    if (!upgraded[f].renamed.empty()) updateFile(files[f], upgraded[f].text);
    std::cout << files[f] << ": ";
    if (upgraded[f].renamed.empty()) std::cout << "nothing to rename";
    for (size_t k = 0; k < upgraded[f].renamed.size(); ++k) std::cout << (k > 0 ? ", " : "") << upgraded[f].renamed[k];
    std::cout << '\n';
  }
  return 0;
}

}  // namespace viscera::cli
