// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/chain/chain_run.h"

#include <algorithm>
#include <cmath>

namespace viscera {

namespace {

constexpr double kAtStop = 1e-6;        // links
constexpr double kMostLinks = 1;        // per iteration: the tangent changes after that
constexpr double kSlow_m_per_s = 1e-3;  // initial speed of sliding
constexpr double kBeginsAt = 0.5;  // of the holding stiffness, initially: in light tissue that speed would need more

}  // namespace

/// A point that is already nearer comes no nearer.
void ChainRun::stopAt(double other, double apart, bool runs, double s) {
  const double edge = runs ? (other + s) / 2 : other, keep = runs ? apart / 2 : apart;
  if (other > s) {
    high = std::min(high, std::max(s, edge - keep));
  } else {
    low = std::max(low, std::min(s, edge + keep));
  }
}

bool ChainRun::rub(const ChainShape& shape, double along, double limit, double off_m, double mass_kg, double s,
                   double& rub_kg) const {
  const double size = std::abs(along), over = size - limit;
  if (slips(rub_kg, mass_kg)) {
    rub_kg = orRigid(secant(limit, std::abs(slid_m + off_m), mass_kg), mass_kg);
    return size > kSlack * limit || (slips(rub_kg, mass_kg) && kSlack * size < limit);
  }
  const double left = along > 0 ? s - low : high - s;
  if (over <= 0 || left < kAtStop) return false;
  rub_kg = secant(limit, std::max(kSlow_m_per_s * shape.dt_s, over / mass_kg), kBeginsAt * mass_kg);
  return size > kSlack * limit;
}

/// At a sharp turn it moves farther along the bisector than along the chain.
bool ChainRun::follow(const ChainShape& shape, double off_m, double& s, bool& out) {
  const double link_m = shape.link_m / turn.along_link, last = static_cast<double>(shape.links.size());
  const double wanted = s - std::clamp(off_m / link_m, -kMostLinks, kMostLinks), to = std::clamp(wanted, low, high);
  out = to < 0 || to > last;
  const double before = s;
  s = std::clamp(to, 0.0, last);
  slid_m += (before - s) * link_m;
  return to != wanted;
}

}  // namespace viscera
