// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "cli/commands.h"
#include "cli/scene_lookup.h"
#include "math/out_file.h"

namespace viscera::cli {

int fit(const RunOptions& options) {
  const FittedScene fitted = sceneOf(options);
  const std::string said =
      fitted.scene.fit ? fitted.scene.fit->text() : "cameras, tools and obstacles as in " + options.scene;
  writeFile(options.out, FileKind::kScene, sceneYaml(findScene(options.scene), fitted.overrides, said));
  std::cout << said << '\n';
  return 0;
}

}  // namespace viscera::cli
