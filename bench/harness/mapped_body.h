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

/// Maps a point of the body at rest to its deformed position [m].
using Deformation = std::function<Vector3d(const Vector3d& rest_m)>;

std::string nameOf(Mapping mapping);
/// Returns the four mappings of EGVE, and `auto`.
const std::vector<Mapping>& allMappings();

/// Creates a body with a surface mesh that follows it by one of the mappings.
Model mappedModel(const Solid& solid, const TriangleMesh& mesh, Mapping mapping);
/// Returns the share of vertices with the requested mapping, 0..1; the others have the constant one.
double shareAsAsked(const Model& model);

/// Returns the state of a body with displaced nodes, in the form that surfaces take.
StateSnapshot movedState(const Model& model, const std::vector<uint32_t>& bricks, const Deformation& deformation);

/// Creates a closed sphere grid of 2 around (up - 1) triangles; a function of the direction gives the position of each
/// vertex.
/// @param around, up  > 2
TriangleMesh closedMesh(int around, int up, const std::function<Vector3d(const Vector3d& direction)>& position);

}  // namespace viscera::bench
