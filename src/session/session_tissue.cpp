// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Of a session, what lives in its tissue: threads, needles, clips, burns and blood.
#include "solver/bleed/bleeding.h"
#include "solver/burn/burns.h"
#include "solver/thread/thread_bodies.h"
#include "viscera/math/error.h"
#include "viscera/session/session.h"
#include "viscera/session/session_log.h"

namespace viscera {

size_t Session::threadPieces() const {
  return solver_->threads() ? solver_->threads()->count() : 0;
}

size_t Session::threadOf(size_t piece) const {
  return solver_->threads()->piece(piece).thread;
}

const std::vector<Vector3d>& Session::threadPlaces(size_t piece) const {
  return solver_->threads()->chain(piece).places_m();
}

std::vector<SeenThread> Session::seenThreads() const {
  std::vector<SeenThread> out;
  for (size_t p = 0; p < threadPieces(); ++p) out.push_back(solver_->threads()->piece(p).seen());
  return out;
}

std::vector<SeenNeedle> Session::seenNeedles() const {
  std::vector<SeenNeedle> out;
  const ThreadBodies* const threads = solver_->threads();
  for (size_t t = 0; threads && t < scene_.threads.size(); ++t) {
    const Needle* const needle = threads->needle(t);
    if (!needle) continue;
    const NeedleShape& shape = needle->shape();
    out.push_back({t, needle->pose(), shape.radius_m(), shape.length_m() / shape.radius_m(), shape.wireRadius_m(),
                   threads->needleHolder(t), needle->isInTissue()});
  }
  return out;
}

SeenClips Session::seenClips() const {
  const ThreadBodies* const threads = solver_->threads();
  return threads && threads->clips() ? threads->clips()->seen() : SeenClips();
}

SeenBurns Session::seenBurns() const {
  return solver_->burns() ? solver_->burns()->seen() : SeenBurns();
}

SeenBlood Session::seenBlood() const {
  return solver_->bleeding() ? solver_->bleeding()->seen() : SeenBlood();
}

std::string Session::threadRefusal() const {
  return solver_->threads() ? solver_->threads()->refused() : std::string();
}

void Session::tieThread(size_t piece, const ThreadTie& tie) {
  if (!solver_->threads()) throw Error("the scene has no threads");
  solver_->threads()->tie(piece, tie);
  for (SessionLog* log : logs_) log->threadTied(piece, tie);
}

std::vector<Vector3d> Session::needlePlaces(size_t thread) const {
  const Needle* const needle = solver_->threads()->needle(static_cast<uint32_t>(thread));
  return needle ? needle->places_m() : std::vector<Vector3d>();
}

std::vector<double> Session::threadTensions_n(size_t piece) const {
  const Chain& chain = solver_->threads()->chain(piece);
  std::vector<double> out;
  for (size_t link = 0; link + 1 < chain.nodes(); ++link) out.push_back(chain.tension_n(link));
  return out;
}

}  // namespace viscera
