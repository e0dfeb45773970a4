// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "model/shape/organ/phantom.h"
#include "viscera/model/model.h"

namespace viscera {

// What the preparation of a body came to: one line each, for a person.

std::string latticeNote(const Lattice& lattice, size_t fixed_nodes);
std::string networkNote(const Body& body, size_t fixed_nodes);
std::string linksNote(const SpringNetwork& network);                      ///< of an explicit lattice
std::string piecesNote(const Body& body);                                 ///< empty: one piece
std::string wallsNote(const std::vector<Wall>& walls, double spacing_m);  ///< empty: none is thinner than a cell
std::string laminatesNote(const Body& body);                              ///< empty: no cell is of two materials
std::string skinNote(const Skin& skin);

}  // namespace viscera
