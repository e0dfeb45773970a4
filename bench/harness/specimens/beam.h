// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/specimens/block.h"
#include "viscera/model/scene/body_config.h"

namespace viscera::bench {

constexpr double kBeamSpacing_m = 0.004;

/// A beam along z, clamped at z = 0. @param cells  its size
Model beamModel(const Vector3i& cells, const MaterialConfig& material);

/// Displacements of the lowest mode of a body, to first order. [slots] @param largest_m  of all nodes
Field lowestMode(const Model& model, double largest_m);

/// Displacements in which forces hold a body that are those of its lowest mode: let go, it swings slowly, with all that
/// bending does to lengths. [slots] @param largest_m  about that of all nodes
Field bent(const Model& model, double largest_m);

/// Displacements in which the body hangs at rest. [slots] @param gravity_m_per_s2  tissue frame
Field sag(const Model& model, const Vector3d& gravity_m_per_s2);

}  // namespace viscera::bench
