// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/suture_piece.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "math/archive.h"
#include "solver/processes/suture/suture_shape.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

constexpr size_t kLeastPieceNodes = 3;  // nodes of a chain

}  // namespace

SuturePiece::SuturePiece(uint32_t of_suture, const SutureConfig& config, bool on_needle)
    : suture(of_suture), chain(materialOf(config), positionsOf(config)) {
  const auto last = static_cast<uint32_t>(chain.nodes() - 1);
  for (const uint32_t node : {0U, last}) {
    if (!(node == 0 && on_needle) && (node == 0 ? config.start : config.end) == SutureEnd::kFree) continue;
    around.holds.emplace_back();
    around.holds.back().node = node;
    around.holds.back().to_m = chain.positions_m()[node];
  }
  fixed_holds = around.holds.size();
  around.swaged[0] = on_needle;
}

size_t SuturePiece::canPart(size_t node) const {
  if (chain.nodes() < 2 * kLeastPieceNodes - 1) return 0;
  return std::clamp(node, kLeastPieceNodes - 1, chain.nodes() - kLeastPieceNodes);
}

SuturePiece SuturePiece::part(size_t node) {
  around.holds.resize(fixed_holds);
  around.entered = {};
  SuturePiece behind(suture, chain.part(node));
  behind.knots = knots.part(static_cast<double>(node), around);
  const auto before = std::count_if(around.slides.begin(), around.slides.end(),
                                    [&](const ChainSlide& slide) { return slide.s <= static_cast<double>(node); });
  behind.tracks = tracks.part(static_cast<size_t>(before));
  behind.around = partAround(node, around);
  fixed_holds = around.holds.size();
  behind.fixed_holds = behind.around.holds.size();
  behind.tied = tied;
  return behind;
}

SutureState SuturePiece::seen() const {
  const size_t links = chain.nodes() - 1;
  SutureState out;
  out.suture = suture;
  out.length_m = static_cast<double>(links) * chain.link_m();
  out.turns = knots.turns();
  for (size_t link = 0; link < links; ++link) out.largest_n = std::max(out.largest_n, chain.tension_n(link));
  for (size_t k = 0; k < around.knots.size(); ++k) {
    const ChainKnot& knot = around.knots[k];
    const ThrownKnot& thrown = knots.thrown()[k];
    if (knot.out) continue;
    const double inside = knot.s2 + (knot.s1 > knot.s2 ? 1 : -1);
    const auto link = static_cast<size_t>(std::clamp(inside, 0.0, static_cast<double>(links - 1)));
    out.knots.push_back({thrown.kind, std::vector<int>(thrown.turns.begin(), thrown.turns.begin() + thrown.throws),
                         knot.tied && !thrown.drawn, thrown.holds_n, std::abs(knot.s1 - knot.s2) * chain.link_m(),
                         chain.tension_n(link)});
  }
  return out;
}

void SuturePiece::persist(Archive& archive) {
  chain.persist(archive);
  archive.list(around.touches);
  archive.list(around.slides);
  tracks.persist(archive);
  archive.list(around.knots);
  knots.persist(archive);
  std::vector<ChainHold> fixed(around.holds.begin(), around.holds.begin() + static_cast<std::ptrdiff_t>(fixed_holds));
  archive.list(fixed);
  uint8_t swaged = around.swaged[0] ? 1 : 0;
  archive.value(swaged);
  if (!archive.reads()) return;
  around.swaged[0] = swaged != 0;
  if (around.knots.size() > kMostKnots || around.knots.size() != knots.thrown().size())
    throw Error("knots of a suture are inconsistent in the saved state");
  const auto beyond = [this](const ChainHold& hold) { return hold.node >= chain.nodes(); };
  if (std::any_of(fixed.begin(), fixed.end(), beyond))
    throw Error("the saved state holds a suture at a node that it does not have");
  around.holds = std::move(fixed);
  fixed_holds = around.holds.size();
}

}  // namespace viscera
