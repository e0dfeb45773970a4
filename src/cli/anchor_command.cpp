// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "cli/commands.h"
#include "cli/scene_lookup.h"
#include "math/one_line.h"
#include "math/out_file.h"
#include "viscera/model/model.h"
#include "viscera/tools/strokes.h"

namespace viscera::cli {

int anchor(const RunOptions& options) {
  const Scene scene = sceneOf(options).scene;
  Strokes strokes = loadStrokes(options.strokes);
  requireReplaceable(options.out, FileKind::kStrokes);
  const Model model = buildModel(scene, consoleProgress());
  for (const std::string& note : resolveAnchors(strokes, model, scene.fit))
    std::cout << "strokes: " << oneLine(note) << '\n';
  writeFile(options.out, FileKind::kStrokes, strokesYaml(strokes));
  return 0;
}

}  // namespace viscera::cli
