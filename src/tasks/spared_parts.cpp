// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tasks/spared_parts.h"

#include <algorithm>

#include "tasks/task.h"

namespace viscera {

SparedParts::SparedParts(const Model& model, const std::vector<std::string>& names) : model_(model) {
  if (names.empty()) return;
  for (const Body& body : model.bodies) spared_.emplace_back(body.lattice.part_names.size() + 1, false);
  for (const std::string& name : names) {
    bool found = false;
    std::string known;
    for (size_t b = 0; b < model.bodies.size(); ++b) {
      const Body& body = model.bodies[b];
      known += (known.empty() ? "" : ", ") + body.name;
      if (body.name == name) std::fill(spared_[b].begin(), spared_[b].end(), true);
      found |= body.name == name;
      for (size_t part = 0; part < body.lattice.part_names.size(); ++part) {
        known += ", " + body.lattice.part_names[part];
        if (body.lattice.part_names[part] != name) continue;
        spared_[b][part + 1] = true;
        found = true;
      }
    }
    if (!found) throw TaskError("'spared_parts' must name bodies or parts, of " + known + "; found '" + name + "'");
  }
}

size_t SparedParts::count(const std::vector<FreshCut>& cuts) const {
  if (isEmpty()) return 0;
  return static_cast<size_t>(std::count_if(cuts.begin(), cuts.end(), [&](const FreshCut& cut) {
    const std::vector<uint16_t>& labels = model_.bodies[cut.body].lattice.labels;
    const size_t label = cut.slot < labels.size() ? labels[cut.slot] : 0;
    return label < spared_[cut.body].size() && spared_[cut.body][label];
  }));
}

}  // namespace viscera
