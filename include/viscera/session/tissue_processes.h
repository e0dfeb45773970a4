// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/math/types.h"
#include "viscera/solver/seen_blood.h"
#include "viscera/solver/seen_burns.h"
#include "viscera/solver/seen_clip.h"
#include "viscera/solver/seen_needle.h"
#include "viscera/solver/seen_thread.h"

namespace viscera {

class Session;

// What lives in the tissue of a session, after its last step. Session::facts() has all of it as names and values;
// these functions give it as types, where a program knows what it looks for. Each returns something empty where the
// scene has no such process.

/// @name Threads. Pieces: threads of the scene, and behind them what was parted from them, threadPieces() in all.
/// @{
size_t threadPieces(const Session& session);
size_t threadOf(const Session& session, size_t piece);                            ///< of the scene
const std::vector<Vector3d>& threadPlaces(const Session& session, size_t piece);  ///< of its nodes, tissue frame [m]
std::vector<double> threadTensions_n(const Session& session, size_t piece);       ///< of its links, pulling above 0
std::vector<SeenThread> seenThreads(const Session& session);                      ///< [pieces]
std::string threadRefusal(const Session& session);  ///< why the last of ThreadConfig::ties was not tied
/// @}
std::vector<Vector3d> needlePlaces(const Session& session, size_t thread);  ///< of its needle, from the tip on; or none
std::vector<SeenNeedle> seenNeedles(const Session& session);                ///< of the threads that have one
SeenClips seenClips(const Session& session);
SeenBurns seenBurns(const Session& session);
SeenBlood seenBlood(const Session& session);

}  // namespace viscera
