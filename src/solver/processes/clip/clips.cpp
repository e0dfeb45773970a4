// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/clip/clips.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "math/decompositions.h"
#include "model/body/body_nodes.h"
#include "model/scene/tool_kinds.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

constexpr int kClipSweeps = 2;            // over the pairs: nodes are in several
constexpr double kCloses = 0.2;           // share of the gap that is closed per substep
constexpr double kCloses_m_per_s = 0.05;  // largest closing speed: about that of jaws closed by hand
constexpr double kOpens_m_per_s = 0.02;   // opening speed of sides that are too near: slow, as this speed remains
constexpr double kClosedBelow_rad = 0.1;  // opening angle below which jaws close a clip; grippers stop there
constexpr double kNearest_m = 1e-7;       // sides that are nearer have no direction
constexpr double kColumn = 0.5;           // spacings across the jaws' direction: nodes that near hide those behind them
constexpr double kFacing = 0.75;   // spacings, the same: nodes that near are in one column, also in rotated lattices
constexpr double kSlab = 0.5001;   // spacings on either side of a clip's middle, wide enough to contain a layer
constexpr int kLineSamples = 16;   // on a line through a hollow vessel
constexpr double kLeg_m = 0.0005;  // length by which a clip extends beyond the held tissue, and distance outside it

/// Returns the distance of two positions projected along x.
double apartAcross_m(const Vector3d& a, const Vector3d& b) {
  return std::hypot(a.y() - b.y(), a.z() - b.z());
}

}  // namespace

Clips::Clips(const std::vector<StylusConfig>& styluses, const Model& model, std::vector<uint8_t> hollow)
    : styluses_(styluses),
      model_(model),
      hollow_(std::move(hollow)),
      spacing_m_(longestSpacing(model)),
      points_(model),
      blades_(styluses) {}

/// Finds the jaws that close in this tick, and records the positions of clips, for blades.
void Clips::beginTick(const ProcessTick& tick) {
  for (size_t s = 0; s < styluses_.size(); ++s) {
    const StylusMotion& motion = tick.motions[s];
    const bool closed = motion.present && kindOf(motion.mode).clips && motion.opens_to_rad <= kClosedBelow_rad;
    closes_[s] = closed && !closed_[s];
    closed_[s] = closed;
    jaws_[s] = motion.from;
  }
  if (blades_.beginTick(tick.motions)) {
    for (size_t c = 0; c < clips_.size(); ++c) blades_.keep(positions_m(c));
  }
  work_j_ = 0;
}

bool Clips::act(TissuePort& port, const ProcessTick&, const ProcessSubstep& substep) {
  if (substep.index == 0) set(port);
  if (clips_.empty()) return false;
  std::vector<const TissuePoint*> points;
  for (const Clip& clip : clips_) {
    for (const std::array<TissuePoint, 2>& pair : clip.points) points.insert(points.end(), {&pair[0], &pair[1]});
  }
  points_.read(port, points);
  hold(substep.dt_s);
  points_.write(port, layout::kMaxStyluses, substep.dt_s);
  work_j_ += points_.work_j();
  return false;
}

/// Removes the clips that blades have met, of those that were there when the tick began.
bool Clips::endTick(TissuePort&, const ProcessTick&, const TissueProcesses&) {
  for (size_t c = blades_.kept(); c-- > 0;) {
    if (blades_.met(c, positions_m(c)).empty()) continue;
    clips_.erase(clips_.begin() + static_cast<std::ptrdiff_t>(c));
    ++taken_off_;
  }
  return false;
}

std::vector<Clips::Near> Clips::nodesIn(const TissuePort& port, const Pose& jaws, const ClipConfig& config) const {
  std::vector<uint32_t> slots;
  std::vector<Near> all;
  for (uint32_t b = 0; b < model_.bodies.size(); ++b) {
    forEachNode(model_.bodies[b], [&](uint32_t slot) {
      all.push_back({b, slot, restPosition(model_.bodies[b], slot), {}});
      slots.push_back(model_.slotOffset(b) + slot);
    });
  }
  std::vector<Vector3f> u_m(slots.size()), v_m_per_s(slots.size());
  port.readNodes(slots, u_m, v_m_per_s);
  const Pose to_jaws = jaws.inverse();
  const double half_width_m = std::max(0.5 * config.width_m, kSlab * spacing_m_);
  std::vector<Near> out;
  for (size_t i = 0; i < all.size(); ++i) {
    Near& node = all[i];
    node.at_m += u_m[i].cast<double>();
    node.in_jaws_m = to_jaws * node.at_m;
    const Vector3d& at = node.in_jaws_m;
    if (std::abs(at.x()) <= 0.5 * config.opening_m && std::abs(at.y()) <= half_width_m && at.z() >= 0 &&
        at.z() <= config.jaw_length_m)
      out.push_back(node);
  }
  return out;
}

/// Sets the clips of jaws that close, at the current positions of nodes.
void Clips::set(const TissuePort& port) {
  for (uint32_t s = 0; s < styluses_.size(); ++s) {
    const ClipConfig& config = styluses_[s].clip;
    if (!std::exchange(closes_[s], false) || used_[s] >= config.magazine || clips_.size() == kMostClips) continue;
    ++used_[s];
    if (!add(s, jaws_[s], config, nodesIn(port, jaws_[s], config))) ++empty_;
  }
}

/// Adds a clip. A column is the nodes behind each other along the jaws' direction. Its nodes are paired from the
/// outside in: with the outermost two alone, these would pass through the nodes between them.
bool Clips::add(uint32_t stylus, const Pose& jaws, const ClipConfig& config, const std::vector<Near>& nodes) {
  const auto isOutermost = [&](const Near& node) {
    return std::none_of(nodes.begin(), nodes.end(), [&](const Near& other) {
      return other.in_jaws_m.x() > node.in_jaws_m.x() &&
             apartAcross_m(other.in_jaws_m, node.in_jaws_m) < kColumn * spacing_m_;
    });
  };
  Clip clip;
  clip.stylus = stylus;
  double low_m = std::numeric_limits<double>::infinity(), high_m = 0, middle_m = 0;
  for (const Near& top : nodes) {
    if (!isOutermost(top)) continue;
    std::vector<const Near*> column;
    for (const Near& node : nodes) {
      if (apartAcross_m(node.in_jaws_m, top.in_jaws_m) < kFacing * spacing_m_) column.push_back(&node);
    }
    std::stable_sort(column.begin(), column.end(),
                     [](const Near* a, const Near* b) { return a->in_jaws_m.x() > b->in_jaws_m.x(); });
    for (size_t i = 0, j = column.size() - 1; i < j; ++i, --j) {
      const Near &a = *column[i], &b = *column[j];
      if (a.in_jaws_m.x() - b.in_jaws_m.x() < kNearest_m) continue;
      clip.pairs.push_back(pairOf(a, b, config));
      low_m = std::min(low_m, std::min(a.in_jaws_m.z(), b.in_jaws_m.z()));
      high_m = std::max(high_m, std::max(a.in_jaws_m.z(), b.in_jaws_m.z()));
      middle_m += 0.5 * (a.in_jaws_m.x() + b.in_jaws_m.x());
    }
  }
  if (clip.pairs.empty()) return false;
  middle_m /= static_cast<double>(clip.pairs.size());
  clip.leg_m = {jaws * Vector3d(middle_m, 0, low_m - kLeg_m), jaws * Vector3d(middle_m, 0, high_m + kLeg_m)};
  clip.across = jaws.orientation * Vector3d::UnitX();
  findPoints(clip);
  clips_.push_back(std::move(clip));
  return true;
}

/// Returns the length of tissue at rest on the line between two nodes: without the lumen of a vessel.
double Clips::tissueBetween_m(const Body& body, uint32_t a, uint32_t b) const {
  const Vector3d from = restPosition(body, a), line = restPosition(body, b) - from;
  double share = 0;
  for (int i = 0; i < kLineSamples; ++i) {
    const Vector3d at = (from + (i + 0.5) / kLineSamples * line - body.lattice.origin_m) / body.lattice.spacing_m;
    const int64_t cell = body.lattice.slotAt(Vector3i(at.array().floor().cast<int>()));
    if (cell >= 0 && body.lattice.cell_labels[static_cast<size_t>(cell)] != 0)
      share += fillOf(body.lattice, static_cast<uint32_t>(cell)).share / kLineSamples;
  }
  return share * line.norm();
}

Clips::Pair Clips::pairOf(const Near& a, const Near& b, const ClipConfig& config) const {
  Pair out{a.body, a.slot, b.body, b.slot, config.gap_m, a.at_m, b.at_m, a.at_m, b.at_m};
  if (a.body != b.body) return out;
  const Body& body = model_.bodies[a.body];
  const bool is_hollow = a.body < hollow_.size() && hollow_[a.body] != 0;
  const double between_m = is_hollow ? tissueBetween_m(body, a.slot, b.slot)
                                     : (restPosition(body, a.slot) - restPosition(body, b.slot)).norm();
  out.least_m = std::max(out.least_m, kMostSqueezed * between_m);
  return out;
}

void Clips::findPoints(Clip& clip) const {
  clip.points.clear();
  for (const Pair& pair : clip.pairs)
    clip.points.push_back({nodePoint(model_, pair.body_a, pair.a), nodePoint(model_, pair.body_b, pair.b)});
}

/// Holds the pairs of a clip together. They share its force and yield beyond it.
void Clips::hold(double dt_s) {
  for (Clip& clip : clips_) {
    const double most_ns = styluses_[clip.stylus].clip.force_n * dt_s / static_cast<double>(clip.pairs.size());
    std::vector<double> given_ns(clip.pairs.size(), 0);
    for (int sweep = 0; sweep < kClipSweeps; ++sweep) {
      for (size_t i = 0; i < clip.pairs.size(); ++i) {
        const auto& [a, b] = clip.points[i];
        const Vector3d between = points_.position_m(b) - points_.position_m(a);
        const double length_m = between.norm();
        const double mobility = points_.mobility(a, a) + points_.mobility(b, b);
        if (length_m < kNearest_m || !(mobility > 0)) continue;
        const Vector3d out = between / length_m;
        const double away_m_per_s = (points_.velocity_m_per_s(b) - points_.velocity_m_per_s(a)).dot(out);
        const double wanted_m_per_s =
            -std::clamp(kCloses * (length_m - clip.pairs[i].least_m) / dt_s, -kOpens_m_per_s, kCloses_m_per_s);
        const double before_ns = given_ns[i];
        given_ns[i] = std::clamp(before_ns + (away_m_per_s - wanted_m_per_s) / mobility, -most_ns, most_ns);
        const Vector3d impulse = (given_ns[i] - before_ns) * out;
        points_.give(a, impulse, dt_s);
        points_.give(b, -impulse, dt_s);
      }
    }
    clip.force_n = 0;
    for (size_t i = 0; i < clip.pairs.size(); ++i) {
      clip.force_n += given_ns[i] / dt_s;
      clip.pairs[i].now_a_m = points_.position_m(clip.points[i][0]);
      clip.pairs[i].now_b_m = points_.position_m(clip.points[i][1]);
    }
  }
}

/// Returns both legs and the part that joins them, tissue frame. They move as a rigid body with the held nodes, with
/// the legs as far apart as the sides.
std::vector<Vector3d> Clips::positions_m(size_t at) const {
  const Clip& clip = clips_[at];
  const auto count = static_cast<Eigen::Index>(2 * clip.pairs.size());
  Eigen::Matrix3Xd set(3, count), now(3, count);
  double apart_m = 0;
  for (size_t i = 0; i < clip.pairs.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(2 * i);
    set.col(k) = clip.pairs[i].set_a_m;
    set.col(k + 1) = clip.pairs[i].set_b_m;
    now.col(k) = clip.pairs[i].now_a_m;
    now.col(k + 1) = clip.pairs[i].now_b_m;
    apart_m = std::max(apart_m, (clip.pairs[i].now_a_m - clip.pairs[i].now_b_m).norm());
  }
  const Vector3d from = set.rowwise().mean(), to = now.rowwise().mean();
  Eigen::Matrix3d turn = rigidMotion(set, now).topLeftCorner<3, 3>();
  // A single pair does not determine the rotation about its line.
  if (clip.pairs.size() < 2)
    turn = rotationBetween(set.col(0) - set.col(1), now.col(0) - now.col(1)).toRotationMatrix();
  const Vector3d side = (0.5 * apart_m + kLeg_m) * (turn * clip.across);
  const Vector3d tip = to + turn * (clip.leg_m[0] - from), end = to + turn * (clip.leg_m[1] - from);
  return {tip - side, end - side, end + side, tip + side};
}

std::vector<std::array<Vector3d, 2>> Clips::squeezed_m() const {
  std::vector<std::array<Vector3d, 2>> out;
  for (const Squeezed& one : squeezed()) out.push_back(one.ends_m);
  return out;
}

std::vector<Clips::Squeezed> Clips::squeezed() const {
  std::vector<Squeezed> out;
  for (uint32_t c = 0; c < clips_.size(); ++c) {
    for (const auto& [a, b] : clips_[c].points) out.push_back({c, {a.body, b.body}, {a.rest_m, b.rest_m}});
  }
  return out;
}

ClipStates Clips::seen() const {
  ClipStates out{{}, empty_, taken_off_};
  for (const Clip& clip : clips_) {
    ClipState& seen = out.on.emplace_back();
    seen.stylus = clip.stylus;
    seen.force_n = clip.force_n;
    const double share = 1 / static_cast<double>(clip.pairs.size());
    for (size_t i = 0; i < clip.pairs.size(); ++i) {
      seen.rest_m += 0.5 * share * (clip.points[i][0].rest_m + clip.points[i][1].rest_m);
      seen.opening_m = std::max(seen.opening_m, (clip.pairs[i].now_a_m - clip.pairs[i].now_b_m).norm());
    }
  }
  return out;
}

void Clips::reset() {
  clips_.clear();
  closed_ = closes_ = {};
  used_ = {};
  empty_ = taken_off_ = 0;
}

void Clips::persist(Archive& archive) {
  archive.section("clips");
  archive.value(closed_);
  archive.value(used_);
  archive.value(empty_);
  archive.value(taken_off_);
  uint64_t count = clips_.size();
  archive.value(count);
  if (count > kMostClips) throw Error("the saved state has " + std::to_string(count) + " clips");
  clips_.resize(count);
  for (Clip& clip : clips_) {
    archive.value(clip.stylus);
    archive.value(clip.leg_m);
    archive.value(clip.across);
    archive.value(clip.force_n);
    archive.list(clip.pairs);
    if (!archive.reads()) continue;
    if (clip.stylus >= styluses_.size())
      throw Error("the saved state has a clip of a stylus that the scene does not have");
    for (const Pair& pair : clip.pairs) {
      for (const auto& [body, slot] : {std::pair(pair.body_a, pair.a), std::pair(pair.body_b, pair.b)}) {
        if (body >= model_.bodies.size() ||
            slot >= model_.bodies[body].lattice.bricks.size() * size_t{layout::kBrickSlots})
          throw Error("the saved state has a clip on a node that the scene does not have");
      }
    }
    findPoints(clip);
  }
}

bool Clips::addTo(StateHash& hash) const {
  for (const Clip& clip : clips_) {
    for (const Pair& pair : clip.pairs) {
      hash.add(pair.a);
      hash.add(pair.b);
    }
  }
  return true;
}

FactGroup Clips::facts() const {
  const ClipStates all = seen();
  std::vector<Fact::Facts> on;
  for (const ClipState& clip : all.on) {
    on.push_back({{"stylus", uint64_t{clip.stylus}},
                  {"rest_m", std::vector<double>{clip.rest_m.x(), clip.rest_m.y(), clip.rest_m.z()}},
                  {"opening_m", clip.opening_m},
                  {"force_n", clip.force_n}});
  }
  FactGroup out{"clips", std::to_string(on.size()) + " on tissue"};
  out.facts = {{"empty", uint64_t{all.empty}}, {"taken_off", uint64_t{all.taken_off}}, {"on", std::move(on)}};
  return out;
}

void Clips::draw(ProcessVisuals& visuals) const {
  for (size_t c = 0; c < clips_.size(); ++c) visuals.sutures.push_back({0, TubeKind::kClip, positions_m(c)});
}

}  // namespace viscera
