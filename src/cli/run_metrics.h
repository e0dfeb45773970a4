// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "viscera/session/session.h"

namespace viscera::cli {

/// The final report of `viscera run`, on any backend.
struct RunMetrics {
  std::string scene;
  const Model& model;
  uint64_t springs_cut = 0, substeps = 0, state_hash = 0;
  uint64_t images = 0, images_skipped = 0;  ///< numbers of images that were drawn and skipped
  double dt_s = 0, dt_safe_s = 0, dt_limit_s = 0, simulated_s = 0, wall_s = 0;
  FactGroups facts = {};  ///< facts of processes in the tissue
  Extremes extremes = {};
  std::string backend = {}, renderer = {};
  std::string stepped_by = {};  ///< Session::backendNote()
};
nlohmann::ordered_json toJson(const RunMetrics& metrics);

}  // namespace viscera::cli
