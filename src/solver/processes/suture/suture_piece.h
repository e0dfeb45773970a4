// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/processes/suture/chain/chain.h"
#include "solver/processes/suture/suture_contacts.h"
#include "solver/processes/suture/suture_knots.h"
#include "solver/processes/suture/suture_tracks.h"
#include "viscera/solver/suture_state.h"

namespace viscera {

/// A suture, or a piece cut from one, and everything that acts on it.
struct SuturePiece {
  /// @param on_needle  its start is on a needle, and its first hold is that needle's
  SuturePiece(uint32_t suture, const SutureConfig& config, bool on_needle);

  /// Cuts it at a node: this keeps the part before it. @param node  as returned by canPart()
  /// @returns the part behind it
  SuturePiece part(size_t node);
  /// Returns the nearest node at which it can be cut; 0: it is too short.
  size_t canPart(size_t node) const;
  SutureState seen() const;
  void persist(Archive& archive);

  uint32_t suture;  ///< index among those of the scene
  Chain chain;
  ChainAround around;  ///< holds: those of fixed ends, then those of styluses
  size_t fixed_holds = 0;
  SutureContacts touches;
  SutureTracks tracks;
  SutureKnots knots;
  SutureSkin skin;
  bool tied = false;  ///< tied to tissue in this tick

 private:
  SuturePiece(uint32_t of_suture, Chain parted) : suture(of_suture), chain(std::move(parted)) {}
};

}  // namespace viscera
