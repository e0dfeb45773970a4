// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tasks/tool_log.h"

#include <algorithm>
#include <cstdio>

#include "math/number_text.h"
#include "math/out_file.h"

namespace viscera {

namespace {

Vector3d perTick(const layout::vec4& sum, double tick_s) {
  return -Vector3d(sum.x, sum.y, sum.z) / tick_s;
}

std::string csvNumbers(const std::vector<double>& values) {
  std::string out;
  for (const double value : values) out += ',' + numberText(value, 9);
  return out;
}

}  // namespace

ToolRows::ToolRows(const Session& session) : tick_s(session.tick_s()) {
  for (const StylusConfig& stylus : session.styluses()) styluses.push_back(stylus.name);
}

void ToolRows::addRow(const Session& session, const StylusSamples& samples) {
  rows.push_back({session.tick(), samples, session.motions()});
}

void ToolRows::addForces(const Session& session, const layout::TickStats& stats) {
  Forces one;
  for (size_t s = 0; s < std::size(one.forces_n); ++s) {
    one.forces_n[s] = perTick(stats.impulse[s], session.tick_s());
    one.torques_nm[s] = perTick(stats.angular[s], session.tick_s());
  }
  forces.push_back(one);
}

ToolTrack ToolRows::track(size_t stylus) const {
  ToolTrack out;
  out.rate_hz = 1 / tick_s;
  for (const Row& row : rows) {
    out.tracked.push_back(row.samples[stylus].valid);
    out.positions_m.push_back(row.samples[stylus].pose.position_m);
  }
  for (const Forces& one : forces) out.forces_n.push_back(one.forces_n[stylus]);
  return out;
}

nlohmann::ordered_json ToolRows::metrics() const {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (size_t s = 0; s < styluses.size(); ++s) {
    const ToolMetrics metrics = metricsOf(track(s));
    nlohmann::ordered_json tool;
    tool["stylus"] = styluses[s];
    tool["time_s"] = metrics.time_s;
    tool["path_m"] = metrics.path_m;
    tool["economy"] = metrics.economy;
    tool["sparc"] = metrics.sparc;
    tool["log_dimensionless_jerk"] = metrics.log_jerk;
    tool["peak_force_n"] = metrics.peak_force_n;
    tool["mean_force_n"] = metrics.mean_force_n;
    tool["force_time_ns"] = metrics.force_time_ns;
    tool["force_volume_n3"] = metrics.force_volume_n3;
    out.push_back(tool);
  }
  return out;
}

void ToolRows::write(const std::string& path) const {
  TextOut file;
  file << "step,tick,stylus,tracked,x_m,y_m,z_m,qx,qy,qz,qw,button1,button2,force_x_n,force_y_n,force_z_n,torque_x_nm,"
          "torque_y_nm,torque_z_nm\n";
  for (size_t i = 0; i < std::min(rows.size(), forces.size()); ++i) {
    for (size_t s = 0; s < styluses.size(); ++s) {
      const StylusSample& sample = rows[i].samples[s];
      const Vector3d &p = sample.pose.position_m, &f = forces[i].forces_n[s], &m = forces[i].torques_nm[s];
      const Quaterniond& q = sample.pose.orientation;
      file << i + 1 << ',' << rows[i].tick << ',' << styluses[s] << ',' << sample.valid
           << csvNumbers({p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}) << ',' << sample.button1 << ','
           << sample.button2 << csvNumbers({f.x(), f.y(), f.z(), m.x(), m.y(), m.z()}) << '\n';
    }
  }
  writeFile(path, FileKind::kText, file.str());
}

ToolLog::ToolLog(Session& session) : session_(session), base_tick_(session.tick()), rows_(session) {
  session.addLog(*this);
}

}  // namespace viscera
