// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tasks/cut_watch.h"

namespace viscera {

/// Parts and bodies that must not be cut.
class SparedParts {
 public:
  /// @throws TaskError  the model has no part or body of a name
  SparedParts(const Model& model, const std::vector<std::string>& names);
  bool isEmpty() const { return spared_.empty(); }
  /// Returns how many of the cuts are in them.
  size_t count(const std::vector<FreshCut>& cuts) const;

 private:
  const Model& model_;
  std::vector<std::vector<bool>> spared_;  ///< [bodies][labels of the lattice]; empty: nothing is spared
};

}  // namespace viscera
