// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/tool_metrics.h"
#include "viscera/session/session.h"
#include "viscera/session/session_log.h"

namespace viscera {

/// Input and motion of tools over some ticks, and the forces on them. Forces are those of the tissue, without limits.
struct ToolRows {
  struct Row {
    uint64_t tick;
    StylusSamples samples;
    ToolMotions motions;
  };
  struct Forces {
    Vector3d forces_n[layout::kMaxStyluses], torques_nm[layout::kMaxStyluses];
  };
  double tick_s = 0;
  std::vector<std::string> styluses;  ///< names of the styluses
  std::vector<Row> rows;
  std::vector<Forces> forces;  ///< [rows], or fewer: the rest is not measured yet

  explicit ToolRows(const Session& session);
  void addRow(const Session& session, const StylusSamples& samples);
  void addForces(const Session& session, const layout::TickStats& stats);
  /// Returns the track of a stylus. @param stylus  < styluses.size()
  ToolTrack track(size_t stylus) const;
  /// Returns one map of metrics per tool (docs/replay.md). A tool that did not move has no smoothness.
  nlohmann::ordered_json metrics() const;
  /// Writes the rows as CSV. @throws Error  it cannot be written
  void write(const std::string& path) const;
  /// Writes the columns of JIGSAWS' kinematics (docs/lessons/tasks.md): a row per 1/30 s, 76 numbers. @throws Error  it
  /// cannot be written
  void writeJigsaws(const std::string& path) const;
};

/// Log that records the rows of a whole session.
class ToolLog : public SessionLog {
 public:
  /// @param session  must outlive this
  explicit ToolLog(Session& session);
  ~ToolLog() override { session_.removeLog(*this); }
  ToolLog(const ToolLog&) = delete;
  ToolLog& operator=(const ToolLog&) = delete;

  void stepped(Session& session, const StylusSamples& samples) override { rows_.addRow(session, samples); }
  void measured(const Session& session, uint64_t tick, const layout::TickStats& stats) override {
    if (tick > base_tick_) rows_.addForces(session, stats);
  }
  void wasReset() override { base_tick_ = 0; }
  void restored(Session& session) override { base_tick_ = session.tick(); }

  const ToolRows& rows() const { return rows_; }  ///< complete once the last tick was waited for

 private:
  Session& session_;
  uint64_t base_tick_;  ///< measurements up to this tick belong to earlier ticks
  ToolRows rows_;
};

}  // namespace viscera
