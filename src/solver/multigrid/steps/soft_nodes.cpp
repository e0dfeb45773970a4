// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/multigrid/steps/soft_nodes.h"

#include <algorithm>
#include <cmath>

#include "viscera/model/body/neighbors.h"

namespace viscera::multigrid {

namespace {

constexpr double kSoft = 0.05;        // of the springs of the stiffest node
constexpr float kFirstShare = 0.02f;  // curvatures were found down to -2e-3 of a node's springs
constexpr float kLeastShare = 1e-3f;  // with less, systems of all nodes take several times the iterations
constexpr float kMostShare = 1;       // a node moves by less than its springs ask for
constexpr float kEase = 0.25f;        // of a share
constexpr float kStiffen = 4;         // times a share
constexpr double kForeseen = 0.3;     // of a node's residual: what of it was not foreseen, at most
constexpr double kWorse = 1;          // the same, at least
constexpr double kHeldUp = 0.3;       // of a residual of all nodes: left by a step
constexpr double kBeside = 0.3;       // of what other nodes lack: not worth relaxing
constexpr double kStays = 0.3;        // of what soft nodes lack: those that lack least are not looked at
constexpr double kOfEnough = 0.5;     // what soft nodes may lack, of what all may
constexpr int kRounds = 6;            // of choosing
constexpr int kSteps = 4;             // of Newton's method in one
constexpr double kRelaxed = 0.2;      // of what the chosen lack: left by a round
constexpr int kIterations = 30;       // of a step
constexpr double kTolerance = 0.1;    // of its system
constexpr float kFarthest = 0.1f;     // spacings that a step may carry a node

}  // namespace

SoftNodes::SoftNodes(StageSolver& solver)
    : solver_(solver), soft_at_(solver.level.grid().nodeCount(), -1), common_share_(kFirstShare) {
  const FineLevel& level = solver_.level;
  const Grid& grid = level.grid();
  for (Vectors* each : {&u_, &r_, &last_r_, &s_, &p_, &q_, &z_, &force_}) each->assign(3 * level.places(), 0);
  std::vector<std::vector<Spring>> all(grid.nodeCount());
  std::vector<double> sums(grid.nodeCount(), 0);
  double stiffest = 0;
  for (uint32_t node = 0; node < grid.nodeCount(); ++node) {
    const size_t place = grid.place_of[node];
    for (size_t pair = 0; pair < kPairs; ++pair) {
      const std::array<int, 3>& o = kNeighborOffsets[2 * pair];
      for (const int side : {1, -1}) {
        const size_t far = grid.beside(grid.bodyOf(node), place, side * o[0], side * o[1], side * o[2]);
        const float k = level.stiffness(pair, side > 0 ? place : far);
        if (k == 0) continue;
        all[node].push_back({static_cast<uint32_t>(far), k});
        sums[node] += static_cast<double>(k);
      }
    }
    stiffest = std::max(stiffest, sums[node]);
  }
  starts_.push_back(0);
  for (uint32_t node = 0; node < grid.nodeCount(); ++node) {
    if (sums[node] > kSoft * stiffest || level.free()[grid.place_of[node]] == 0) continue;
    soft_at_[node] = static_cast<int32_t>(nodes_.size());
    springs_.insert(springs_.end(), all[node].begin(), all[node].end());
    nodes_.push_back(node);
    starts_.push_back(static_cast<uint32_t>(springs_.size()));
  }
  share_.assign(nodes_.size(), kFirstShare);
}

/// Adds to q what a share of a node's springs makes of p, on both their ends.
void SoftNodes::addSprings(uint32_t soft, float share, const Vectors& p, Vectors& q) const {
  const size_t n = solver_.level.places(), near = placeOf(soft);
  for (uint32_t i = starts_[soft]; i < starts_[soft + 1]; ++i) {
    const size_t far = springs_[i].far;
    const float k = share * springs_[i].stiffness_n_per_m, free = solver_.level.free()[far];
    for (size_t c = 0; c < 3; ++c) {
      const float pull = k * (p[c * n + near] - p[c * n + far]);
      q[c * n + near] += pull;
      q[c * n + far] -= free * pull;
    }
  }
}

void SoftNodes::addTo(const Vectors& p, Vectors& q) const {
  for (uint32_t soft = 0; soft < nodes_.size(); ++soft)
    addSprings(soft, common_share_ * std::max(1.0f, share_[soft] / kFirstShare), p, q);
}

void SoftNodes::sagged() {
  common_share_ = std::min(kStiffen * common_share_, kMostShare);
}

void SoftNodes::learn(double before_n, double after_n) {
  if (after_n > kHeldUp * before_n) common_share_ = std::max(kEase * common_share_, kLeastShare);
}

/// As few soft nodes as lack most of what soft nodes lack, and those beside them.
/// @return norm of what all soft nodes lack
double SoftNodes::choose(double enough_n) {
  const Grid& grid = solver_.level.grid();
  const size_t n = solver_.level.places();
  std::vector<std::pair<double, uint32_t>> lacks;
  double sum2 = 0;
  for (uint32_t soft = 0; soft < nodes_.size(); ++soft) {
    double lacks2 = 0;
    for (size_t j = placeOf(soft); j < 3 * n; j += n) lacks2 += static_cast<double>(r_[j] * r_[j]);
    lacks.emplace_back(lacks2, soft);
    sum2 += lacks2;
  }
  std::sort(lacks.begin(), lacks.end(), std::greater<>());
  const double stays2 = std::max(enough_n * enough_n, kStays * kStays * sum2);
  std::vector<uint8_t> wanted(nodes_.size(), 0);
  double left2 = sum2;
  for (const auto& [lacks2, soft] : lacks) {
    if (left2 <= stays2) break;
    left2 -= lacks2;
    wanted[soft] = 1;
    for (uint32_t i = starts_[soft]; i < starts_[soft + 1]; ++i) {
      const int32_t beside = soft_at_[static_cast<size_t>(grid.node_at[springs_[i].far])];
      if (beside >= 0) wanted[static_cast<size_t>(beside)] = 1;
    }
  }
  chosen_.clear();
  std::vector<uint32_t> of_grid;
  for (uint32_t soft = 0; soft < nodes_.size(); ++soft) {
    if (!wanted[soft]) continue;
    chosen_.push_back(soft);
    of_grid.push_back(nodes_[soft]);
  }
  region_ = solver_.level.around(of_grid);
  return std::sqrt(sum2);
}

/// Calls each(index) for the components of the chosen nodes.
template <class Each>
void SoftNodes::forNumbers(const Each& each) const {
  const size_t n = solver_.level.places();
  for (const uint32_t soft : chosen_) {
    for (size_t j = placeOf(soft); j < 3 * n; j += n) each(j);
  }
}

double SoftNodes::dot(const Vectors& a, const Vectors& b) const {
  double sum = 0;
  forNumbers([&](size_t j) { sum += static_cast<double>(a[j]) * static_cast<double>(b[j]); });
  return sum;
}

/// Residual of the chosen at u_. @return its norm
double SoftNodes::balance() {
  FineLevel& level = solver_.level;
  const size_t n = level.places();
  level.lineariseIn(region_, u_, solver_.velocity);
  forNumbers([&](size_t j) {
    force_[j] = level.force()[j];
    r_[j] = force_[j] + solver_.load[j] + level.mass()[j % n] * solver_.gravity[static_cast<int>(j / n)];
  });
  return std::sqrt(dot(r_, r_));
}

/// q = (K + shares of springs) p of the chosen, K by differences of forces.
void SoftNodes::multiply(const Vectors& p, Vectors& q) {
  FineLevel& level = solver_.level;
  const size_t n = level.places();
  float farthest = 0;
  for (const uint32_t soft : chosen_) {
    for (size_t j = placeOf(soft); j < 3 * n; j += n) farthest = std::max(farthest, std::abs(p[j]) / spacingOf(soft));
  }
  const float way = kWayOfDifferences / std::max(farthest, 1e-30f), per = 1 / way;
  forNumbers([&](size_t j) {
    z_[j] = u_[j];
    u_[j] += way * p[j];
  });
  level.lineariseIn(region_, u_, solver_.velocity);
  forNumbers([&](size_t j) {
    q[j] = per * (force_[j] - level.force()[j]);
    u_[j] = z_[j];
  });
  for (const uint32_t soft : chosen_) addSprings(soft, share_[soft], p, q);
}

/// s_ by conjugate gradients; where the energy is not convex, as far as they came.
void SoftNodes::solve() {
  const FineLevel& level = solver_.level;
  const size_t n = level.places();
  const double enough = kTolerance * std::sqrt(dot(r_, r_));
  double before = 0;
  forNumbers([&](size_t j) {
    s_[j] = 0;
    last_r_[j] = r_[j];
  });
  for (int k = 0; k < kIterations; ++k) {
    double rz = 0;
    for (const uint32_t soft : chosen_) {
      const size_t at = placeOf(soft);
      const Vector3f r(r_[at], r_[n + at], r_[2 * n + at]), z = level.solveBlock(at, r);
      rz += static_cast<double>(r.dot(z));
      for (size_t c = 0; c < 3; ++c) z_[c * n + at] = z[static_cast<int>(c)];
    }
    if (!(rz > 0)) break;
    const float beta = k == 0 ? 0 : static_cast<float>(rz / before);
    before = rz;
    forNumbers([&](size_t j) { p_[j] = z_[j] + (k == 0 ? 0 : beta * p_[j]); });
    multiply(p_, q_);
    const double curvature = dot(p_, q_);
    if (!(curvature > 0)) {
      for (const uint32_t soft : chosen_) {
        float own = 0;
        for (size_t j = placeOf(soft); j < 3 * n; j += n) own += p_[j] * q_[j];
        if (own < 0) share_[soft] = std::min(kStiffen * share_[soft], kMostShare);
      }
      break;
    }
    const auto alpha = static_cast<float>(rz / curvature);
    forNumbers([&](size_t j) {
      s_[j] += alpha * p_[j];
      r_[j] -= alpha * q_[j];
    });
    if (std::sqrt(dot(r_, r_)) <= enough) break;
  }
  forNumbers([&](size_t j) { p_[j] = 0; });  // those who are chosen next may be beside
}

void SoftNodes::bound() {
  const size_t n = solver_.level.places();
  for (const uint32_t soft : chosen_) {
    const size_t at = placeOf(soft);
    const float length = Vector3f(s_[at], s_[n + at], s_[2 * n + at]).norm(), most = kFarthest * spacingOf(soft);
    if (length <= most) continue;
    for (size_t j = at; j < 3 * n; j += n) s_[j] *= most / length;
  }
}

/// Each one's share, by how near its residual is to that which the step was to leave: what its share of springs holds.
void SoftNodes::trust() {
  const size_t n = solver_.level.places();
  forNumbers([&](size_t j) { q_[j] = 0; });
  for (const uint32_t soft : chosen_) addSprings(soft, share_[soft], s_, q_);
  for (const uint32_t soft : chosen_) {
    double was2 = 0, off2 = 0;
    for (size_t j = placeOf(soft); j < 3 * n; j += n) {
      const float off = r_[j] - q_[j];
      was2 += static_cast<double>(last_r_[j] * last_r_[j]);
      off2 += static_cast<double>(off * off);
    }
    if (off2 > kWorse * kWorse * was2)
      share_[soft] = std::min(kStiffen * share_[soft], kMostShare);
    else if (off2 < kForeseen * kForeseen * was2)
      share_[soft] = std::max(kEase * share_[soft], kLeastShare);
  }
}

/// One of Newton's method, if the energy falls on its way. @return it did
bool SoftNodes::step() {
  solve();
  bound();
  forNumbers([&](size_t j) { u_[j] += s_[j]; });
  balance();
  trust();
  if (dot(s_, r_) + dot(s_, last_r_) >= 0) return true;  // twice what it fell, by the forces at both ends
  forNumbers([&](size_t j) { u_[j] -= s_[j]; });
  balance();
  for (const uint32_t soft : chosen_) share_[soft] = std::min(kStiffen * share_[soft], kMostShare);
  return false;
}

void SoftNodes::relaxChosen() {
  double norm = balance();
  const double enough = kRelaxed * norm;
  for (int k = 0; k < kSteps && norm > enough; ++k) {
    if (step()) norm = std::sqrt(dot(r_, r_));
  }
  forNumbers([&](size_t j) { s_[j] = 0; });
}

bool SoftNodes::relax(Vectors& increment, double norm_n, double enough_n) {
  u_ = solver_.displacement;
  r_ = solver_.lacking();
  double others_n = -1;
  bool moved = false;
  for (int round = 0; round < kRounds; ++round) {
    const double soft_n = choose(kOfEnough * enough_n);
    if (round == 0) others_n = std::sqrt(std::max(0.0, norm_n * norm_n - soft_n * soft_n));
    if (chosen_.empty() || soft_n <= std::max(kOfEnough * enough_n, kBeside * others_n)) break;
    relaxChosen();
    moved = true;
  }
  if (moved) {
    for (size_t j = 0; j < increment.size(); ++j) increment[j] = u_[j] - solver_.start[j];
  }
  return moved;
}

}  // namespace viscera::multigrid
