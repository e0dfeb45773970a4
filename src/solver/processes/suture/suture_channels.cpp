// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/suture_channels.h"

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
constexpr double kChannelCutStep = 0.125;        // of the spacing: length of tearing after which springs are cut
constexpr double kMostTorn = 0.5;                // of the spacing: largest tear in a substep
constexpr double kHeld = 1;          // of the spacing: length behind a channel in which tissue is not cut yet
constexpr double kOneChannel = 1.5;  // links, at rest: channels keep at least one link of the chain between them

constexpr double kBeforeNext = 0.5;    // of its position on the chain: a new channel is not behind that
constexpr double kPassesAgain = 0.25;  // in links: margin over the nearest distance from a point

struct OnChain {
  double s = 0, off_m = 0;
};

/// Returns the nearest point of a chain to a point, from some link on.
OnChain nearestOn(const Chain& chain, const Vector3d& at_m, double first) {
  OnChain out{0, std::numeric_limits<double>::infinity()};
  const std::vector<Vector3d>& x = chain.places_m();
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
double placeOn(const Chain& chain, const Vector3d& at_m, double before, const std::string& where) {
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

ChannelLaw channelLawOf(const SutureConfig& config, const Body& body) {
  const double young_pa = body.material.young_modulus_pa;
  ChannelLaw out{config.friction, config.through_n_per_m, config.pull_out_n};
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

void SutureChannels::lay(const SutureConfig& config, const Chain& chain, const Model& model, const TissuePoints& points,
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
    const ChannelLaw law = channelLawOf(config, model.bodies[b]);
    ChainSlide slide;
    slide.s = before = placeOn(chain, of.position_m, before, where);
    slide.friction = law.friction;
    slide.most_n = law.pull_out_n;
    Channel channel;
    channel.point = *point;
    channel.cut_m = of.position_m;
    if (k > 0 && channels_.back().point.body == b) {
      Channel& last = channels_.back();
      const double apart_m = (of.position_m - last.point.rest_m).norm();
      last.through = points.embed(b, 0.5 * (last.point.rest_m + of.position_m)).has_value();
      const double half_n = last.through ? 0.5 * law.through_n_per_m * apart_m : 0;
      slides.back().through_n += half_n;
      slide.through_n = half_n;
    }
    channels_.push_back(channel);
    slides.push_back(slide);
  }
  changed_ = true;
}

void SutureChannels::take(const TissuePoint& point, bool goes_on, const ChannelLaw& law, double s,
                          const TissuePoints& points, std::vector<ChainSlide>& slides) {
  Channel channel;
  channel.point = point;
  channel.cut_m = point.rest_m;
  ChainSlide slide;
  slide.s = s;
  slide.friction = law.friction;
  slide.most_n = law.pull_out_n;
  if (!channels_.empty()) {
    const TissuePoint& next = channels_.front().point;
    slide.s = std::min(s, kBeforeNext * slides.front().s);
    channel.through =
        goes_on && next.body == point.body && points.embed(point.body, 0.5 * (next.rest_m + point.rest_m)).has_value();
    slide.through_n = channel.through ? 0.5 * law.through_n_per_m * (next.rest_m - point.rest_m).norm() : 0;
    slides.front().through_n += slide.through_n;
  }
  channels_.insert(channels_.begin(), channel);
  slides.insert(slides.begin(), slide);
  changed_ = true;
}

bool SutureChannels::hides(double s, const std::vector<ChainSlide>& slides) const {
  for (size_t k = 0; k + 1 < channels_.size(); ++k) {
    if (channels_[k].through && slides[k].s < s && s < slides[k + 1].s) return true;
  }
  return false;
}

void SutureChannels::addPoints(std::vector<const TissuePoint*>& points) const {
  for (const Channel& channel : channels_) points.push_back(&channel.point);
}

/// Updates the channels' masses. Together they never exceed the mass of the tissue, however the channels pull together.
void SutureChannels::renew(const TissuePoints& points, std::vector<ChainSlide>& slides) {
  for (size_t k = 0; k < channels_.size(); ++k) {
    double sum = 0;
    for (const Channel& other : channels_) sum += std::abs(points.mobility(channels_[k].point, other.point));
    channels_[k].mass_kg = sum > 0 ? std::min(kRigidMass_kg, 1 / sum) : kRigidMass_kg;
    const bool last = k + 1 == channels_.size();
    slides[k].between_rest_m = last ? 0 : (channels_[k + 1].point.rest_m - channels_[k].point.rest_m).norm();
  }
  changed_ = false;
}

void SutureChannels::begin(const TissuePoints& points, std::vector<ChainSlide>& slides) {
  if (changed_) renew(points, slides);
  for (size_t k = 0; k < channels_.size(); ++k) {
    channels_[k].given_ns.setZero();
    slides[k].mass_kg = channels_[k].mass_kg;
    slides[k].to_m = points.place_m(channels_[k].point);
  }
}

void SutureChannels::answer(TissuePoints& points, double dt_s, std::vector<ChainSlide>& slides) {
  for (size_t k = 0; k < channels_.size(); ++k) {
    Channel& channel = channels_[k];
    points.give(channel.point, slides[k].impulse_ns - channel.given_ns, dt_s);
    channel.given_ns = slides[k].impulse_ns;
  }
  for (size_t k = 0; k < channels_.size(); ++k) slides[k].to_m = points.place_m(channels_[k].point);
}

void SutureChannels::note(const std::vector<ChainSlide>& slides) {
  for (size_t k = 0; k < channels_.size(); ++k) channels_[k].torn_m += slides[k].torn_m;
}

bool SutureChannels::end(const TissuePoints& points, TissuePort& target, bool can_cut, double link_m,
                         std::vector<ChainSlide>& slides) {
  bool any_cut = false;
  for (size_t k = channels_.size(); k-- > 0;) {
    Channel& channel = channels_[k];
    bool gone = slides[k].out;
    const bool torn = !gone && !channel.torn_m.isZero(0);
    if (torn) {
      gone = !tear(channel, points, target);
      const double h = points.spacing_m(channel.point.body);
      const Vector3d uncut = channel.point.rest_m - channel.cut_m;
      // The tissue against which it pulls stays whole until it has moved on.
      const double due_m = uncut.norm() - (gone ? 0 : kHeld * h);
      if (can_cut && due_m > (gone ? 0 : kChannelCutStep * h)) {
        cutBehind(k, channel.cut_m + due_m * uncut.normalized(), target);
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

bool SutureChannels::tear(Channel& channel, const TissuePoints& points, const TissuePort& target) {
  const double h = points.spacing_m(channel.point.body);
  const Vector3d to_m = points.place_m(channel.point) + channel.torn_m;
  Vector3d way_m = points.toRest(channel.point, channel.torn_m);
  if (way_m.norm() > kMostTorn * h) way_m *= kMostTorn * h / way_m.norm();
  channel.torn_m.setZero();
  channel.point.rest_m += way_m;
  changed_ = true;
  const std::optional<TissuePoint> next = points.embed(channel.point.body, channel.point.rest_m);
  if (!next || (points.placeIn(target, *next) - to_m).norm() > kMostTorn * h) return false;  // it came into a wound
  channel.point = *next;
  return true;
}

/// Cuts what the suture has swept at rest: from the channel halfway to its neighbours, as far as it runs through
/// tissue.
void SutureChannels::cutBehind(size_t k, const Vector3d& to_m, TissuePort& target) {
  Channel& channel = channels_[k];
  target.selectBody(channel.point.body);
  const auto sweep = [&](const Vector3d& beside_m) {
    layout::ToolMotion motion{};
    motion.from = asVec4(channel.cut_m);
    motion.to = asVec4(to_m);
    motion.blade_from = asVec4(0.5 * (channel.cut_m + beside_m));
    motion.blade_to = asVec4(0.5 * (to_m + beside_m));
    target.cutAtRest(motion, false);
  };
  if (k > 0 && channels_[k - 1].through) sweep(channels_[k - 1].point.rest_m);
  if (channel.through && k + 1 < channels_.size()) sweep(channels_[k + 1].point.rest_m);
  channel.cut_m = to_m;
}

void SutureChannels::erase(size_t k, std::vector<ChainSlide>& slides) {
  if (k > 0) channels_[k - 1].through = 0;
  channels_.erase(channels_.begin() + static_cast<std::ptrdiff_t>(k));
  slides.erase(slides.begin() + static_cast<std::ptrdiff_t>(k));
  changed_ = true;
}

/// Joins a channel torn up to its neighbour with that.
void SutureChannels::joinTorn(size_t k, double link_m, std::vector<ChainSlide>& slides) {
  const auto isNear = [&](size_t other) {
    const TissuePoint &a = channels_[k].point, &b = channels_[other].point;
    return a.body == b.body && (a.rest_m - b.rest_m).norm() < kOneChannel * link_m;
  };
  const bool next = k + 1 < channels_.size() && isNear(k + 1);
  if (!next && (k == 0 || !isNear(k - 1))) return;
  const uint32_t before = k > 0 ? channels_[k - 1].through : 0, behind = channels_[k].through;
  slides[next ? k + 1 : k - 1].through_n += slides[k].through_n;
  erase(k, slides);
  if (k > 0) channels_[k - 1].through = next ? before : behind;
}

void SutureChannels::embedAgain(const TissuePoints& points, std::vector<ChainSlide>& slides) {
  for (size_t k = channels_.size(); k-- > 0;) {
    const std::optional<TissuePoint> again = points.embed(channels_[k].point.body, channels_[k].point.rest_m);
    if (again)
      channels_[k].point = *again;
    else
      erase(k, slides);
  }
  changed_ = true;
}

std::vector<const TissuePoint*> SutureChannels::outer() const {
  if (channels_.empty()) return {};
  return {&channels_.front().point, &channels_.back().point};
}

SutureChannels SutureChannels::part(size_t before) {
  SutureChannels behind;
  const auto first = channels_.begin() + static_cast<std::ptrdiff_t>(before);
  behind.channels_.assign(first, channels_.end());
  channels_.erase(first, channels_.end());
  if (!channels_.empty()) channels_.back().through = 0;
  changed_ = true;
  return behind;
}

void SutureChannels::persist(Archive& archive) {
  archive.list(channels_);
  archive.value(changed_);
}

}  // namespace viscera
