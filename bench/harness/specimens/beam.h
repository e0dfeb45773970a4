// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/specimens/block.h"
#include "viscera/model/scene/body_config.h"

namespace viscera::bench {

constexpr double kBeamSpacing_m = 0.004;

/// Creates a beam along z, clamped at z = 0. @param cells  its size
Model beamModel(const Vector3i& cells, const MaterialConfig& material);

/// Returns displacements of a body's lowest mode, to first order. [slots] @param largest_m  over all nodes
Field lowestMode(const Model& model, double largest_m);

/// Returns the static displacements under the forces of the body's lowest mode. When released, the body oscillates
/// slowly, including the effect of bending on lengths. [slots]
/// @param largest_m  approximate largest displacement of all nodes
Field bent(const Model& model, double largest_m);

/// Returns the static displacements under gravity. [slots] @param gravity_m_per_s2  tissue frame
Field sag(const Model& model, const Vector3d& gravity_m_per_s2);

}  // namespace viscera::bench
