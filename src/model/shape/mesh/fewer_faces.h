// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// Returns a mesh of about `faces` faces with the same parts and topology, and with vertices of the old one: a closed
/// mesh stays closed. Small parts stay as they are. Texture charts are dropped.
TriangleMesh withFewerFaces(const TriangleMesh& mesh, size_t faces);

}  // namespace viscera
