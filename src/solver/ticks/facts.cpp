// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/solver/facts.h"

#include "math/number_text.h"

namespace viscera {

namespace {

constexpr int kDigits = 5;  // significant digits of printed numbers

using Flat = std::vector<std::pair<std::string, std::string>>;

void addFlat(const std::string& before, const Fact::Facts& facts, Flat& out);

/// Adds a value, or every value of a list of entries.
struct Flattener {
  const std::string& path;
  Flat& out;

  void operator()(bool value) const { out.emplace_back(path, value ? "true" : "false"); }
  void operator()(uint64_t value) const { out.emplace_back(path, std::to_string(value)); }
  void operator()(double value) const { out.emplace_back(path, numberText(value, kDigits)); }
  void operator()(const std::string& value) const { out.emplace_back(path, value); }
  void operator()(const std::vector<double>& row) const {
    std::string text;
    for (const double value : row) text += (text.empty() ? "" : " ") + numberText(value, kDigits);
    out.emplace_back(path, text);
  }
  void operator()(const std::vector<Fact::Facts>& entries) const {
    for (size_t i = 0; i < entries.size(); ++i) addFlat(path + "[" + std::to_string(i) + "].", entries[i], out);
  }
};

void addFlat(const std::string& before, const Fact::Facts& facts, Flat& out) {
  for (const Fact& fact : facts) {
    const std::string path = before + fact.name;
    std::visit(Flattener{path, out}, fact.value);
  }
}

}  // namespace

std::vector<std::pair<std::string, std::string>> flatFacts(const FactGroup& group) {
  Flat out;
  addFlat("", group.facts, out);
  return out;
}

const Fact::Value* findFact(const FactGroups& groups, const std::string& group, const std::string& name) {
  for (const FactGroup& one : groups) {
    if (one.name != group) continue;
    for (const Fact& fact : one.facts) {
      if (fact.name == name) return &fact.value;
    }
  }
  return nullptr;
}

}  // namespace viscera
