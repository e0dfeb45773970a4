// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "surface/follow/host_surface.h"
#include "surface/follow/state_mirror.h"
#include "surface/surface.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/body_config.h"
#include "viscera/model/shape/triangle_mesh.h"

namespace viscera::bench {

/// Where a point of the body at rest goes [m].
using Deformation = std::function<Vector3d(const Vector3d& rest_m)>;

std::string nameOf(Mapping mapping);
/// The four of EGVE, and `auto`.
const std::vector<Mapping>& allMappings();

/// A body with a skin that follows it by one of the mappings.
Model mappedModel(const Solid& solid, const TriangleMesh& mesh, Mapping mapping);
/// Share of vertices that have the mapping asked for, 0..1; the others have the constant one.
double shareAsAsked(const Model& model);

/// The state of a body whose nodes were moved, as surfaces take it.
StateSnapshot movedState(const Model& model, const std::vector<uint32_t>& bricks, const Deformation& deformation);

/// A sphere's grid of 2 around (up - 1) triangles, closed, each vertex moved by a function of its direction.
/// @param around, up  > 2
TriangleMesh closedMesh(int around, int up, const std::function<Vector3d(const Vector3d& direction)>& place);

}  // namespace viscera::bench
