// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Output of SutureBodies.
#include "solver/processes/suture/suture_bodies.h"

namespace viscera {

namespace {

Fact::Facts factsOf(const KnotState& knot) {
  return {{"knot", std::string(nameOf(knot.kind))},
          {"turns", std::vector<double>(knot.turns.begin(), knot.turns.end())},
          {"tied", knot.tied},
          {"holds_n", knot.holds_n},
          {"loop_m", knot.loop_m},
          {"loop_n", knot.loop_n}};
}

}  // namespace

FactGroup SutureBodies::facts() const {
  FactGroup out{"sutures", refused_.empty() ? std::to_string(pieces_.size()) + " pieces" : refused_};
  out.warns = !refused_.empty();
  std::vector<Fact::Facts> pieces;
  for (const SuturePiece& piece : pieces_) {
    const SutureState seen = piece.seen();
    std::vector<Fact::Facts> knots;
    for (const KnotState& knot : seen.knots) knots.push_back(factsOf(knot));
    pieces.push_back({{"name", names_[seen.suture]},
                      {"length_m", seen.length_m},
                      {"largest_n", seen.largest_n},
                      {"turns", seen.turns},
                      {"knots", std::move(knots)}});
  }
  out.facts.push_back({"pieces", std::move(pieces)});
  if (out.warns) out.facts.push_back({"refused", refused_});
  return out;
}

void SutureBodies::draw(ProcessVisuals& visuals) const {
  for (const SuturePiece& piece : pieces_)
    visuals.sutures.push_back({piece.suture, TubeKind::kSuture, piece.chain.positions_m()});
  for (size_t t = 0; t < first_.size(); ++t) {
    if (const Needle* const one = needle(t)) visuals.sutures.push_back({t, TubeKind::kNeedle, one->positions_m()});
  }
}

std::vector<NeedleState> SutureBodies::needleStates() const {
  std::vector<NeedleState> out;
  for (size_t t = 0; t < first_.size(); ++t) {
    const Needle* const one = needle(t);
    if (!one) continue;
    const NeedleShape& shape = one->shape();
    out.push_back({t, one->pose(), shape.radius_m(), shape.length_m() / shape.radius_m(), shape.wireRadius_m(),
                   needleHolder(t), one->isInTissue()});
  }
  return out;
}

}  // namespace viscera
