// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/chain/chain_points.h"

#include <algorithm>
#include <cmath>

namespace viscera {

namespace {

constexpr double kBackOnItself = 0.2;    // of the sum of two directions: below it they have no useful bisector
constexpr double kLeastAlong = 0.2;      // where it turns back: slow rather than not at all
constexpr double kStraightChain = 1e-3;  // [rad] of a turn with sines equal to its angle

constexpr double kLeastSlip_m = 1e-12;  // avoids a division by 0

}  // namespace

double secant(double limit, double slipped_m, double most_kg) {
  return std::min(most_kg, limit / std::max(slipped_m, kLeastSlip_m));
}

ChainPoint::ChainPoint(double s, size_t nodes)
    : node(static_cast<uint32_t>(std::clamp(s, 0.0, static_cast<double>(nodes) - 2))), share(s - node) {}

Vector3d ChainPoint::of(const std::vector<Vector3d>& positions) const {
  return (1 - share) * positions[node] + share * positions[node + 1];
}

void ChainPoint::push(const Vector3d& by, std::vector<ChainMatrix::Unknown>& rest) const {
  rest[node].position += (1 - share) * by;
  rest[node + 1].position += share * by;
}

ChainTurn::ChainTurn(const ChainPoint& point, const std::vector<ChainLink>& links) {
  const auto link = [&](int offset) -> const Vector3d& {
    const int last = static_cast<int>(links.size()) - 1;
    return links[static_cast<size_t>(std::clamp(static_cast<int>(point.node) + offset, 0, last))].along;
  };
  const Vector3d before = ((1 - point.share) * link(-2) + point.share * link(-1)).normalized();
  const Vector3d behind = ((1 - point.share) * link(1) + point.share * link(2)).normalized();
  const Vector3d both = before + behind;
  tangent = both.norm() > kBackOnItself ? both.normalized() : link(0);
  angle = std::acos(std::clamp(before.dot(behind), -1.0, 1.0));
  along_link = std::max(kLeastAlong, tangent.dot(link(0)));
}

double ChainTurn::alongBisector() const {
  return std::cos(angle / 2);
}

double capstan(double friction, double angle) {
  return angle < kStraightChain ? friction : std::tanh(friction * angle / 2) / std::tan(angle / 2);
}

}  // namespace viscera
