// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "session/session_replay.h"

#include <algorithm>
#include <deque>
#include <utility>

#include "math/archive.h"
#include "session/session_event.h"
#include "viscera/math/error.h"
#include "viscera/session/session_log.h"

namespace viscera {

namespace {

/// Comparison of recorded measurements with present ones; keeps the first that differ.
class MeasuredBesides : public SessionLog {
 public:
  struct Measured {
    uint64_t tick;
    uint32_t fingerprint;
  };
  void measured(const Session&, uint64_t tick, const layout::TickStats& stats) override {
    here_.push_back({tick, fingerprintOf(stats)});
    compare();
  }
  void add(const Measured& recorded) {
    recorded_.push_back(recorded);
    compare();
  }
  /// Restarts the comparison: from here on both begin with the same tick.
  void begin() {
    here_.clear();
    recorded_.clear();
  }
  const std::optional<uint64_t>& differs() const { return differs_; }

 private:
  void compare() {
    while (!here_.empty() && !recorded_.empty()) {
      const bool same = here_.front().fingerprint == recorded_.front().fingerprint;
      if (!same && !differs_) differs_ = here_.front().tick;
      here_.pop_front();
      recorded_.pop_front();
    }
  }
  std::deque<Measured> here_, recorded_;
  std::optional<uint64_t> differs_;
};

/// Calls act for the events of a chunk, one after another.
template <class Act>
void forEachEvent(std::vector<char> bytes, size_t styluses, const Act& act) {
  Archive archive({{"events", std::move(bytes)}});
  archive.section("events");
  while (archive.more()) {
    SessionEvent event;
    event.persist(archive, styluses);
    act(event);
  }
}

}  // namespace

SessionReplay::SessionReplay(const std::string& path) : file_(path) {
  try {
    index();
  } catch (const Error& error) {
    throw Error(path + ": " + error.what());
  }
  if (parts_.empty() || states_.empty()) throw Error(path + ": the recording ends before its first state");
}

void SessionReplay::index() {
  bool ended = false;
  while (const std::optional<ChunkKind> kind = file_.next()) {
    if (*kind != ChunkKind::kScene && parts_.empty()) throw Error("the recording does not begin with a scene");
    ended = *kind == ChunkKind::kEnd;
    if (*kind == ChunkKind::kScene)
      parts_.push_back({file_.position(), RecordedScene::from(file_.bytes(kMostSceneBytes)), duration_s_, duration_s_});
    if (*kind == ChunkKind::kState) states_.push_back({file_.position(), parts_.size() - 1, duration_s_});
    if (*kind != ChunkKind::kEvents) continue;
    const RecordedScene& scene = parts_.back().scene;
    forEachEvent(file_.bytes(), scene.styluses, [&](const SessionEvent& event) {
      if (event.kind == SessionEvent::Kind::kStep) duration_s_ += 1 / scene.tick_hz;
    });
    parts_.back().to_s = duration_s_;
  }
  damage_ = file_.damage();
  if (damage_.empty() && !ended)
    damage_ = file_.path() + ": its recorder was stopped before it could finish the recording";
}

/// One run through the recording.
class SessionReplay::Run {
 public:
  Run(SessionReplay& replay, double from_s, double until_s, const Overrides& overrides, const Ports& ports)
      : replay_(replay), from_s_(from_s), until_s_(until_s), overrides_(overrides), ports_(ports) {
    begin_ = replay.states_.front();
    for (const Position& state : replay.states_)
      if (state.at_s <= from_s + tolerance(state.part)) begin_ = state;
  }
  ~Run() {
    if (session_) session_->removeLog(besides_);
  }

  Outcome run() {
    RecordFileReader& file = replay_.file_;
    part_ = begin_.part;
    out_.at_s = begin_.at_s;
    file.go(replay_.parts_[part_].position);
    --part_;  // its chunk comes first
    while (!done_) {
      const std::optional<ChunkKind> kind = file.next();
      if (!kind) break;
      if (*kind == ChunkKind::kScene) beginPart();
      if (*kind == ChunkKind::kState && skipped()) meetState(RecordedState::from(file.bytes(mostStateBytes())), false);
      if (*kind == ChunkKind::kEvents) {
        forEachEvent(file.bytes(), replay_.parts_[part_].scene.styluses,
                     [this](const SessionEvent& event) { apply(event); });
      }
      if (*kind == ChunkKind::kEnd && skipped()) meetState(RecordedState::from(file.bytes()), true);
    }
    return out_;
  }

 private:
  double tolerance(size_t part) const { return 0.25 / replay_.parts_[part].scene.tick_hz; }
  /// Returns whether the state that the run begins with was reached.
  bool skipped() const { return replay_.file_.position() >= begin_.position; }

  void beginPart() {
    ++part_;
    if (session_) std::exchange(session_, nullptr)->removeLog(besides_);
    const std::string name = replay_.file_.path() + " (scene " + std::to_string(part_ + 1) + ")";
    session_ = &ports_.make(replay_.parts_[part_].scene.scene(name, overrides_), part_);
    session_->addLog(besides_);
    out_.ended = false;
    fresh_ = true;
  }

  void meetState(RecordedState state, bool ends) {
    if (!ends && (fresh_ || state.leaps)) {
      if (!fresh_) ports_.leaps(*session_);
      Archive archive(std::move(state.sections));
      session_->restore(archive, replay_.file_.path());
      besides_.begin();
      fresh_ = false;
    }
    compare(state);
    out_.ended = ends;
  }

  /// Returns the largest size of a state of this scene: cuts, burns and clips make it larger than it is now.
  uint64_t mostStateBytes() const {
    constexpr uint64_t kGrows = 16, kBesides = uint64_t{64} << 20;
    Archive now;
    session_->save(now);
    uint64_t bytes = 0;
    for (const Archive::Section& section : now.sections()) bytes += section.bytes.size();
    return kBesides + kGrows * bytes;
  }

  void compare(const RecordedState& state) {
    Archive waits;
    session_->save(waits);  // waits for all measurements
    ++out_.compared;
    const uint64_t hash = session_->stateHash();
    if (hash == state.hash || out_.difference) {
      last_same_tick_ = state.tick;
      return;
    }
    out_.difference = Difference{part_, state.tick, last_same_tick_, besides_.differs(), state.hash, hash};
  }

  void apply(const SessionEvent& event) {
    if (done_) return;
    using Kind = SessionEvent::Kind;
    event.require(session_->scene());
    if (!skipped()) {  // everything except appearance is in the state
      if (event.kind == Kind::kOverlays || event.kind == Kind::kCameraFrame) event.apply(*session_);
      return;
    }
    if (event.kind == Kind::kMeasured) return besides_.add({event.tick, event.measured});
    if (event.kind == Kind::kReset) ports_.leaps(*session_);
    if (event.kind != Kind::kStep) return event.apply(*session_);
    step(event.samples);
  }

  void step(const StylusSamples& samples) {
    const double at_s = out_.at_s + session_->tick_s();
    done_ = at_s > until_s_ + tolerance(part_);
    if (done_) return;
    const bool looked = at_s > from_s_ + tolerance(part_);
    Frame frame = session_->step(samples, looked ? ports_.outputs(*session_) : FrameRequest{});
    out_.at_s = at_s;
    ++out_.steps;
    if (looked) ports_.stepped(*session_, std::move(frame), at_s);
  }

  SessionReplay& replay_;
  const double from_s_, until_s_;
  const Overrides& overrides_;
  const Ports& ports_;
  Position begin_{};
  Outcome out_;
  MeasuredBesides besides_;
  Session* session_ = nullptr;
  size_t part_ = 0;
  uint64_t last_same_tick_ = 0;
  bool fresh_ = false;  ///< the session has no state of the recording yet
  bool done_ = false;
};

SessionReplay::Outcome SessionReplay::run(double from_s, double until_s, const Overrides& overrides,
                                          const Ports& ports) {
  return Run(*this, from_s, until_s, overrides, ports).run();
}

}  // namespace viscera
