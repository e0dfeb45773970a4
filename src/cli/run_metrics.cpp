// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/run_metrics.h"

#include <type_traits>
#include <variant>

#include "viscera/math/state_hash.h"

namespace viscera::cli {

namespace {

nlohmann::ordered_json toJson(const Fact::Facts& facts) {
  nlohmann::ordered_json out = nlohmann::ordered_json::object();
  for (const Fact& fact : facts) {
    nlohmann::ordered_json& json = out[fact.name];
    if (const auto* const entries = std::get_if<std::vector<Fact::Facts>>(&fact.value)) {
      json = nlohmann::ordered_json::array();
      for (const Fact::Facts& entry : *entries) json.push_back(toJson(entry));
    } else {
      std::visit(
          [&](const auto& value) {
            if constexpr (!std::is_same_v<std::decay_t<decltype(value)>, std::vector<Fact::Facts>>) json = value;
          },
          fact.value);
    }
  }
  return out;
}

}  // namespace

nlohmann::ordered_json toJson(const RunMetrics& metrics) {
  const size_t nodes = metrics.model.activeNodes();
  nlohmann::ordered_json out;
  out["scene"] = metrics.scene;
  out["nodes"] = nodes;
  out["springs"] = metrics.model.springs();
  out["springs_cut"] = metrics.springs_cut;
  out["faces"] = metrics.model.skinTriangles();
  out["steps"] = metrics.substeps;
  out["dt_s"] = metrics.dt_s;
  out["dt_safe_s"] = metrics.dt_safe_s;
  out["dt_limit_s"] = metrics.dt_limit_s;
  out["simulated_s"] = metrics.simulated_s;
  out["wall_s"] = metrics.wall_s;
  out["real_time_factor"] = metrics.simulated_s / metrics.wall_s;
  out["node_updates_per_s"] = static_cast<double>(nodes) * static_cast<double>(metrics.substeps) / metrics.wall_s;
  out["state_hash"] = StateHash::text(metrics.state_hash);
  out["max_stretch"] = metrics.extremes.max_stretch;
  out["max_speed_m_per_s"] = metrics.extremes.max_speed_m_per_s;
  out["nonfinite"] = metrics.extremes.nonfinite;
  out["nodes_crowded"] = metrics.extremes.crowded;
  out["roll_backs"] = metrics.extremes.roll_backs;
  out["ticks_speed_limited"] = metrics.extremes.speed_limited;
  out["peak_force_n"] = metrics.extremes.peak_force_n;
  for (const FactGroup& group : metrics.facts) out[group.name] = toJson(group.facts);
  out["images"] = metrics.images;
  out["images_skipped"] = metrics.images_skipped;
  out["backend"] = metrics.backend;
  out["renderer"] = metrics.renderer;
  out["stepped_by"] = metrics.stepped_by;
  return out;
}

}  // namespace viscera::cli
