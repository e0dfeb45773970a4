// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/body/body_notes.h"

#include <algorithm>
#include <cmath>

#include "math/number_text.h"
#include "viscera/model/body/cell_laminates.h"

namespace viscera {
namespace {

/// Returns the sizes of the pieces that springs connect, largest first.
/// @param for_each_neighbor  (slot, visit) calls visit(neighbour) for the other end of every spring of a node
template <class ForEachNeighbor>
std::vector<size_t> pieces(const Lattice& lattice, ForEachNeighbor for_each_neighbor) {
  std::vector<bool> seen(lattice.nodes.size(), false);
  std::vector<size_t> sizes;
  for (const uint32_t seed : lattice.active_slots) {
    if (seen[seed]) continue;
    std::vector<uint32_t> piece = {seed};
    seen[seed] = true;
    for (size_t next = 0; next < piece.size(); ++next) {
      for_each_neighbor(piece[next], [&](uint32_t neighbor) {
        if (seen[neighbor]) return;
        seen[neighbor] = true;
        piece.push_back(neighbor);
      });
    }
    sizes.push_back(piece.size());
  }
  std::sort(sizes.rbegin(), sizes.rend());
  return sizes;
}

std::vector<size_t> pieces(const SpringNetwork& network, const Lattice& lattice) {
  const NetworkLinks links = linksOf(network);
  return pieces(lattice, [&](uint32_t slot, auto visit) {
    for (uint32_t l = links.starts[slot]; l < links.starts[slot + 1]; ++l) visit(links.links[l].far);
  });
}

std::vector<size_t> pieces(const Lattice& lattice) {
  return pieces(lattice, [&](uint32_t slot, auto visit) {
    for (uint32_t spring = 0; spring < layout::kSpringsPerNode; ++spring) {
      if (springCount(lattice.nodes[slot], spring) == 0) continue;
      visit(static_cast<uint32_t>(lattice.neighborSlot(slot, spring)));
    }
  });
}

}  // namespace

std::string latticeNote(const Lattice& lattice, size_t fixed_nodes) {
  TextOut out;
  out << "lattice: " << lattice.active_slots.size() << " nodes (" << fixed_nodes << " fixed), " << lattice.springs()
      << " springs, spacing " << lattice.spacing_m * 1e3 << " mm";
  if (lattice.fills.empty()) return out.str();
  out << ", " << lattice.fills.size() << " partly filled cells";
  return out.str();
}

std::string networkNote(const Body& body, size_t fixed_nodes) {
  uint32_t least = UINT32_MAX, most = 0;
  for (const uint32_t slot : body.lattice.active_slots) {
    const uint32_t valence = body.lattice.nodes[slot].lo & layout::kValenceMask;
    least = std::min(least, valence);
    most = std::max(most, valence);
  }
  TextOut out;
  out << "network: " << body.lattice.active_slots.size() << " nodes (" << fixed_nodes << " fixed), "
      << body.network->springs.size() << " springs, valence " << least << ".." << most << ", mean length "
      << body.network->meanLength() * 1e3 << " mm";
  return out.str();
}

std::string linksNote(const SpringNetwork& network) {
  const auto bending = std::count_if(network.springs.begin(), network.springs.end(),
                                     [](const NetworkSpring& spring) { return spring.against_bending; });
  TextOut out;
  out << "explicit: its springs stored as " << 2 * network.springs.size() << " links, " << bending
      << " of its springs resist bending";
  return out.str();
}

std::string piecesNote(const Body& body) {
  const std::vector<size_t> sizes = body.network ? pieces(*body.network, body.lattice) : pieces(body.lattice);
  if (sizes.size() < 2) return "";
  TextOut out;
  out << "the " << (!body.hasCells() ? "network" : "lattice") << " consists of " << sizes.size()
      << " separate pieces; the largest has " << sizes[0] << " nodes, the next " << sizes[1];
  return out.str();
}

std::string wallsNote(const std::vector<Wall>& walls, double spacing_m) {
  constexpr double kNoise = 1 + 1e-6;  // tolerance for a spacing that is meant to equal a wall's thickness
  TextOut out;
  out.precision(3);
  for (const Wall& wall : walls) {
    if (spacing_m > kNoise * wall.thickness_m)
      out << (out.tellp() > 0 ? ", " : "") << wall.part << " " << wall.thickness_m * 1e3 << " mm";
  }
  if (out.tellp() <= 0) return "";
  out << ": walls thinner than a cell of " << spacing_m * 1e3 << " mm, so they have holes from the start; "
      << "use a spacing_m of at most " << walls.front().thickness_m;
  return out.str();
}

std::string laminatesNote(const Body& body) {
  const CellLaminates laminates = cellLaminates(body);
  if (laminates.cells.empty() && laminates.others == 0) return "";
  TextOut out;
  out << "borders between parts: " << laminates.cells.size() << " cells of two materials";
  if (laminates.others > 0)
    out << ", " << laminates.others
        << " of three or more materials, or without a plane between them, have the mean stiffness";
  return out.str();
}

std::string skinNote(const Skin& skin) {
  TextOut out;
  out << "skin: " << skin.mesh.triangles.size() << " faces, " << skin.mesh.positions_m.size() << " vertices ("
      << skin.deep_vertices << " inside the tissue, " << skin.bridges_removed << " faces across gaps removed)";
  if (skin.constant_vertices > 0)
    out << "; " << skin.constant_vertices << " vertices without a clear normal use the constant mapping";
  return out.str();
}

}  // namespace viscera
