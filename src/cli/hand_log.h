// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/hand_metrics.h"
#include "viscera/session/session.h"
#include "viscera/session/session_log.h"

namespace viscera::cli {

/// What hands did in a session, and felt: a row per tick and hand, and measures of each. Forces are the tissue's, not
/// limited.
class HandLog : public SessionLog {
 public:
  /// @param session  must outlive this
  explicit HandLog(Session& session);
  ~HandLog() override { session_.removeLog(*this); }
  HandLog(const HandLog&) = delete;
  HandLog& operator=(const HandLog&) = delete;

  void stepped(Session& session, const StylusSamples& samples) override;
  void measured(const Session& session, uint64_t tick, const layout::TickStats& stats) override;
  void wasReset() override { base_tick_ = 0; }
  void restored(Session& session) override { base_tick_ = session.tick(); }

  /// A map per hand; of a session whose last tick was waited for. What moved not at all has no smoothness.
  nlohmann::ordered_json metrics() const;
  /// As CSV. @throws Error  it cannot be written
  void write(const std::string& path) const;

 private:
  struct Row {
    uint64_t tick;
    StylusSamples samples;
  };
  struct Felt {
    Vector3d forces_n[2], torques_nm[2];
  };
  Session& session_;
  uint64_t base_tick_;  ///< measurements up to this one are of ticks before
  std::vector<Row> rows_;
  std::vector<Felt> felt_;  ///< [rows_]
};

}  // namespace viscera::cli
