// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/suture_bodies.h"

#include <algorithm>
#include <cmath>

#include "math/number_text.h"
#include "model/fracture/tearing.h"
#include "viscera/math/error.h"
#include "viscera/math/state_hash.h"
#include "viscera/model/scene/scene.h"
#include "viscera/tools/obstacles.h"

namespace viscera {

namespace {

constexpr double kSutureSubstep_s = 5e-4;
constexpr double kOffLink = 1e-3;

}  // namespace

SutureBodies::SutureBodies(const Scene& scene, const Model* model)
    : model_(model),
      obstacles_(scene.obstacles),
      tick_s_(1 / scene.solver.tick_hz),
      can_cut_(suturesTear(scene)),
      grips_(scene.styluses),
      blades_(scene.styluses) {
  const bool tied = std::any_of(scene.sutures.begin(), scene.sutures.end(),
                                [](const SutureConfig& config) { return config.feelsTissue(); });
  if (model && tied) tissue_ = std::make_unique<TissuePoints>(*model);
  if (model && tied) needles_.emplace(scene, *model);
  for (const SutureConfig& config : scene.sutures) {
    const auto suture = static_cast<uint32_t>(first_.size());
    SuturePiece& piece = first_.emplace_back(suture, config, needle(suture) != nullptr);
    piece.around.gravity_m_per_s2 = scene.environment.gravity_m_per_s2;
    if (tissue_) piece.tracks.lay(config, piece.chain, *model, *tissue_, piece.around.slides);
    ties_.push_back(config.ties);
    names_.push_back(config.name);
  }
  reset();
}

void SutureBodies::reset() {
  pieces_ = first_;
  for (SuturePiece& piece : pieces_) piece.chain.reset();
  grips_.reset();
  if (needles_) needles_->reset();
  tick_ = 0;
  refused_.clear();
}

void SutureBodies::plan(Steps& steps, int count, const ObstacleMotions& obstacles) const {
  steps.count = count;
  if (!obstacles_.empty()) interpolateObstacles(obstacles_, obstacles, count, tick_s_, steps.obstacle_motions);
}

void SutureBodies::cutsChanged(const CutSprings& cuts) {
  tissue_->setCuts(cuts);
  if (needles_) lips_.find(*model_, cuts);
  for (SuturePiece& piece : pieces_) {
    piece.tracks.embedAgain(*tissue_, piece.around.slides);
    piece.skin.clear();
  }
  if (needles_) needles_->embedAgain(*tissue_);
}

void SutureBodies::beginTick(const ProcessTick& tick) {
  std::vector<const Chain*> chains;
  for (const SuturePiece& piece : pieces_) chains.push_back(&piece.chain);
  tieWhatIsDue();
  grips_.beginTick(tick.motions, chains);
  if (blades_.beginTick(tick.motions)) {
    for (const SuturePiece& piece : pieces_) blades_.keep(piece.chain.positions_m());
  }
  bool any = false;
  for (size_t t = 0; t < pieces_.size(); ++t)
    any |= pieces_[t].tied = tissue_ && (!pieces_[t].tracks.empty() || needle(t));
  for (SuturePiece& piece : pieces_) {
    if (piece.tied) piece.skin.lay(*model_, *tissue_, piece.tracks.outer());
  }
  if (any) {
    per_substep_ = static_cast<int>(std::ceil(tick_s_ / tick.substeps / kSutureSubstep_s));
    plan(tied_, tick.substeps * per_substep_, tick.obstacles);
  }
  plan(alone_, static_cast<int>(std::ceil(tick_s_ / kSutureSubstep_s)), tick.obstacles);
  work_j_ = 0;
  if (needles_) needles_->beginTick(tick.motions);
}

bool SutureBodies::anyTied() const {
  return std::any_of(pieces_.begin(), pieces_.end(), [](const SuturePiece& piece) { return piece.tied; });
}

std::vector<const TissuePoint*> SutureBodies::tiedPoints() const {
  std::vector<const TissuePoint*> out;
  for (const SuturePiece& piece : pieces_) {
    if (!piece.tied) continue;
    piece.tracks.addPoints(out);
    piece.skin.addPoints(out);
  }
  lips_.addPoints(out);  // they are read even if sutures have no channels yet, as before a needle passes
  return out;
}

/// Moves the needles. Points that their tails leave become channels of their sutures.
void SutureBodies::moveNeedles(TissuePort& port, int index) {
  if (!needles_ || needles_->empty()) return;
  const int last = (index + 1) * per_substep_;
  const double share = 1.0 / tied_.count, before_j = needles_->work_j();
  needles_->act(port, *tissue_, last * share, per_substep_ * share * tick_s_, obstaclesOf(tied_, last - 1),
                static_cast<uint32_t>(obstacles_.size()),
                [this](uint32_t t, const NeedlePassed& passed, const TrackLaw& law) {
                  SuturePiece& piece = pieces_[t];
                  piece.tracks.take(passed.point, !passed.enters, law, passed.beyond_m / piece.chain.link_m(), *tissue_,
                                    piece.around.slides);
                });
  work_j_ += needles_->work_j() - before_j;
}

/// Acts after a substep of the tissue. If it is longer than sutures permit, they subdivide it, with the tissue's
/// velocities at its end.
bool SutureBodies::act(TissuePort& port, const ProcessTick&, const ProcessSubstep& made) {
  moveNeedles(port, made.index);
  if (!anyTied()) return false;
  const std::vector<const TissuePoint*> points = tiedPoints();
  const double dt_s = tick_s_ / tied_.count;
  tissue_->read(port, points);
  tissue_->drift((1 - per_substep_) * dt_s);
  for (int s = 0; s < per_substep_; ++s) {
    if (s > 0) tissue_->drift(dt_s);
    for (uint32_t t = 0; t < pieces_.size(); ++t) {
      if (pieces_[t].tied) substep(t, tied_, made.index * per_substep_ + s);
    }
  }
  lips_.part(*tissue_, per_substep_ * dt_s);
  tissue_->write(port, layout::kMaxStyluses, per_substep_ * dt_s);
  work_j_ += tissue_->work_j();
  bool cut = false;
  for (SuturePiece& piece : pieces_) {
    if (piece.tied) cut |= piece.tracks.end(*tissue_, port, can_cut_, piece.chain.link_m(), piece.around.slides);
  }
  return cut;
}

bool SutureBodies::endTick(TissuePort&, const ProcessTick&, const TissueProcesses&) {
  stepLoose();
  return false;
}

/// Steps sutures outside tissue through the tick, and applies grips and blades to all.
void SutureBodies::stepLoose() {
  for (int s = 0; s < alone_.count; ++s) {
    for (uint32_t t = 0; t < pieces_.size(); ++t) {
      if (!pieces_[t].tied) substep(t, alone_, s);
    }
  }
  for (uint32_t t = 0; t < pieces_.size(); ++t) {
    std::vector<uint32_t> held = grips_.nodesOf(t);
    if (held.empty()) continue;
    SuturePiece& piece = pieces_[t];
    for (size_t h = 0; h < piece.fixed_holds; ++h) held.push_back(piece.around.holds[h].node);
    piece.knots.countThrows(piece.chain, held, piece.around);
  }
  partWhatBladesMet();
  ++tick_;
}

void SutureBodies::tie(size_t at, const SutureTie& tie) {
  if (at >= pieces_.size()) throw Error("there is no piece " + std::to_string(at) + " of a suture");
  SuturePiece& piece = pieces_[at];
  piece.knots.clean(piece.around);
  piece.knots.tie(
      tie, piece.chain, [&](double s) { return piece.tracks.hides(s, piece.around.slides); }, piece.around);
}

void SutureBodies::tieWhatIsDue() {
  for (size_t t = 0; t < ties_.size(); ++t) {
    for (const SutureTie& due : ties_[t]) {
      if (static_cast<uint64_t>(std::llround(due.at_s / tick_s_)) != tick_) continue;
      try {
        tie(t, due);
      } catch (const Error& error) {
        refused_ = "sutures[" + std::to_string(t) + "], tie at " + numberText(due.at_s) + " s: " + error.what();
      }
    }
  }
}

void SutureBodies::partWhatBladesMet() {
  const size_t count = pieces_.size();
  for (uint32_t t = 0; t < count; ++t) {
    const std::vector<size_t> met = blades_.met(t, pieces_[t].chain.positions_m());
    for (auto link = met.rbegin(); link != met.rend(); ++link) {  // from its end, so nodes before it keep their indices
      if (*link + 1 < pieces_[t].chain.nodes()) part(t, *link + 1);
    }
  }
}

bool SutureBodies::part(uint32_t at, size_t near) {
  const size_t node = pieces_[at].canPart(near);
  if (node == 0 || pieces_.size() >= first_.size() + kMostParted) return false;
  grips_.parted(at, static_cast<uint32_t>(node), static_cast<uint32_t>(pieces_.size()));
  SuturePiece behind = pieces_[at].part(node);
  pieces_.push_back(std::move(behind));
  return true;
}

void SutureBodies::addPulls(StylusPulls& pulls) const {
  for (size_t s = 0; s < pulls.size(); ++s) {
    StylusPull& out = pulls[s];
    const StylusPull& pull = grips_.pulls()[s];
    out.impulse_ns += pull.impulse_ns;
    out.moment_nms += pull.moment_nms;
    out.nodes += pull.nodes;
    if (!needles_) continue;
    const StylusPull& needle = needles_->pulls()[s];
    out.impulse_ns += needle.impulse_ns;
    out.moment_nms += needle.moment_nms;
    // Also before the tip is inside: haptics between ticks use only held needles.
    out.needle = needle.needle;
    out.nodes += std::max(needle.nodes, needle.impulse_ns.isZero(0) ? 0U : 1U);
  }
}

const layout::ObstacleMotion* SutureBodies::obstaclesOf(const Steps& steps, int index) const {
  return obstacles_.empty() ? nullptr : &steps.obstacle_motions[static_cast<size_t>(index) * layout::kMaxObstacles];
}

void SutureBodies::step(const ToolMotions& motions, const ObstacleMotions& obstacles) {
  beginTick({motions, obstacles});
  stepLoose();
}

void SutureBodies::substep(uint32_t t, const Steps& steps, int index) {
  SuturePiece& suture = pieces_[t];
  const double dt_s = tick_s_ / steps.count;
  const auto count = static_cast<uint32_t>(obstacles_.size());
  const layout::ObstacleMotion* const obstacles = obstaclesOf(steps, index);
  const bool on_needle = suture.tied && needle(t);
  std::vector<ChainHold>& holds = suture.around.holds;
  holds.resize(suture.fixed_holds);
  if (on_needle) needles_->lay(t, (index % per_substep_ + 1.0) / per_substep_, holds[0]);
  grips_.addHolds(t, static_cast<double>(index + 1) / steps.count, holds);
  NearTracks beside;
  if (suture.tied && !suture.around.slides.empty()) {
    suture.skin.begin(*tissue_);
    beside = {&suture.skin, suture.around.slides.front().s, suture.around.slides.back().s};
  }
  suture.touches.find(suture.chain, obstacles, count, beside, dt_s, suture.around.touches);
  suture.around.entered = [&](const std::vector<Vector3d>& ends_m, std::vector<ChainTouch>& touches) {
    return suture.touches.catchUp(suture.chain, obstacles, count, dt_s, ends_m, touches);
  };
  if (suture.tied) {
    suture.tracks.begin(*tissue_, suture.around.slides);
    suture.around.answer = [&](std::vector<ChainSlide>& slides) { suture.tracks.answer(*tissue_, dt_s, slides); };
  }
  suture.knots.beginSubstep(dt_s, suture.chain, suture.around);
  suture.chain.step(dt_s, suture.around);
  recordLinks(suture.chain);
  suture.around.entered = {};
  suture.around.answer = {};
  if (suture.tied) {
    suture.tracks.record(suture.around.slides);
    suture.skin.give(suture.around.touches, dt_s, *tissue_);
  }
  grips_.takeOver(t, holds, suture.fixed_holds);
  if (on_needle) needles_->takeOver(t, holds[0]);
}

void SutureBodies::recordLinks(const Chain& chain) {
  ++links_.substeps;
  links_.off += chain.worstLink() > kOffLink;
  links_.worst = std::max(links_.worst, chain.worstLink());
  links_.iterations += chain.iterations();
  links_.waits += chain.waited();
}

void SutureBodies::persist(Archive& archive) {
  archive.section("sutures");
  persistUndone(archive);
  grips_.persist(archive);
  archive.value(tick_);
  if (needles_) needles_->persistTools(archive);
}

void SutureBodies::persistUndone(Archive& archive) {
  uint64_t count = pieces_.size();
  archive.value(count);
  if (archive.reads()) {
    if (count < first_.size() || count > first_.size() + kMostParted)
      throw Error("the saved state has " + std::to_string(count) + " pieces of sutures, but the scene has " +
                  std::to_string(first_.size()) + " sutures");
    pieces_.erase(pieces_.begin() + static_cast<std::ptrdiff_t>(std::min<size_t>(count, pieces_.size())),
                  pieces_.end());
  }
  for (size_t i = 0; i < count; ++i) {
    uint32_t suture = i < pieces_.size() ? pieces_[i].suture : 0;
    archive.value(suture);
    if (suture >= first_.size()) throw Error("the saved state has a piece of a suture that the scene does not have");
    if (i == pieces_.size()) pieces_.push_back(first_[suture]);
    pieces_[i].suture = suture;
    pieces_[i].persist(archive);
  }
  if (needles_) needles_->persist(archive);
}

void SutureBodies::undone(bool at_rest) {
  std::vector<size_t> nodes;
  for (const SuturePiece& piece : pieces_) nodes.push_back(piece.chain.nodes());
  grips_.letGoMissing(nodes);
  if (!at_rest) return;
  for (SuturePiece& piece : pieces_) piece.chain.stop();
}

bool SutureBodies::addTo(StateHash& hash) const {
  for (const SuturePiece& piece : pieces_) {
    for (size_t i = 0; i < piece.chain.nodes(); ++i) {
      for (const Vector3d& vector : {piece.chain.positions_m()[i], piece.chain.velocities_m_per_s()[i]}) {
        for (const double part : vector) hash.add(static_cast<float>(part));
      }
    }
    for (const ChainSlide& slide : piece.around.slides) hash.add(static_cast<float>(slide.s));
    for (const ChainKnot& knot : piece.around.knots) hash.add(static_cast<float>(knot.s2));
  }
  if (needles_) needles_->addTo(hash);
  return true;
}

}  // namespace viscera
