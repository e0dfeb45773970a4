// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/scene_lookup.h"
#include "solver/multigrid/steps/equilibrium.h"
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
  out["last_change"] = report.last_change;
  out["settled"] = report.settled;
  out["newton_steps"] = report.newton;
  out["iterations"] = report.iterations;
  out["forces"] = report.forces;
  out["products"] = report.products;
  out["work_units"] = report.forces + report.products;
  out["solve_s"] = report.seconds;
  out["build_s"] = report.build_s;
  out["max_displacement_m"] = report.largest_m;
  out["state_hash"] = StateHash::text(stateHash(model, state));
  std::cout << out.dump() << '\n';
  return 0;
}

}  // namespace viscera::cli
