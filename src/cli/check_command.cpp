// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <iostream>

#include "cli/commands.h"
#include "cli/scene_lookup.h"
#include "viscera/calibration/auto_spacing.h"
#include "viscera/gpu/context.h"
#include "viscera/model/body/wall_cells.h"
#include "viscera/model/body/wall_thickness.h"

namespace viscera::cli {

namespace {

size_t cellCount(const Lattice& lattice) {
  return static_cast<size_t>(
      std::count_if(lattice.cell_labels.begin(), lattice.cell_labels.end(), [](uint16_t label) { return label != 0; }));
}

/// Prints the bodies of a scene, and the thickness of their walls in cells.
void checkScene(const RunOptions& options) {
  const Scene scene = withChosenSpacing(sceneOf(options).scene, nullptr, consoleProgress());
  const Model model = buildModel(scene, consoleProgress());
  for (const Body& body : model.bodies) {
    std::cout << body.name << ": " << body.lattice.active_slots.size() << " nodes";
    if (body.hasCells()) std::cout << ", spacing " << body.lattice.spacing_m * 1e3 << " mm";
    std::cout << '\n';
    if (body.material.walls == Walls::kRows)
      std::cout << "  material.walls: rows: used in " << wallCells(body).size() << " of " << cellCount(body.lattice)
                << " cells\n";
    const std::optional<WallThickness> thickness = wallThickness(body);
    if (thickness)
      std::cout << "  " << wallThicknessText(*thickness, body.lattice.spacing_m, body.material.walls) << '\n';
  }
}

}  // namespace

int check(int device, const RunOptions& options) {
  if (!options.scene.empty()) {
    checkScene(options);
    return 0;
  }
  const gpu::Context context(device);
  for (const gpu::DeviceAttempt& attempt : context.attempts()) {
    std::cout << (attempt.taken ? "* " : "  ") << "device " << attempt.index << ": " << attempt.name << ": "
              << attempt.reason << '\n';
  }
  std::cout << "renderer: " << context.renderer() << "\nOpenGL:   " << context.version() << '\n';
  if (context.isSoftware())
    std::cout << "note:     software rasteriser: everything works, but much slower than on a GPU\n";
  return 0;
}

}  // namespace viscera::cli
