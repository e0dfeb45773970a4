// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/math/types.h"

namespace viscera {

/// The linear system of a Newton step of a chain: node by node its place (3) and the tension of the link behind it (1).
/// A node knows the next two (bending), a tension its two nodes; so it is a band, factored without pivots as L D L^T.
class ChainMatrix {
 public:
  struct Unknown {
    Vector3d place = Vector3d::Zero();
    double tension = 0;
  };

  explicit ChainMatrix(size_t nodes);
  size_t size() const { return rows_.size(); }
  /// Begins node i again. @param self  times I, on the node   @param next, after  times I, between it and the next two
  void setNode(size_t i, double self, double next, double after);
  /// Link i, from node i to the next: its direction, and what it adds across it where it is taut.
  void addLink(size_t i, const Vector3d& along, double across);
  /// (all I + way way^T) on the point that has `share` of node i + 1 and the rest of node i.
  void addPoint(size_t i, double share, double all, const Vector3d& way);
  void addPoint(size_t i, double share, const Matrix3d& what);
  /// After it the parts above are gone: set them again.
  void factor();
  /// @param right  [nodes] in: right-hand sides; out: solution. The last tension is none: 0
  void solve(std::vector<Unknown>& right) const;

 private:
  using Matrix43 = Eigen::Matrix<double, 4, 3>;
  struct Row {
    Matrix3d self;
    Matrix43 next;         ///< transposed block to the next node: rows 0 to 2 its place, row 3 the link's direction
    double after;          ///< times I: to the node after the next
    Eigen::Matrix4d back;  ///< inverse of the node's block, once factored
  };
  std::vector<Row> rows_;
};

}  // namespace viscera
