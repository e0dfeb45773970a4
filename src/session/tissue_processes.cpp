// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/session/tissue_processes.h"

#include "solver/processes/bleed/bleeding.h"
#include "solver/processes/burn/burns.h"
#include "solver/processes/clip/clips.h"
#include "solver/processes/suture/thread_bodies.h"
#include "viscera/math/error.h"
#include "viscera/session/session.h"
#include "viscera/session/session_log.h"

namespace viscera {

namespace {

const ThreadBodies* threadsOf(const Session& session) {
  return findProcess<ThreadBodies>(session.solver());
}

}  // namespace

size_t threadPieces(const Session& session) {
  const ThreadBodies* const threads = threadsOf(session);
  return threads ? threads->count() : 0;
}

size_t threadOf(const Session& session, size_t piece) {
  return threadsOf(session)->piece(piece).thread;
}

const std::vector<Vector3d>& threadPlaces(const Session& session, size_t piece) {
  return threadsOf(session)->chain(piece).places_m();
}

std::vector<double> threadTensions_n(const Session& session, size_t piece) {
  const Chain& chain = threadsOf(session)->chain(piece);
  std::vector<double> out;
  for (size_t link = 0; link + 1 < chain.nodes(); ++link) out.push_back(chain.tension_n(link));
  return out;
}

std::vector<SeenThread> seenThreads(const Session& session) {
  std::vector<SeenThread> out;
  for (size_t p = 0; p < threadPieces(session); ++p) out.push_back(threadsOf(session)->piece(p).seen());
  return out;
}

std::string threadRefusal(const Session& session) {
  const ThreadBodies* const threads = threadsOf(session);
  return threads ? threads->refused() : std::string();
}

std::vector<Vector3d> needlePlaces(const Session& session, size_t thread) {
  const ThreadBodies* const threads = threadsOf(session);
  const Needle* const needle = threads ? threads->needle(thread) : nullptr;
  return needle ? needle->places_m() : std::vector<Vector3d>();
}

std::vector<SeenNeedle> seenNeedles(const Session& session) {
  const ThreadBodies* const threads = threadsOf(session);
  return threads ? threads->seenNeedles() : std::vector<SeenNeedle>();
}

SeenClips seenClips(const Session& session) {
  const Clips* const clips = findProcess<Clips>(session.solver());
  return clips ? clips->seen() : SeenClips();
}

SeenBurns seenBurns(const Session& session) {
  const Burns* const burns = findProcess<Burns>(session.solver());
  return burns ? burns->seen() : SeenBurns();
}

SeenBlood seenBlood(const Session& session) {
  const Bleeding* const bleeding = findProcess<Bleeding>(session.solver());
  return bleeding ? bleeding->seen() : SeenBlood();
}

FactGroups Session::facts() const {
  FactGroups out;
  for (const auto& process : solver_->processes()) out.push_back(process->facts());
  return out;
}

void Session::tieThread(size_t piece, const ThreadTie& tie) {
  ThreadBodies* const threads = findProcess<ThreadBodies>(*solver_);
  if (!threads) throw Error("the scene has no threads");
  threads->tie(piece, tie);
  for (SessionLog* log : logs_) log->threadTied(piece, tie);
}

}  // namespace viscera
