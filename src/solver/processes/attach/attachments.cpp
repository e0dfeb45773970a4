// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/attach/attachments.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "math/number_text.h"
#include "solver/processes/burn/burns.h"
#include "viscera/math/state_hash.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

namespace {

constexpr double kNothingLeft = 0.1;  // share of strength below which a burnt fibre is parted
constexpr double kBurnSeen = 1e-3;    // smallest change of that share
constexpr double kSquare_mm = 1e6;    // mm2 per m2
constexpr double kStrandGap = 0.5;    // of the thickness: fibres that are less open are not drawn

bool isSame(const layout::NodeBits& a, const layout::NodeBits& b) {
  return a.lo == b.lo && a.hi == b.hi;
}

/// Returns a normal at rest, carried along by tissue. @param gradient  of the displacement
Vector3d carriedNormal(const Eigen::Matrix3d& gradient, const Vector3d& normal) {
  const Eigen::Matrix3d by = Eigen::Matrix3d::Identity() + gradient;
  Eigen::Matrix3d cofactors;
  cofactors << by.col(1).cross(by.col(2)), by.col(2).cross(by.col(0)), by.col(0).cross(by.col(1));
  return (cofactors * normal).normalized();
}

}  // namespace

Attachments::Attachments(const Scene& scene, const Model& model)
    : configs_(scene.attachments),
      cells_(model),
      grown_(growFibres(scene, model, cells_)),
      forces_(model),
      blades_(scene.styluses) {
  orderStrands();
  reset();
}

/// Orders half of the fibres so that every beginning of the order is spread irregularly over all of them, always the
/// same: all of them would be as regular as the grid on which they grew.
void Attachments::orderStrands() {
  for (uint32_t f = 0; f < grown_.size(); ++f) strand_order_.push_back(f);
  const auto key = [](uint32_t f) {  // a hash of the index: multiplications and shifts that lose nothing
    uint32_t out = f * 2654435769U;
    out = (out ^ out >> 15U) * 2246822519U;
    return out ^ out >> 13U;
  };
  std::sort(strand_order_.begin(), strand_order_.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
  strand_order_.resize((strand_order_.size() + 1) / 2);
}

void Attachments::reset() {
  fibres_ = grown_;
  seen_.clear();
  opening_m_.assign(grown_.size(), 0);
  left_.assign(grown_.size(), 1);
  spent_j_.assign(configs_.size(), 0);
  cut_m2_.assign(configs_.size(), 0);
  burnt_m2_.assign(configs_.size(), 0);
  work_j_ = 0;
  forces_.embed(fibres_);
  updateSecants();
}

void Attachments::updateSecant(size_t f) {
  const CohesiveLaw law = grown_[f].law.weakened(static_cast<double>(left_[f]));
  const auto opening_m = static_cast<double>(opening_m_[f]);
  forces_.setSecant(f, law.secant(opening_m) * grown_[f].area_m2, std::max(opening_m, law.onset_m()));
}

void Attachments::updateSecants() {
  for (size_t f = 0; f < grown_.size(); ++f) updateSecant(f);
}

/// Moves the ends of fibres in cut cells to whole cells on their sides. Parts fibres for which there is none.
void Attachments::cutsChanged(const CutSprings& cuts) {
  if (cuts.nodes.empty()) return;
  const auto changed = [&](const TissuePoint& end) {
    if (seen_.empty()) return true;
    for (uint32_t c = 0; c < end.count; ++c) {
      if (!isSame(seen_[end.slots[c]], cuts.nodes[end.slots[c]])) return true;
    }
    return false;
  };
  bool any = false;
  for (size_t f = 0; f < fibres_.size(); ++f) {
    for (size_t e = 0; e < 2; ++e) {
      const Fibre& grown = grown_[f];
      TissuePoint& end = fibres_[f].ends[e];
      if (!changed(grown.ends[e]) && !changed(end)) continue;
      any = true;
      if (const auto moved = cells_.carry(grown.ends[e].body, grown.seats_m[e], grown.rest_m, cuts)) {
        end = *moved;
      } else {
        part(f, cut_m2_);
      }
    }
  }
  seen_ = cuts.nodes;
  if (!any) return;
  forces_.embed(fibres_);
  updateSecants();
}

bool Attachments::isWhole(size_t f) const {
  return left_[f] > 0 && static_cast<double>(opening_m_[f]) < grown_[f].law.end_m;
}

/// @param to  areas by attachment
void Attachments::part(size_t f, std::vector<double>& to) {
  if (isWhole(f)) to[grown_[f].attachment] += grown_[f].area_m2;
  left_[f] = 0;
  updateSecant(f);
}

void Attachments::beginTick(const ProcessTick& tick) {
  work_j_ = 0;
  may_be_cut_ = blades_.beginTick(tick.motions) && !tick.recovering;
}

bool Attachments::act(TissuePort& port, const ProcessTick&, const ProcessSubstep& substep) {
  forces_.read(port, substep.dt_s);
  if (substep.index == 0 && may_be_cut_) {
    for (size_t f = 0; f < grown_.size(); ++f) blades_.keep(spanOf(f));
  }
  forces_.pull([this](size_t f, const Vector3d& gap_m) { grow(f, gap_m); });
  work_j_ += forces_.apply(port, substep.dt_s);
  return false;
}

/// Returns the normal of the first body's surface at a fibre.
Vector3d Attachments::normalAt(size_t f) const {
  const TissuePoint& end = fibres_[f].ends[0];
  const Eigen::Matrix<double, 8, 3> slopes = cells_.slopes(end);
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
  for (uint32_t c = 0; c < end.count; ++c) gradient += forces_.displacement_m(end.slots[c]) * slopes.row(c);
  return carriedNormal(gradient, grown_[f].normal);
}

/// Records a larger opening. Overlap does not count: pressed tissue does not part.
void Attachments::grow(size_t f, const Vector3d& gap_m) {
  const double overlap_m = std::min(0.0, gap_m.dot(normalAt(f)));
  const double opening_m = std::sqrt(std::max(0.0, gap_m.squaredNorm() - overlap_m * overlap_m));
  const auto before_m = static_cast<double>(opening_m_[f]);
  const CohesiveLaw law = grown_[f].law.weakened(static_cast<double>(left_[f]));
  if (opening_m <= std::max(before_m, law.onset_m())) return;
  opening_m_[f] = static_cast<float>(opening_m);
  spent_j_[grown_[f].attachment] +=
      grown_[f].area_m2 * (law.spent(static_cast<double>(opening_m_[f])) - law.spent(before_m));
  updateSecant(f);
}

/// Returns a fibre as blades see it: it reaches through its connective tissue also while it is closed.
std::vector<Vector3d> Attachments::spanOf(size_t f) const {
  const Vector3d reach_m = 0.5 * configs_[grown_[f].attachment].thickness_m * normalAt(f);
  const Vector3d end_m = grown_[f].rest_m + forces_.firstEnd_m(f);
  return {end_m - reach_m, end_m + forces_.gap_m(f) + reach_m};
}

bool Attachments::endTick(TissuePort& port, const ProcessTick& tick, const TissueProcesses& all) {
  if (may_be_cut_) {
    forces_.read(port, 0);
    for (size_t f = 0; f < grown_.size(); ++f) {
      if (isWhole(f) && !blades_.met(f, spanOf(f)).empty()) part(f, cut_m2_);
    }
  }
  const Burns* const burns = tick.recovering ? nullptr : findProcess<Burns>(all);
  if (burns && burns->heat().isWarm()) weaken(*burns);
  return false;
}

/// Weakens fibres by the coagulated share of the tissue at their ends.
void Attachments::weaken(const Burns& burns) {
  for (size_t f = 0; f < grown_.size(); ++f) {
    if (!isWhole(f)) continue;
    double burnt = 0;
    for (const TissuePoint& end : grown_[f].ends) {
      double here = 0;
      for (uint32_t c = 0; c < end.count; ++c) {
        if (end.weights[c] > 0) here += static_cast<double>(end.weights[c]) * burns.heat().coagulated(end.slots[c]);
      }
      burnt = std::max(burnt, here);
    }
    const double left = 1 - burnt;
    if (left < kNothingLeft) {
      part(f, burnt_m2_);
    } else if (left < static_cast<double>(left_[f]) - kBurnSeen) {
      left_[f] = static_cast<float>(left);
      updateSecant(f);
    }
  }
}

void Attachments::persist(Archive& archive) {
  archive.section("attachments");
  archive.values(left_);
  archive.values(cut_m2_);
  archive.values(burnt_m2_);
  persistUndone(archive);
  if (!archive.reads()) return;
  const auto is_share = [](float left) { return left >= 0 && left <= 1; };
  archive.require(std::all_of(left_.begin(), left_.end(), is_share), "a share of strength is not within 0 .. 1");
  fibres_ = grown_;
  seen_.clear();
  forces_.embed(fibres_);
  updateSecants();
}

void Attachments::persistUndone(Archive& archive) {
  archive.values(opening_m_);
  archive.values(spent_j_);
  if (!archive.reads()) return;
  const auto is_opening = [](float opening_m) { return opening_m >= 0 && std::isfinite(opening_m); };
  archive.require(std::all_of(opening_m_.begin(), opening_m_.end(), is_opening), "an opening is not 0 or more");
}

void Attachments::undone(bool) {
  updateSecants();
}

bool Attachments::addTo(StateHash& hash) const {
  for (size_t f = 0; f < grown_.size(); ++f) {
    hash.add(opening_m_[f]);
    hash.add(left_[f]);
  }
  return true;
}

void Attachments::draw(ProcessVisuals& visuals) const {
  const auto thinner = [](const AttachmentConfig& a, const AttachmentConfig& b) {
    return a.thickness_m < b.thickness_m;
  };
  const double thinnest_m = std::min_element(configs_.begin(), configs_.end(), thinner)->thickness_m;
  if (forces_.largestGap_m() <= kStrandGap * thinnest_m) return;
  size_t count = 0;
  for (const uint32_t f : strand_order_) {
    if (!isWhole(f)) continue;
    const Vector3d gap_m = forces_.gap_m(f);
    if (gap_m.norm() <= kStrandGap * configs_[grown_[f].attachment].thickness_m) continue;
    const Vector3d from_m = grown_[f].rest_m + forces_.firstEnd_m(f);
    const double left = 1 - static_cast<double>(opening_m_[f]) / grown_[f].law.end_m;
    VisibleTube strand{0, TubeKind::kStrand, {}, std::sqrt(std::clamp(left, 0.0, 1.0))};
    for (size_t i = 0; i < kStrandNodes; ++i)
      strand.positions_m.emplace_back(from_m + static_cast<double>(i) / (kStrandNodes - 1) * gap_m);
    visuals.sutures.push_back(std::move(strand));
    if (++count == kMostStrands) return;
  }
}

std::vector<FibreState> Attachments::seen() const {
  std::vector<FibreState> out;
  for (size_t f = 0; f < grown_.size(); ++f) {
    FibreState fibre{{}, grown_[f].rest_m, grown_[f].area_m2, isWhole(f)};
    for (size_t e = 0; e < 2; ++e) {
      const TissuePoint& end = grown_[f].ends[e];
      const auto most = std::max_element(end.weights.begin(), end.weights.begin() + end.count);
      fibre.nodes[e] = end.slots[static_cast<size_t>(most - end.weights.begin())];
    }
    out.push_back(fibre);
  }
  return out;
}

FactGroup Attachments::facts() const {
  std::vector<double> area_m2(configs_.size(), 0), attached_m2(configs_.size(), 0), stiffness(configs_.size(), 0);
  std::vector<uint64_t> count(configs_.size(), 0);
  double all_m2 = 0, all_attached_m2 = 0, spent_j = 0;
  for (size_t f = 0; f < grown_.size(); ++f) {
    const Fibre& fibre = grown_[f];
    const uint32_t i = fibre.attachment;
    ++count[i];
    area_m2[i] += fibre.area_m2;
    stiffness[i] += fibre.area_m2 * fibre.law.stiffness_n_per_m3;
    if (isWhole(f)) attached_m2[i] += fibre.area_m2;
  }
  std::vector<Fact::Facts> on;
  for (size_t i = 0; i < configs_.size(); ++i) {
    on.push_back({{"body_a", configs_[i].body_a},
                  {"body_b", configs_[i].body_b},
                  {"fibres", count[i]},
                  {"stiffness_n_per_m3", stiffness[i] / area_m2[i]},
                  {"area_m2", area_m2[i]},
                  {"attached_m2", attached_m2[i]},
                  {"torn_m2", std::max(0.0, area_m2[i] - attached_m2[i] - cut_m2_[i] - burnt_m2_[i])},
                  {"cut_m2", cut_m2_[i]},
                  {"burnt_m2", burnt_m2_[i]},
                  {"spent_j", spent_j_[i]}});
    all_m2 += area_m2[i];
    all_attached_m2 += attached_m2[i];
    spent_j += spent_j_[i];
  }
  FactGroup out{"attachments", numberText(kSquare_mm * all_attached_m2, 4) + " of " +
                                   numberText(kSquare_mm * all_m2, 4) + " mm2 attached"};
  out.facts = {{"stored_j", forces_.stored_j()}, {"spent_j", spent_j}, {"on", std::move(on)}};
  return out;
}

}  // namespace viscera
