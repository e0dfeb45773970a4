// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/session/tissue_processes.h"

#include "solver/processes/attach/attachments.h"
#include "solver/processes/bleed/bleeding.h"
#include "solver/processes/burn/burns.h"
#include "solver/processes/clip/clips.h"
#include "solver/processes/suture/suture_bodies.h"
#include "viscera/math/error.h"
#include "viscera/session/session.h"
#include "viscera/session/session_log.h"

namespace viscera {

namespace {

const SutureBodies* suturesOf(const Session& session) {
  return findProcess<SutureBodies>(session.solver());
}

BloodReport seenFluid(const Session& session, Fluid fluid) {
  for (const auto& process : session.solver().processes()) {
    const auto* const bleeding = dynamic_cast<const Bleeding*>(process.get());
    if (bleeding && bleeding->fluid() == fluid) return bleeding->seen();
  }
  return {};
}

}  // namespace

size_t suturePieces(const Session& session) {
  const SutureBodies* const sutures = suturesOf(session);
  return sutures ? sutures->count() : 0;
}

size_t sutureOf(const Session& session, size_t piece) {
  return suturesOf(session)->piece(piece).suture;
}

const std::vector<Vector3d>& suturePositions(const Session& session, size_t piece) {
  return suturesOf(session)->chain(piece).positions_m();
}

std::vector<double> sutureTensions_n(const Session& session, size_t piece) {
  const Chain& chain = suturesOf(session)->chain(piece);
  std::vector<double> out;
  for (size_t link = 0; link + 1 < chain.nodes(); ++link) out.push_back(chain.tension_n(link));
  return out;
}

std::vector<SutureState> sutureStates(const Session& session) {
  std::vector<SutureState> out;
  for (size_t p = 0; p < suturePieces(session); ++p) out.push_back(suturesOf(session)->piece(p).seen());
  return out;
}

std::string sutureRefusal(const Session& session) {
  const SutureBodies* const sutures = suturesOf(session);
  return sutures ? sutures->refused() : std::string();
}

std::vector<Vector3d> needlePositions(const Session& session, size_t suture) {
  const SutureBodies* const sutures = suturesOf(session);
  const Needle* const needle = sutures ? sutures->needle(suture) : nullptr;
  return needle ? needle->positions_m() : std::vector<Vector3d>();
}

std::vector<NeedleState> needleStates(const Session& session) {
  const SutureBodies* const sutures = suturesOf(session);
  return sutures ? sutures->needleStates() : std::vector<NeedleState>();
}

ClipStates seenClips(const Session& session) {
  const Clips* const clips = findProcess<Clips>(session.solver());
  return clips ? clips->seen() : ClipStates();
}

BurnReport seenBurns(const Session& session) {
  const Burns* const burns = findProcess<Burns>(session.solver());
  return burns ? burns->seen() : BurnReport();
}

BloodReport seenBlood(const Session& session) {
  return seenFluid(session, Fluid::kBlood);
}

BloodReport seenBile(const Session& session) {
  return seenFluid(session, Fluid::kBile);
}

std::vector<FibreState> seenFibres(const Session& session) {
  const Attachments* const attachments = findProcess<Attachments>(session.solver());
  return attachments ? attachments->seen() : std::vector<FibreState>();
}

FactGroups Session::facts() const {
  FactGroups out;
  for (const auto& process : solver_->processes()) out.push_back(process->facts());
  return out;
}

void Session::tieSuture(size_t piece, const SutureTie& tie) {
  SutureBodies* const sutures = findProcess<SutureBodies>(*solver_);
  if (!sutures) throw Error("the scene has no sutures");
  sutures->tie(piece, tie);
  for (SessionLog* log : logs_) log->sutureTied(piece, tie);
}

}  // namespace viscera
