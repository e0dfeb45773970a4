// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "model/shape/organ/phantom.h"
#include "viscera/model/model.h"

namespace viscera {

// Results of the preparation of a body: one line each, for a person.

std::string latticeNote(const Lattice& lattice, size_t fixed_nodes);
std::string networkNote(const Body& body, size_t fixed_nodes);
std::string linksNote(const SpringNetwork& network);                      ///< for an explicit lattice
std::string piecesNote(const Body& body);                                 ///< empty: one piece
std::string wallsNote(const std::vector<Wall>& walls, double spacing_m);  ///< empty: no wall is thinner than a cell
std::string laminatesNote(const Body& body);                              ///< empty: no cell has two materials
std::string skinNote(const Skin& skin);

}  // namespace viscera
