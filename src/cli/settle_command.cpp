// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/scene_lookup.h"
#include "solver/cpu/equilibrium.h"
#include "viscera/math/state_hash.h"
#include "viscera/solver/solver.h"

namespace viscera::cli {

int settle(const RunOptions& options) {
  const Scene scene = sceneOf(options).scene;
  const Model model = buildModel(scene, consoleProgress());
  SettleReport report;
  const HostState state = equilibriumOf(model, scene, report);
  nlohmann::ordered_json out;
  out["scene"] = scene.name;
  out["nodes"] = model.activeNodes();
  out["residual"] = report.residual;
  out["left"] = report.left;
  out["settled"] = report.settled;
  out["substeps"] = report.substeps;
  out["solve_s"] = report.seconds;
  out["max_displacement_m"] = report.largest_m;
  out["state_hash"] = StateHash::text(stateHash(model, state));
  std::cout << out.dump() << '\n';
  return 0;
}

}  // namespace viscera::cli
