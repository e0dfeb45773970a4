// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/hand_log.h"

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "viscera/math/error.h"

namespace viscera::cli {

namespace {

Vector3d perTick(const layout::vec4& sum, double tick_s) {
  return -Vector3d(sum.x, sum.y, sum.z) / tick_s;
}

std::string csvNumbers(const std::vector<double>& values) {
  std::string out;
  for (const double value : values) {
    char text[32];
    std::snprintf(text, sizeof text, ",%.9g", value);
    out += text;
  }
  return out;
}

}  // namespace

HandLog::HandLog(Session& session) : session_(session), base_tick_(session.tick()) {
  session.addLog(*this);
}

void HandLog::stepped(Session& session, const StylusSamples& samples) {
  rows_.push_back({session.tick(), samples});
}

void HandLog::measured(const Session& session, uint64_t tick, const layout::TickStats& stats) {
  if (tick <= base_tick_) return;
  Felt felt;
  for (size_t s = 0; s < std::size(felt.forces_n); ++s) {
    felt.forces_n[s] = perTick(stats.impulse[s], session.tick_s());
    felt.torques_nm[s] = perTick(stats.angular[s], session.tick_s());
  }
  felt_.push_back(felt);
}

nlohmann::ordered_json HandLog::metrics() const {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  const std::vector<StylusConfig>& styluses = session_.styluses();
  for (size_t s = 0; s < styluses.size(); ++s) {
    HandTrack track;
    track.rate_hz = 1 / session_.tick_s();
    for (const Row& row : rows_) {
      track.tracked.push_back(row.samples[s].valid);
      track.places_m.push_back(row.samples[s].pose.position_m);
    }
    for (const Felt& felt : felt_) track.forces_n.push_back(felt.forces_n[s]);
    const HandMetrics metrics = metricsOf(track);
    nlohmann::ordered_json hand;
    hand["stylus"] = styluses[s].name;
    hand["time_s"] = metrics.time_s;
    hand["path_m"] = metrics.path_m;
    hand["economy"] = metrics.economy;
    hand["sparc"] = metrics.sparc;
    hand["log_dimensionless_jerk"] = metrics.log_jerk;
    hand["peak_force_n"] = metrics.peak_force_n;
    hand["mean_force_n"] = metrics.mean_force_n;
    hand["force_time_ns"] = metrics.force_time_ns;
    hand["force_volume_n3"] = metrics.force_volume_n3;
    out.push_back(hand);
  }
  return out;
}

void HandLog::write(const std::string& path) const {
  std::ofstream file(path);
  file << "step,tick,stylus,tracked,x_m,y_m,z_m,qx,qy,qz,qw,button1,button2,force_x_n,force_y_n,force_z_n,torque_x_nm,"
          "torque_y_nm,torque_z_nm\n";
  const std::vector<StylusConfig>& styluses = session_.styluses();
  for (size_t i = 0; i < std::min(rows_.size(), felt_.size()); ++i) {
    for (size_t s = 0; s < styluses.size(); ++s) {
      const StylusSample& sample = rows_[i].samples[s];
      const Vector3d &p = sample.pose.position_m, &f = felt_[i].forces_n[s], &m = felt_[i].torques_nm[s];
      const Quaterniond& q = sample.pose.orientation;
      file << i + 1 << ',' << rows_[i].tick << ',' << styluses[s].name << ',' << sample.valid
           << csvNumbers({p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}) << ',' << sample.button1 << ','
           << sample.button2 << csvNumbers({f.x(), f.y(), f.z(), m.x(), m.y(), m.z()}) << '\n';
    }
  }
  if (!file) throw Error(path + ": cannot be written");
}

}  // namespace viscera::cli
