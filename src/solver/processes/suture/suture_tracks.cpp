// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/suture_tracks.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "math/archive.h"
#include "math/number_text.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

constexpr double kBowelPullOut_n = 4.6;          // docs/sutures.md
constexpr double kFasciaPullOut_n_per_m = 45e3;  // of the bite
constexpr double kThrough_m = 1e-4;              // over Young's modulus: friction of a length of suture in tissue
constexpr double kTrackCutStep = 0.125;          // of the spacing: length of tearing after which springs are cut
constexpr double kMostTorn = 0.5;                // of the spacing: largest tear in a substep
constexpr double kHeld = 1;        // of the spacing: length behind a channel in which tissue is not cut yet
constexpr double kOneTrack = 1.5;  // links, at rest: channels keep at least one link of the chain between them

constexpr double kBeforeNext = 0.5;    // of its position on the chain: a new channel is not behind that
constexpr double kPassesAgain = 0.25;  // in links: margin over the nearest distance from a point

struct OnChain {
  double s = 0, off_m = 0;
};

/// Returns the nearest point of a chain to a point, from some link on.
OnChain nearestOn(const Chain& chain, const Vector3d& at_m, double first) {
  OnChain out{0, std::numeric_limits<double>::infinity()};
  const std::vector<Vector3d>& x = chain.positions_m();
  for (size_t i = static_cast<size_t>(std::max(first, 0.0)); i + 1 < x.size(); ++i) {
    const Vector3d link = x[i + 1] - x[i];
    const double least = std::clamp(first - static_cast<double>(i), 0.0, 1.0);
    const double share = std::clamp((at_m - x[i]).dot(link) / link.squaredNorm(), least, 1.0);
    const double off_m = (x[i] + share * link - at_m).norm();
    if (off_m < out.off_m) out = {static_cast<double>(i) + share, off_m};
  }
  return out;
}

std::string millimetres(double m) {
  return numberText(1e3 * m) + " mm";
}

/// @param before  position of the previous channel on the chain; negative: none
double positionOn(const Chain& chain, const Vector3d& at_m, double before, const std::string& where) {
  const OnChain any = nearestOn(chain, at_m, 0);
  if (any.off_m > chain.link_m())
    throw SceneError(where + "its suture passes at a distance of " + millimetres(any.off_m) + "; at most one link, " +
                     millimetres(chain.link_m()) + ", is accepted");
  if (before < 0 || any.s >= before + 1) return any.s;
  const OnChain ahead = nearestOn(chain, at_m, before + 1);
  if (ahead.off_m <= any.off_m + kPassesAgain * chain.link_m()) return ahead.s;
  if (any.s <= before)
    throw SceneError(where +
                     "does not follow the previous channel along the suture's path; list channels in the "
                     "order of the path");
  throw SceneError(where + "is " + millimetres((any.s - before) * chain.link_m()) +
                   " of suture after the previous channel; at least one link, " + millimetres(chain.link_m()) +
                   ", is accepted");
}

layout::vec4 asVec4(const Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), 0};
}

}  // namespace

TrackLaw trackLawOf(const SutureConfig& config, const Body& body) {
  const double young_pa = body.material.young_modulus_pa;
  TrackLaw out{config.friction, config.through_n_per_m, config.pull_out_n};
  if (!(out.through_n_per_m > 0)) out.through_n_per_m = kThrough_m * young_pa;
  if (out.pull_out_n > 0) return out;
  switch (config.tissue) {
    case StitchedTissue::kBowel:
      out.pull_out_n = kBowelPullOut_n;
      return out;
    case StitchedTissue::kFascia:
      out.pull_out_n = kFasciaPullOut_n_per_m * config.bite_m;
      return out;
    default:
      out.pull_out_n = young_pa * config.bite_m * config.depth_m;
      return out;
  }
}

void SutureTracks::lay(const SutureConfig& config, const Chain& chain, const Model& model, const TissuePoints& points,
                       std::vector<ChainSlide>& slides) {
  double before = -1;
  for (size_t k = 0; k < config.channels.size(); ++k) {
    const SutureChannelConfig& of = config.channels[k];
    const std::string where = "suture '" + config.name + "': channels[" + std::to_string(k) + "]: ";
    uint32_t b = 0;
    while (b < model.bodies.size() && !of.body.empty() && model.bodies[b].name != of.body) ++b;
    if (b == model.bodies.size()) throw SceneError(where + "there is no body '" + of.body + "'");
    const std::optional<TissuePoint> point = points.embed(b, of.position_m);
    if (!point) throw SceneError(where + "there is no tissue of body '" + model.bodies[b].name + "' at 'position_m'");
    const TrackLaw law = trackLawOf(config, model.bodies[b]);
    ChainSlide slide;
    slide.s = before = positionOn(chain, of.position_m, before, where);
    slide.friction = law.friction;
    slide.most_n = law.pull_out_n;
    Track track;
    track.point = *point;
    track.cut_m = of.position_m;
    if (k > 0 && tracks_.back().point.body == b) {
      Track& last = tracks_.back();
      const double apart_m = (of.position_m - last.point.rest_m).norm();
      last.through = points.embed(b, 0.5 * (last.point.rest_m + of.position_m)).has_value();
      const double half_n = last.through ? 0.5 * law.through_n_per_m * apart_m : 0;
      slides.back().through_n += half_n;
      slide.through_n = half_n;
    }
    tracks_.push_back(track);
    slides.push_back(slide);
  }
  changed_ = true;
}

void SutureTracks::take(const TissuePoint& point, bool goes_on, const TrackLaw& law, double s,
                        const TissuePoints& points, std::vector<ChainSlide>& slides) {
  Track track;
  track.point = point;
  track.cut_m = point.rest_m;
  ChainSlide slide;
  slide.s = s;
  slide.friction = law.friction;
  slide.most_n = law.pull_out_n;
  if (!tracks_.empty()) {
    const TissuePoint& next = tracks_.front().point;
    slide.s = std::min(s, kBeforeNext * slides.front().s);
    track.through =
        goes_on && next.body == point.body && points.embed(point.body, 0.5 * (next.rest_m + point.rest_m)).has_value();
    slide.through_n = track.through ? 0.5 * law.through_n_per_m * (next.rest_m - point.rest_m).norm() : 0;
    slides.front().through_n += slide.through_n;
  }
  tracks_.insert(tracks_.begin(), track);
  slides.insert(slides.begin(), slide);
  changed_ = true;
}

bool SutureTracks::hides(double s, const std::vector<ChainSlide>& slides) const {
  for (size_t k = 0; k + 1 < tracks_.size(); ++k) {
    if (tracks_[k].through && slides[k].s < s && s < slides[k + 1].s) return true;
  }
  return false;
}

void SutureTracks::addPoints(std::vector<const TissuePoint*>& points) const {
  for (const Track& track : tracks_) points.push_back(&track.point);
}

/// Updates the channels' masses. Together they never exceed the mass of the tissue, however the channels pull together.
void SutureTracks::renew(const TissuePoints& points, std::vector<ChainSlide>& slides) {
  for (size_t k = 0; k < tracks_.size(); ++k) {
    double sum = 0;
    for (const Track& other : tracks_) sum += std::abs(points.mobility(tracks_[k].point, other.point));
    tracks_[k].mass_kg = sum > 0 ? std::min(kRigidMass_kg, 1 / sum) : kRigidMass_kg;
    const bool last = k + 1 == tracks_.size();
    slides[k].between_rest_m = last ? 0 : (tracks_[k + 1].point.rest_m - tracks_[k].point.rest_m).norm();
  }
  changed_ = false;
}

void SutureTracks::begin(const TissuePoints& points, std::vector<ChainSlide>& slides) {
  if (changed_) renew(points, slides);
  for (size_t k = 0; k < tracks_.size(); ++k) {
    tracks_[k].given_ns.setZero();
    slides[k].mass_kg = tracks_[k].mass_kg;
    slides[k].to_m = points.position_m(tracks_[k].point);
  }
}

void SutureTracks::answer(TissuePoints& points, double dt_s, std::vector<ChainSlide>& slides) {
  for (size_t k = 0; k < tracks_.size(); ++k) {
    Track& track = tracks_[k];
    points.give(track.point, slides[k].impulse_ns - track.given_ns, dt_s);
    track.given_ns = slides[k].impulse_ns;
  }
  for (size_t k = 0; k < tracks_.size(); ++k) slides[k].to_m = points.position_m(tracks_[k].point);
}

void SutureTracks::record(const std::vector<ChainSlide>& slides) {
  for (size_t k = 0; k < tracks_.size(); ++k) tracks_[k].torn_m += slides[k].torn_m;
}

bool SutureTracks::end(const TissuePoints& points, TissuePort& target, bool can_cut, double link_m,
                       std::vector<ChainSlide>& slides) {
  bool any_cut = false;
  for (size_t k = tracks_.size(); k-- > 0;) {
    Track& track = tracks_[k];
    bool gone = slides[k].out;
    const bool torn = !gone && !track.torn_m.isZero(0);
    if (torn) {
      gone = !tear(track, points, target);
      const double h = points.spacing_m(track.point.body);
      const Vector3d uncut = track.point.rest_m - track.cut_m;
      // The tissue against which it pulls stays whole until it has moved on.
      const double due_m = uncut.norm() - (gone ? 0 : kHeld * h);
      if (can_cut && due_m > (gone ? 0 : kTrackCutStep * h)) {
        cutBehind(k, track.cut_m + due_m * uncut.normalized(), target);
        any_cut = true;
      }
    }
    if (gone)
      erase(k, slides);
    else if (torn)
      joinTorn(k, link_m, slides);
  }
  return any_cut;
}

bool SutureTracks::tear(Track& track, const TissuePoints& points, const TissuePort& target) {
  const double h = points.spacing_m(track.point.body);
  const Vector3d to_m = points.position_m(track.point) + track.torn_m;
  Vector3d offset_m = points.toRest(track.point, track.torn_m);
  if (offset_m.norm() > kMostTorn * h) offset_m *= kMostTorn * h / offset_m.norm();
  track.torn_m.setZero();
  track.point.rest_m += offset_m;
  changed_ = true;
  const std::optional<TissuePoint> next = points.embed(track.point.body, track.point.rest_m);
  if (!next || (points.positionIn(target, *next) - to_m).norm() > kMostTorn * h) return false;  // it came into a wound
  track.point = *next;
  return true;
}

/// Cuts what the suture has swept at rest: from the channel halfway to its neighbours, as far as it runs through
/// tissue.
void SutureTracks::cutBehind(size_t k, const Vector3d& to_m, TissuePort& target) {
  Track& track = tracks_[k];
  target.selectBody(track.point.body);
  const auto sweep = [&](const Vector3d& beside_m) {
    layout::ToolMotion motion{};
    motion.from = asVec4(track.cut_m);
    motion.to = asVec4(to_m);
    motion.blade_from = asVec4(0.5 * (track.cut_m + beside_m));
    motion.blade_to = asVec4(0.5 * (to_m + beside_m));
    target.cutAtRest(motion, false);
  };
  if (k > 0 && tracks_[k - 1].through) sweep(tracks_[k - 1].point.rest_m);
  if (track.through && k + 1 < tracks_.size()) sweep(tracks_[k + 1].point.rest_m);
  track.cut_m = to_m;
}

void SutureTracks::erase(size_t k, std::vector<ChainSlide>& slides) {
  if (k > 0) tracks_[k - 1].through = 0;
  tracks_.erase(tracks_.begin() + static_cast<std::ptrdiff_t>(k));
  slides.erase(slides.begin() + static_cast<std::ptrdiff_t>(k));
  changed_ = true;
}

/// Joins a channel torn up to its neighbour with that.
void SutureTracks::joinTorn(size_t k, double link_m, std::vector<ChainSlide>& slides) {
  const auto isNear = [&](size_t other) {
    const TissuePoint &a = tracks_[k].point, &b = tracks_[other].point;
    return a.body == b.body && (a.rest_m - b.rest_m).norm() < kOneTrack * link_m;
  };
  const bool next = k + 1 < tracks_.size() && isNear(k + 1);
  if (!next && (k == 0 || !isNear(k - 1))) return;
  const uint32_t before = k > 0 ? tracks_[k - 1].through : 0, behind = tracks_[k].through;
  slides[next ? k + 1 : k - 1].through_n += slides[k].through_n;
  erase(k, slides);
  if (k > 0) tracks_[k - 1].through = next ? before : behind;
}

void SutureTracks::embedAgain(const TissuePoints& points, std::vector<ChainSlide>& slides) {
  for (size_t k = tracks_.size(); k-- > 0;) {
    const std::optional<TissuePoint> again = points.embed(tracks_[k].point.body, tracks_[k].point.rest_m);
    if (again)
      tracks_[k].point = *again;
    else
      erase(k, slides);
  }
  changed_ = true;
}

std::vector<const TissuePoint*> SutureTracks::outer() const {
  if (tracks_.empty()) return {};
  return {&tracks_.front().point, &tracks_.back().point};
}

SutureTracks SutureTracks::part(size_t before) {
  SutureTracks behind;
  const auto first = tracks_.begin() + static_cast<std::ptrdiff_t>(before);
  behind.tracks_.assign(first, tracks_.end());
  tracks_.erase(first, tracks_.end());
  if (!tracks_.empty()) tracks_.back().through = 0;
  changed_ = true;
  return behind;
}

void SutureTracks::persist(Archive& archive) {
  archive.list(tracks_);
  archive.value(changed_);
}

}  // namespace viscera
