// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>
#include <iostream>

#include "cli/commands.h"
#include "cli/scene_lookup.h"
#include "viscera/math/error.h"

namespace viscera::cli {

int fit(const RunOptions& options) {
  const FittedScene fitted = sceneOf(options);
  const std::string said =
      fitted.scene.fit ? fitted.scene.fit->text() : "cameras, tools and obstacles as in " + options.scene;
  std::ofstream file(options.out);
  file << sceneYaml(findScene(options.scene), fitted.overrides, said);
  file.close();
  if (!file) throw Error(options.out + ": cannot be written");
  std::cout << said << '\n';
  return 0;
}

}  // namespace viscera::cli
