// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/processes/suture/chain/chain.h"
#include "solver/processes/suture/thread_channels.h"
#include "solver/processes/suture/thread_knots.h"
#include "solver/processes/suture/thread_touches.h"
#include "viscera/solver/seen_thread.h"

namespace viscera {

/// A thread, or a piece of one that was parted, and what acts on it.
struct ThreadPiece {
  /// @param on_needle  its start is, and its first hold is that needle's
  ThreadPiece(uint32_t thread, const ThreadConfig& config, bool on_needle);

  /// Parted at a node: this keeps what is before it. @param node  of those that canPart() says
  /// @returns what is behind it
  ThreadPiece part(size_t node);
  /// The node nearest to one at which it can be parted; 0: it is too short.
  size_t canPart(size_t node) const;
  SeenThread seen() const;
  void persist(Archive& archive);

  uint32_t thread;  ///< of the scene
  Chain chain;
  ChainAround around;  ///< holds: those of fixed ends, then those of hands
  size_t fixed_holds = 0;
  ThreadTouches touches;
  ThreadChannels channels;
  ThreadKnots knots;
  ThreadSkin skin;
  bool tied = false;  ///< to tissue, in this tick

 private:
  ThreadPiece(uint32_t of_thread, Chain parted) : thread(of_thread), chain(std::move(parted)) {}
};

}  // namespace viscera
