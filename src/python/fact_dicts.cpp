// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "python/fact_dicts.h"

namespace viscera::python {

namespace py = pybind11;

namespace {

py::dict dictOf(const Fact::Facts& facts);

struct ToPython {
  py::object operator()(bool value) const { return py::bool_(value); }
  py::object operator()(uint64_t value) const { return py::int_(value); }
  py::object operator()(double value) const { return py::float_(value); }
  py::object operator()(const std::string& value) const { return py::str(value); }
  py::object operator()(const std::vector<double>& row) const {
    py::list out;
    for (const double value : row) out.append(value);
    return out;
  }
  py::object operator()(const std::vector<Fact::Facts>& entries) const {
    py::list out;
    for (const Fact::Facts& entry : entries) out.append(dictOf(entry));
    return out;
  }
};

py::dict dictOf(const Fact::Facts& facts) {
  py::dict out;
  for (const Fact& fact : facts) out[py::str(fact.name)] = std::visit(ToPython{}, fact.value);
  return out;
}

}  // namespace

void addFacts(const FactGroups& groups, py::dict& out) {
  for (const FactGroup& group : groups) out[py::str(group.name)] = dictOf(group.facts);
}

}  // namespace viscera::python
