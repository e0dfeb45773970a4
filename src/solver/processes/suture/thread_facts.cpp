// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Of ThreadBodies, what others see of them.
#include "solver/processes/suture/thread_bodies.h"

namespace viscera {

namespace {

Fact::Facts factsOf(const SeenKnot& knot) {
  return {{"knot", std::string(nameOf(knot.kind))},
          {"turns", std::vector<double>(knot.turns.begin(), knot.turns.end())},
          {"tied", knot.tied},
          {"holds_n", knot.holds_n},
          {"loop_m", knot.loop_m},
          {"loop_n", knot.loop_n}};
}

}  // namespace

FactGroup ThreadBodies::facts() const {
  FactGroup out{"threads", refused_.empty() ? std::to_string(pieces_.size()) + " pieces" : refused_};
  out.warns = !refused_.empty();
  std::vector<Fact::Facts> pieces;
  for (const ThreadPiece& piece : pieces_) {
    const SeenThread seen = piece.seen();
    std::vector<Fact::Facts> knots;
    for (const SeenKnot& knot : seen.knots) knots.push_back(factsOf(knot));
    pieces.push_back({{"name", names_[seen.thread]},
                      {"length_m", seen.length_m},
                      {"largest_n", seen.largest_n},
                      {"turns", seen.turns},
                      {"knots", std::move(knots)}});
  }
  out.facts.push_back({"pieces", std::move(pieces)});
  if (out.warns) out.facts.push_back({"refused", refused_});
  return out;
}

void ThreadBodies::draw(ProcessLook& look) const {
  for (const ThreadPiece& piece : pieces_)
    look.threads.push_back({piece.thread, ThreadPart::kThread, piece.chain.places_m()});
  for (size_t t = 0; t < first_.size(); ++t) {
    if (const Needle* const one = needle(t)) look.threads.push_back({t, ThreadPart::kNeedle, one->places_m()});
  }
}

std::vector<SeenNeedle> ThreadBodies::seenNeedles() const {
  std::vector<SeenNeedle> out;
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
