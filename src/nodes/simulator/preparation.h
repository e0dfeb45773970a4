// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace viscera {
struct Scene;
}

namespace viscera::nodes {

/// How far the making of a scene is, in one number, from the stages that it tells of and the shares of the time that
/// they were measured to take.
class Preparation {
 public:
  explicit Preparation(const Scene& scene);

  /// @param stage, fraction  as a Progress is told   @returns 0..99, never less than before
  int percentAt(const std::string& stage, double fraction);

 private:
  double auto_share_, bodies_share_;  ///< of the whole: of finding a spacing, of all bodies
  const size_t bodies_;
  size_t bodies_begun_ = 0;
  double done_ = 0;
};

}  // namespace viscera::nodes
