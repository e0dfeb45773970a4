// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace viscera {

/// One reported quantity of a session. Its name ends with its unit, as in `bled_ml`.
struct Fact {
  using Facts = std::vector<Fact>;
  /// A list of doubles is a vector or a row of numbers; a list of Facts is one entry per object, such as per clip.
  using Value = std::variant<bool, uint64_t, double, std::string, std::vector<double>, std::vector<Facts>>;

  std::string name;
  Value value;
};

/// All that one process in the tissue reports (TissueProcess::facts()). metrics.json, /diagnostics and Python show
/// every group of a session without knowing what it is of.
struct FactGroup {
  std::string name;     ///< of the process: "threads", "clips", "burns", ...
  std::string summary;  ///< one line for a person
  bool warns = false;   ///< the summary says that something failed
  std::vector<Fact> facts = {};
};
using FactGroups = std::vector<FactGroup>;

/// Lists single values with their paths, as in `on[0].force_n`, in order.
std::vector<std::pair<std::string, std::string>> flatFacts(const FactGroup& group);

/// Finds a value by its name in a group. @returns null  the session has no such group, or it no such fact
const Fact::Value* findFact(const FactGroups& groups, const std::string& group, const std::string& name);

}  // namespace viscera
