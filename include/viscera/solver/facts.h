// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "viscera/api.h"

namespace VISCERA_PUBLIC viscera {

/// Reported quantity of a session. Its name ends with its unit, as in `bled_ml`.
struct Fact {
  using Facts = std::vector<Fact>;
  /// Value of a fact: a list of doubles is a vector or a row of numbers; a list of Facts has one entry per object, such
  /// as per clip.
  using Value = std::variant<bool, uint64_t, double, std::string, std::vector<double>, std::vector<Facts>>;

  std::string name;
  Value value;
};

/// Facts of one process in the tissue (TissueProcess::facts()). metrics.json, /diagnostics and Python show every group
/// of a session without knowledge of its kind.
struct FactGroup {
  std::string name;     ///< name of the process: "sutures", "clips", "burns", ...
  std::string summary;  ///< one line for a person
  bool warns = false;   ///< the summary reports a failure
  std::vector<Fact> facts = {};
};
using FactGroups = std::vector<FactGroup>;

/// Lists single values with their paths, as in `on[0].force_n`, in order.
std::vector<std::pair<std::string, std::string>> flatFacts(const FactGroup& group);

/// Finds a value by its name in a group. @returns null  the session has no such group, or the group has no such fact
const Fact::Value* findFact(const FactGroups& groups, const std::string& group, const std::string& name);

}  // namespace viscera
