// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>

#include "cli/commands.h"
#include "cli/scene_lookup.h"
#include "viscera/math/error.h"
#include "viscera/model/model.h"
#include "viscera/tools/strokes.h"

namespace viscera::cli {

int anchor(const RunOptions& options) {
  const Scene scene = sceneOf(options).scene;
  Strokes strokes = loadStrokes(options.strokes);
  resolveAnchors(strokes, buildModel(scene, consoleProgress()), scene.fit);
  std::ofstream file(options.out);
  file << strokesYaml(strokes);
  if (!file) throw Error(options.out + ": cannot be written");
  return 0;
}

}  // namespace viscera::cli
