// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/math/types.h"
#include "viscera/model/scene/mark_config.h"

namespace viscera {

/// State of a mark of a task, by which its colour and its pattern are chosen.
enum class MarkState { kLater, kNext, kDone, kWrong };

/// Returns marks with the colours and patterns of their states. @param states  [marks]
std::vector<MarkConfig> styledMarks(std::vector<MarkConfig> marks, const std::vector<MarkState>& states);

/// Returns a line in pieces of one length, measured across the normal. @param path_m  two or more corners
std::vector<MarkConfig> lineInPieces(const std::vector<Vector3d>& path_m, const Vector3d& normal, size_t count,
                                     double width_m);
/// Returns a target. @param normal  of its plane; 0: that of the surface
MarkConfig targetMark(const Vector3d& center_m, const Vector3d& normal, double radius_m);
/// Returns a ring around tissue. @param normal  along the tissue
MarkConfig ringMark(const Vector3d& center_m, const Vector3d& normal, double within_m, double width_m);

}  // namespace viscera
