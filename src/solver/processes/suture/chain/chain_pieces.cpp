// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Cutting chains, and making them whole again.
#include <algorithm>
#include <cassert>
#include <string>
#include <utility>

#include "math/archive.h"
#include "solver/processes/suture/chain/chain.h"

namespace viscera {

namespace {

constexpr size_t kLeastNodes = 3;

/// Moves the items behind a node to the other piece. @param is_behind  selects them   @param shift  called for each of
/// them
template <class Thing, class IsBehind, class Shift>
void moveBehind(std::vector<Thing>& from, std::vector<Thing>& to, IsBehind is_behind, Shift shift) {
  const auto first = std::stable_partition(from.begin(), from.end(), [&](const Thing& it) { return !is_behind(it); });
  to.assign(first, from.end());
  from.erase(first, from.end());
  std::for_each(to.begin(), to.end(), shift);
}

}  // namespace

void Chain::reset() {
  x_ = start_;
  v_.resize(x_.size());
  mu_.resize(x_.size() - 1);
  fit();
  dt_s_ = 0;
  stop();
}

void Chain::persist(Archive& archive) {
  archive.list(x_);
  archive.list(v_);
  archive.list(mu_);
  archive.value(dt_s_);
  archive.value(waits_);
  if (!archive.reads()) return;
  if (x_.size() < kLeastNodes || x_.size() > start_.size() || v_.size() != x_.size() || mu_.size() + 1 != x_.size())
    throw Error("a suture has " + std::to_string(x_.size()) + " nodes in the saved state, but here " +
                std::to_string(start_.size()));
  fit();
}

Chain Chain::part(size_t node) {
  assert(node + 1 >= kLeastNodes && node + kLeastNodes <= nodes());
  Chain behind = *this;
  behind.keep(node, nodes() - 1);
  keep(0, node);
  return behind;
}

void Chain::keep(size_t first, size_t last) {
  const auto from = static_cast<std::ptrdiff_t>(first), to = static_cast<std::ptrdiff_t>(last);
  x_ = std::vector<Vector3d>(x_.begin() + from, x_.begin() + to + 1);
  v_ = std::vector<Vector3d>(v_.begin() + from, v_.begin() + to + 1);
  mu_ = std::vector<double>(mu_.begin() + from, mu_.begin() + to);
  fit();
}

/// Resizes the arrays of a substep to the number of nodes.
void Chain::fit() {
  if (next_.size() == x_.size()) return;
  matrix_ = ChainMatrix(x_.size());
  for (std::vector<Vector3d>* positions : {&ahead_, &next_, &bent_}) positions->resize(x_.size());
  links_.resize(mu_.size());
  rest_.resize(x_.size());
}

ChainAround partAround(size_t node, ChainAround& around) {
  const auto cut = static_cast<uint32_t>(node);
  const auto at = static_cast<double>(node);
  ChainAround behind;
  behind.gravity_m_per_s2 = around.gravity_m_per_s2;
  moveBehind(
      around.holds, behind.holds, [&](const ChainHold& it) { return it.node + it.share > at; },
      [&](ChainHold& it) { it.node -= cut; });
  moveBehind(
      around.touches, behind.touches, [&](const ChainTouch& it) { return it.node > cut; },
      [&](ChainTouch& it) { it.node -= cut; });
  moveBehind(
      around.loads, behind.loads, [&](const ChainLoad& it) { return it.node > cut; },
      [&](ChainLoad& it) { it.node -= cut; });
  moveBehind(
      around.slides, behind.slides, [&](const ChainSlide& it) { return it.s > at; },
      [&](ChainSlide& it) { it.s -= at; });
  const auto opened = [&](const ChainKnot& it) { return (it.s1 > at) != (it.s2 > at); };
  around.knots.erase(std::remove_if(around.knots.begin(), around.knots.end(), opened), around.knots.end());
  moveBehind(
      around.knots, behind.knots, [&](const ChainKnot& it) { return it.s1 > at; },
      [&](ChainKnot& it) {
        it.s1 -= at;
        it.s2 -= at;
      });
  behind.swaged[1] = std::exchange(around.swaged[1], false);
  return behind;
}

}  // namespace viscera
