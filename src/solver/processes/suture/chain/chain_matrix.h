// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "viscera/math/types.h"

namespace viscera {

/// The linear system of a Newton step of a chain: per node its position (3) and the tension of the link behind it (1).
/// A node couples to the next two by bending, a tension to its two nodes, so the matrix is banded. It is factored as L
/// D L^T without pivots, from both ends at once towards two or three nodes in the middle. Each step depends on the
/// previous one, but the two ends are independent of each other.
class ChainMatrix {
 public:
  struct Unknown {
    Vector3d position = Vector3d::Zero();
    double tension = 0;
  };

  explicit ChainMatrix(size_t nodes);
  size_t size() const { return rows_.size(); }
  /// Resets node i. @param self  times I, on the node   @param next, after  times I, to the next node and the one after
  void setNode(size_t i, double self, double next, double after);
  /// Adds link i, from node i to the next: its direction, and the stiffness across it where it is taut.
  void addLink(size_t i, const Vector3d& along, double across);
  /// Adds (all I + way way^T) on the point with weight `share` of node i + 1 and the rest of node i.
  void addPoint(size_t i, double share, double all, const Vector3d& direction);
  void addPoint(size_t i, double share, const Matrix3d& what);
  void factor();
  /// Solves the factored system. @param right  [nodes] in: right-hand sides; out: solution. The last tension does not
  /// exist: 0
  void solve(std::vector<Unknown>& right) const;

 private:
  using Pair = Eigen::Array2d;  ///< values of a node and of that at the same distance from the other end
  template <class T>
  using Vector = std::array<T, 3>;
  template <class T>
  using Square = std::array<std::array<T, 3>, 3>;
  template <class T>
  using Symmetric = std::array<T, 6>;  ///< lower triangle by rows

  struct Row {
    Matrix3d self, next;  ///< blocks of the node, and to the next one: both symmetric
    Vector3d along;       ///< direction of the link to the next one
    double after;         ///< times I: to the node after the next
  };
  /// A node, or two, once factored. Off-diagonal blocks are towards the middle.
  template <class T>
  struct Factored {
    Square<T> next;
    Vector<T> along;
    T after;
    Symmetric<T> back;  ///< inverse of the block of the node and its link, with `across` and `tension`
    Vector<T> across;
    T tension;
  };
  /// Schur complement of a factored node: to be subtracted from the blocks of the next node and the one after it.
  template <class T>
  struct Left {
    Symmetric<T> self{}, after{};
    Square<T> next{};
  };
  template <class T>
  static void factorNode(Symmetric<T> self, bool link, Factored<T>& node, Left<T>& left);
  void factorMiddle(const Left<Pair>& left);
  template <class T>
  static void forward(const Factored<T>& node, Vector<T>& position, T& tension, Vector<T>& next, Vector<T>& after);
  template <class T>
  static void backward(const Factored<T>& node, const Vector<T>& next, const Vector<T>& after, Vector<T>& position,
                       T& tension);
  size_t middles() const { return rows_.size() - 2 * pairs_.size(); }

  std::vector<Row> rows_;
  std::vector<Factored<Pair>> pairs_;
  std::array<Factored<double>, 3> middle_;
};

}  // namespace viscera
