// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/chain/chain_matrix.h"

namespace viscera {

namespace {

/// Returns the index of an entry of a lower triangle by rows.
constexpr size_t at(size_t r, size_t c) {
  return r >= c ? r * (r + 1) / 2 + c : c * (c + 1) / 2 + r;
}

/// Returns the inverse of a symmetric positive matrix by L D L^T: some entries are a billion times as large as others.
template <class T>
std::array<T, 6> inverseOf(const std::array<T, 6>& a) {
  const T first = 1 / a[at(0, 0)], l10 = a[at(1, 0)] * first, l20 = a[at(2, 0)] * first;
  const T second = 1 / (a[at(1, 1)] - l10 * a[at(1, 0)]);
  const T below = a[at(2, 1)] - l20 * a[at(1, 0)], l21 = below * second;
  const T third = 1 / (a[at(2, 2)] - l20 * a[at(2, 0)] - l21 * below);
  const T m20 = l10 * l21 - l20;
  std::array<T, 6> out;
  out[at(2, 2)] = third;
  out[at(2, 1)] = -l21 * third;
  out[at(2, 0)] = m20 * third;
  out[at(1, 1)] = second + l21 * l21 * third;
  out[at(1, 0)] = -l10 * second - m20 * l21 * third;
  out[at(0, 0)] = first + l10 * l10 * second + m20 * m20 * third;
  return out;
}

template <class T>
T dot(const std::array<T, 3>& a, const std::array<T, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class T>
std::array<T, 3> times(const std::array<T, 6>& a, const std::array<T, 3>& b) {
  std::array<T, 3> out;
  for (size_t r = 0; r < 3; ++r) out[r] = a[at(r, 0)] * b[0] + a[at(r, 1)] * b[1] + a[at(r, 2)] * b[2];
  return out;
}

constexpr double kNoTension = -1;  // makes its block invertible

}  // namespace

ChainMatrix::ChainMatrix(size_t nodes) : rows_(nodes), pairs_((nodes - 2) / 2) {}

void ChainMatrix::setNode(size_t i, double self, double next, double after) {
  Row& row = rows_[i];
  row.self = self * Matrix3d::Identity();
  row.next = next * Matrix3d::Identity();
  row.along.setZero();
  row.after = after;
}

void ChainMatrix::addLink(size_t i, const Vector3d& along, double across) {
  Row& row = rows_[i];
  row.along = along;
  if (across <= 0) return;
  const Matrix3d turned = across * (Matrix3d::Identity() - along * along.transpose());
  row.self += turned;
  rows_[i + 1].self += turned;
  row.next -= turned;
}

void ChainMatrix::addPoint(size_t i, double share, double all, const Vector3d& direction) {
  addPoint(i, share, all * Matrix3d::Identity() + direction * direction.transpose());
}

void ChainMatrix::addPoint(size_t i, double share, const Matrix3d& what) {
  rows_[i].self += (1 - share) * (1 - share) * what;
  if (share == 0) return;
  rows_[i + 1].self += share * share * what;
  rows_[i].next += share * (1 - share) * what;
}

/// @param self  block of the node, without the contributions of nodes before it   @param node  in: blocks towards the
/// middle
/// @param left  in: Schur complement of those before it; out: its own
template <class T>
void ChainMatrix::factorNode(Symmetric<T> self, bool link, Factored<T>& node, Left<T>& left) {
  for (size_t e = 0; e < 6; ++e) self[e] -= left.self[e];
  for (size_t r = 0; r < 3; ++r) {
    for (size_t c = 0; c < 3; ++c) node.next[r][c] -= left.next[r][c];
  }
  node.back = inverseOf(self);
  const Vector<T> bent = times(node.back, node.along);
  node.tension = kNoTension;
  if (link) node.tension = -1 / dot(node.along, bent);
  for (size_t r = 0; r < 3; ++r) {
    node.across[r] = node.tension * bent[r];
    for (size_t c = 0; c <= r; ++c) node.back[at(r, c)] += node.across[r] * bent[c];
  }
  Square<T> low;
  Vector<T> low_tension;
  for (size_t c = 0; c < 3; ++c) {
    const Vector<T> next = {node.next[0][c], node.next[1][c], node.next[2][c]};
    const Vector<T> by = times(node.back, next);
    for (size_t r = 0; r < 3; ++r) low[r][c] = by[r] + node.across[r] * node.along[c];
    low_tension[c] = dot(node.across, next) + node.tension * node.along[c];
  }
  for (size_t r = 0; r < 3; ++r) {
    for (size_t c = 0; c <= r; ++c) {
      left.self[at(r, c)] = left.after[at(r, c)] + node.next[0][r] * low[0][c] + node.next[1][r] * low[1][c] +
                            node.next[2][r] * low[2][c] + node.along[r] * low_tension[c];
      left.after[at(r, c)] = node.after * node.after * node.back[at(r, c)];
    }
    for (size_t c = 0; c < 3; ++c) left.next[r][c] = node.after * low[c][r];
  }
}

void ChainMatrix::factor() {
  const size_t n = rows_.size(), k = pairs_.size();
  Left<Pair> left;
  for (Symmetric<Pair>* part : {&left.self, &left.after}) part->fill(Pair::Zero());
  for (Vector<Pair>& row : left.next) row.fill(Pair::Zero());
  for (size_t p = 0; p < k; ++p) {
    const Row &first = rows_[p], &last = rows_[n - 1 - p], &to_last = rows_[n - 2 - p];
    Factored<Pair>& node = pairs_[p];
    Symmetric<Pair> self;
    for (int r = 0; r < 3; ++r) {
      const auto row = static_cast<size_t>(r);
      for (int c = 0; c <= r; ++c) self[at(row, static_cast<size_t>(c))] = {first.self(r, c), last.self(r, c)};
      for (int c = 0; c < 3; ++c) node.next[row][static_cast<size_t>(c)] = {first.next(r, c), to_last.next(r, c)};
      node.along[row] = {first.along[r], -to_last.along[r]};
    }
    node.after = {first.after, rows_[n - 3 - p].after};
    factorNode(self, true, node, left);
  }
  factorMiddle(left);
}

/// Factors the nodes between the halves, one after the other. @param left  Schur complement of both halves
void ChainMatrix::factorMiddle(const Left<Pair>& left) {
  const size_t k = pairs_.size(), count = middles();
  Left<double> before;
  for (size_t e = 0; e < 6; ++e) before.self[e] = left.self[e][0], before.after[e] = left.after[e][0];
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) before.next[i][j] = left.next[i][j][0];
  }
  for (size_t m = 0; m < count; ++m) {
    const Row& row = rows_[k + m];
    const bool last = m + 1 == count, one_more = m + 2 == count;
    Factored<double>& node = middle_[m];
    Symmetric<double> self;
    for (size_t i = 0; i < 3; ++i) {
      const auto r = static_cast<int>(i);
      for (size_t j = 0; j < 3; ++j) {
        const auto c = static_cast<int>(j);
        const size_t e = at(i, j);
        self[e] = row.self(r, c) - (last ? left.self[e][1] : one_more ? left.after[e][1] : 0);
        node.next[i][j] = last ? 0 : row.next(r, c) - (one_more ? left.next[j][i][1] : 0);
      }
      node.along[i] = last ? 0 : row.along[r];
    }
    node.after = last || one_more ? 0 : row.after;
    factorNode(self, !last, node, before);
  }
}

/// @param place, tension  in: right-hand sides, without the contributions of nodes before it
/// @param next, after  in: contributions to the node and the next one; out: to the next one and the one after it
template <class T>
void ChainMatrix::forward(const Factored<T>& node, Vector<T>& position, T& tension, Vector<T>& next, Vector<T>& after) {
  for (size_t r = 0; r < 3; ++r) position[r] -= next[r];
  Vector<T> x = times(node.back, position);
  const T pull = dot(node.across, position) + node.tension * tension;
  for (size_t r = 0; r < 3; ++r) x[r] += node.across[r] * tension;
  for (size_t c = 0; c < 3; ++c) {
    next[c] =
        after[c] + node.next[0][c] * x[0] + node.next[1][c] * x[1] + node.next[2][c] * x[2] + node.along[c] * pull;
    after[c] = node.after * x[c];
  }
  position = x;
  tension = pull;
}

template <class T>
void ChainMatrix::backward(const Factored<T>& node, const Vector<T>& next, const Vector<T>& after, Vector<T>& position,
                           T& tension) {
  Vector<T> known;
  for (size_t r = 0; r < 3; ++r) known[r] = dot(node.next[r], next) + node.after * after[r];
  const T link = dot(node.along, next);
  const Vector<T> by = times(node.back, known);
  for (size_t r = 0; r < 3; ++r) position[r] -= by[r] + node.across[r] * link;
  tension -= dot(node.across, known) + node.tension * link;
}

void ChainMatrix::solve(std::vector<Unknown>& right) const {
  const size_t n = rows_.size(), k = pairs_.size(), count = middles();
  const auto load = [&](size_t p, Vector<Pair>& position, Pair& tension) {
    const Unknown &first = right[p], &last = right[n - 1 - p];
    position = {Pair(first.position[0], last.position[0]), Pair(first.position[1], last.position[1]),
                Pair(first.position[2], last.position[2])};
    tension = {first.tension, right[n - 2 - p].tension};
  };
  const auto store = [&](size_t p, const Vector<Pair>& position, const Pair& tension) {
    right[p].position = {position[0][0], position[1][0], position[2][0]};
    right[n - 1 - p].position = {position[0][1], position[1][1], position[2][1]};
    right[p].tension = tension[0];
    right[n - 2 - p].tension = tension[1];
  };
  Vector<Pair> position, next, after;
  next.fill(Pair::Zero());
  after.fill(Pair::Zero());
  Pair tension;
  for (size_t p = 0; p < k; ++p) {
    load(p, position, tension);
    forward(pairs_[p], position, tension, next, after);
    store(p, position, tension);
  }
  const auto lane = [](const Vector<Pair>& of, Eigen::Index l) { return Vector<double>{of[0][l], of[1][l], of[2][l]}; };
  std::array<Vector<double>, 3> x{};
  std::array<double, 3> pull{};
  Vector<double> mid_next = lane(next, 0), mid_after = lane(after, 0);
  for (size_t m = 0; m < count; ++m) {
    const Vector<Pair>* const from_last = m + 1 == count ? &next : m + 2 == count ? &after : nullptr;
    for (size_t r = 0; r < 3; ++r)
      x[m][r] = right[k + m].position[static_cast<Eigen::Index>(r)] - (from_last ? (*from_last)[r][1] : 0);
    pull[m] = m + 1 < count ? right[k + m].tension : 0;
    forward(middle_[m], x[m], pull[m], mid_next, mid_after);
  }
  for (size_t m = count - 1; m-- > 0;)
    backward(middle_[m], x[m + 1], m + 2 < count ? x[m + 2] : Vector<double>{}, x[m], pull[m]);
  for (size_t m = 0; m < count; ++m) {
    right[k + m].position = {x[m][0], x[m][1], x[m][2]};
    if (m + 1 < count) right[k + m].tension = pull[m];
  }
  for (size_t r = 0; r < 3; ++r) {
    next[r] = {x[0][r], x[count - 1][r]};
    after[r] = {x[1][r], x[count - 2][r]};
  }
  for (size_t p = k; p-- > 0;) {
    load(p, position, tension);
    backward(pairs_[p], next, after, position, tension);
    store(p, position, tension);
    after = next;
    next = position;
  }
}

}  // namespace viscera
