// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/api.h"
#include "viscera/math/types.h"
#include "viscera/solver/blood_report.h"
#include "viscera/solver/burn_report.h"
#include "viscera/solver/clip_state.h"
#include "viscera/solver/fibre_state.h"
#include "viscera/solver/needle_state.h"
#include "viscera/solver/suture_state.h"

namespace VISCERA_PUBLIC viscera {

class Session;

// Typed access to the processes in the tissue of a session, after its last step. Session::facts() has all of them as
// names and values. Each function returns something empty where the scene has no such process.

/// @name Sutures. Pieces 0 to suturePieces() - 1 are the sutures of the scene, then the pieces cut from them.
/// @{
size_t suturePieces(const Session& session);
/// Returns the index in the scene of the suture that a piece belongs to.
size_t sutureOf(const Session& session, size_t piece);
/// Returns the positions of a piece's nodes, tissue frame [m].
const std::vector<Vector3d>& suturePositions(const Session& session, size_t piece);
/// Returns the tensions of a piece's links [N], above 0 under tension.
std::vector<double> sutureTensions_n(const Session& session, size_t piece);
/// Returns the state of all pieces, [pieces].
std::vector<SutureState> sutureStates(const Session& session);
/// Returns why the last of SutureConfig::ties was not tied.
std::string sutureRefusal(const Session& session);
/// @}
/// Returns the positions of a suture's needle, from the tip on [m]; empty without one.
std::vector<Vector3d> needlePositions(const Session& session, size_t suture);
/// Returns the needles of the sutures that have one.
std::vector<NeedleState> needleStates(const Session& session);
ClipStates seenClips(const Session& session);
BurnReport seenBurns(const Session& session);
BloodReport seenBlood(const Session& session);
BloodReport seenBile(const Session& session);
/// Returns the fibres of all attachments, always in the same order.
std::vector<FibreState> seenFibres(const Session& session);

}  // namespace viscera
