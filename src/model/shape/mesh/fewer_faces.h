// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// A mesh of about `faces` faces with the same parts and the same topology, its vertices among those of the old one: a
/// mesh that was closed still is. Parts that are small already stay as they are. Texture charts are dropped.
TriangleMesh withFewerFaces(const TriangleMesh& mesh, size_t faces);

}  // namespace viscera
