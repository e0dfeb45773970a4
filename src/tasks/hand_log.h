// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/hand_metrics.h"
#include "viscera/session/session.h"
#include "viscera/session/session_log.h"

namespace viscera {

/// What hands did in some ticks, and felt. Forces are the tissue's, not limited.
struct HandRows {
  struct Row {
    uint64_t tick;
    StylusSamples samples;
    ToolMotions motions;
  };
  struct Felt {
    Vector3d forces_n[layout::kMaxStyluses], torques_nm[layout::kMaxStyluses];
  };
  double tick_s = 0;
  std::vector<std::string> styluses;  ///< names
  std::vector<Row> rows;
  std::vector<Felt> felt;  ///< [rows], or fewer: the rest is not measured yet

  explicit HandRows(const Session& session);
  void addRow(const Session& session, const StylusSamples& samples);
  void addFelt(const Session& session, const layout::TickStats& stats);
  /// @param stylus  < styluses.size()
  HandTrack track(size_t stylus) const;
  /// A map per hand (docs/replay.md). What moved not at all has no smoothness.
  nlohmann::ordered_json metrics() const;
  /// As CSV. @throws Error  it cannot be written
  void write(const std::string& path) const;
  /// In the columns of JIGSAWS' kinematics (docs/lessons/tasks.md): a row per 1/30 s, 76 numbers. @throws Error  the
  /// same
  void writeJigsaws(const std::string& path) const;
};

/// Notes them of a whole session.
class HandLog : public SessionLog {
 public:
  /// @param session  must outlive this
  explicit HandLog(Session& session);
  ~HandLog() override { session_.removeLog(*this); }
  HandLog(const HandLog&) = delete;
  HandLog& operator=(const HandLog&) = delete;

  void stepped(Session& session, const StylusSamples& samples) override { rows_.addRow(session, samples); }
  void measured(const Session& session, uint64_t tick, const layout::TickStats& stats) override {
    if (tick > base_tick_) rows_.addFelt(session, stats);
  }
  void wasReset() override { base_tick_ = 0; }
  void restored(Session& session) override { base_tick_ = session.tick(); }

  const HandRows& rows() const { return rows_; }  ///< whole once the last tick was waited for

 private:
  Session& session_;
  uint64_t base_tick_;  ///< measurements up to this one are of ticks before
  HandRows rows_;
};

}  // namespace viscera
