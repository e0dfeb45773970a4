// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/run_metrics.h"

#include "viscera/math/state_hash.h"

namespace viscera::cli {

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
  out["governor_trips"] = metrics.extremes.governor_trips;
  out["nodes_unfolded"] = metrics.unfolded;
  out["ticks_held_back"] = metrics.extremes.held_back;
  out["peak_force_n"] = metrics.extremes.peak_force_n;
  for (const BladeWork& blade : metrics.blades) {
    out["cut_area_m2"].push_back(blade.area_m2);
    out["cut_work_j"].push_back(blade.work_j);
  }
  for (const ThreadMetrics& thread : metrics.threads) {
    nlohmann::ordered_json told = {{"name", thread.name},
                                   {"length_m", thread.seen.length_m},
                                   {"largest_n", thread.seen.largest_n},
                                   {"knots", nlohmann::ordered_json::array()}};
    for (const SeenKnot& knot : thread.seen.knots)
      told["knots"].push_back({{"knot", nameOf(knot.kind)},
                               {"turns", knot.turns},
                               {"tied", knot.tied},
                               {"holds_n", knot.holds_n},
                               {"loop_m", knot.loop_m},
                               {"loop_n", knot.loop_n}});
    out["threads"].push_back(told);
  }
  if (metrics.clips) {
    nlohmann::ordered_json clips = {{"empty", metrics.clips->empty},
                                    {"taken_off", metrics.clips->taken_off},
                                    {"on", nlohmann::ordered_json::array()}};
    for (const SeenClip& clip : metrics.clips->on) {
      clips["on"].push_back({{"stylus", clip.stylus},
                             {"rest_m", {clip.rest_m.x(), clip.rest_m.y(), clip.rest_m.z()}},
                             {"opening_m", clip.opening_m},
                             {"force_n", clip.force_n}});
    }
    out["clips"] = clips;
  }
  if (metrics.burns) {
    const SeenBurns& burns = *metrics.burns;
    out["burns"] = {{"given_j", burns.given_j},
                    {"stored_j", burns.stored_j},
                    {"steam_j", burns.steam_j},
                    {"perfused_j", burns.perfused_j},
                    {"surface_j", burns.surface_j},
                    {"hottest_c", burns.hottest_c},
                    {"coagulated_m3", burns.coagulated_m3},
                    {"parted", burns.parted}};
  }
  if (metrics.blood) {
    const SeenBlood& blood = *metrics.blood;
    out["bleeding"] = {{"bled_ml", blood.bled_ml},
                       {"on_tissue_ml", blood.on_tissue_ml},
                       {"dripped_ml", blood.dripped_ml},
                       {"flow_ml_per_min", blood.flow_ml_per_min},
                       {"stumps", blood.stumps}};
  }
  if (!metrics.thread_refusal.empty()) out["thread_refusal"] = metrics.thread_refusal;
  out["images"] = metrics.images;
  out["images_skipped"] = metrics.images_skipped;
  out["backend"] = metrics.backend;
  out["renderer"] = metrics.renderer;
  out["stepped_by"] = metrics.stepped_by;
  return out;
}

}  // namespace viscera::cli
