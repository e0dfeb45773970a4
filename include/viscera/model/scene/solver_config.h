// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/api.h"
#include "viscera/model/scene/solver_kinds.h"

namespace VISCERA_PUBLIC viscera {

struct SolverConfig {
  double tick_hz = 60;
  Integrator integrator = Integrator::kLeapfrog;
  SolverStart start = SolverStart::kRest;
  double dt_fraction = 0.75;
  double dt_fraction_strained = 0.5;
  bool measured_limit = true;
  int substeps = 0;     ///< substeps of a tick; 0: from dt_fraction
  int iterations = 20;  ///< iterations of pd
  bool stability_monitor = true;
  double recovery_s = 0.25;
  double sleep_distance_m = 1;
  double sleep_speed_m_per_s = 1e-5;  ///< speed below which tissue sleeps [m/s]; 0: it never sleeps
  bool compensated = false;
  int max_substeps = 2000;
  double real_time_factor = 1.2;  ///< real-time factor that the spacing of bodies with auto_spacing is chosen for
  int device = -1;
  Backend backend = Backend::kAuto;
  int threads = 0;  ///< CPU threads of the CPU backend; 0: usableProcessors()
};

}  // namespace viscera
