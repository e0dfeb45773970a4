// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ctime>
#include <string>

namespace viscera {

constexpr int kLongestTrainee = 64;  ///< characters of a trainee's name

/// Origin of a report: who, when, with which program, and the state in which it ended.
struct Attempt {
  std::string trainee;     ///< name; empty: not given
  std::string date;        ///< UTC, ISO 8601, as utcText() writes it
  std::string version;     ///< version of viscera
  std::string state_hash;  ///< StateHash::text() at the end of the run; empty: not computed
  std::string page = {};   ///< path of the page of the session, from the folder of the report; empty: none
};

/// Returns an attempt with the version of this program. @param now  time at which it ended
Attempt attemptAt(std::time_t now, const std::string& trainee = "");
/// Returns a time as 2026-01-31T12:00:00Z.
std::string utcText(std::time_t time);
/// Returns whether a text is a time as utcText() writes it.
bool isUtcText(const std::string& text);
/// Returns why a text cannot be a trainee's name, or empty.
std::string traineeFault(const std::string& name);

}  // namespace viscera
