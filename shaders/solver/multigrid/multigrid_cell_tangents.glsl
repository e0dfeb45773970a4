// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tangents of cells: vectors 0 to 2 have the mean edges less their rest value, over h, and in w the curvature of the volume's
// energy [J], what moments are times [J], and how sure these are (multigrid_cells.comp). After multigrid.glsl.
layout(std430, binding = kBindCellTangents) buffer CellTangentsBuffer { vec4 cell_tangents[]; };

vec4 cellTangent(uint vector, uint slot) { return cell_tangents[vector * slot_count + slot]; }
