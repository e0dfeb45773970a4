// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace viscera {
struct Scene;
}

namespace viscera::nodes {

/// Progress of creating a scene, as one number. It is computed from the reported stages and measured shares of the
/// total time.
class Preparation {
 public:
  explicit Preparation(const Scene& scene);

  /// Returns the progress [%], 0..99, never less than before. @param stage, fraction  arguments of a Progress
  int percentAt(const std::string& stage, double fraction);

 private:
  double auto_share_, bodies_share_;  ///< share of the total time for finding a spacing, and for all bodies
  const size_t bodies_;
  size_t bodies_begun_ = 0;
  double done_ = 0;
};

}  // namespace viscera::nodes
