// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/body/skin.h"

#include <algorithm>
#include <utility>

#include "model/body/skin_anchor.h"
#include "model/body/skin_binder.h"

namespace viscera {

namespace {

constexpr size_t kVerticesPerReport = 4096;

void bindVertices(const Lattice& lattice, const Solid& solid, Mapping mapping, const Progress& progress, Skin& skin) {
  const AnchorFinder finder(solid);
  const SkinBinder binder(lattice, mapping);
  const std::vector<Vector3f> normals = vertexNormals(skin.mesh);
  const size_t count = skin.mesh.positions_m.size();
  skin.bindings.reserve(count);
  for (size_t v = 0; v < count; ++v) {
    const Vector3d position = skin.mesh.positions_m[v].cast<double>(), normal = normals[v].cast<double>();
    const Anchor anchor = finder.find(position, normal, mapping == Mapping::kAuto);
    skin.deep_vertices += anchor.deep ? 1 : 0;
    skin.bindings.push_back(binder.bind(anchor, position, normal));
    skin.constant_vertices += binder.isAsAsked(skin.bindings.back()) ? 0 : 1;
    if (progress && v % kVerticesPerReport == 0)
      progress("bind skin", static_cast<double>(v) / static_cast<double>(count));
  }
}

/// Returns for each slot [slots] a representative of its piece: a node that springs connect to it, the same for the
/// whole piece.
std::vector<uint32_t> piecesOf(const Lattice& lattice) {
  constexpr uint32_t kNone = UINT32_MAX;
  std::vector<uint32_t> pieces(lattice.nodes.size(), kNone), reached;
  for (const uint32_t seed : lattice.active_slots) {
    if (pieces[seed] != kNone) continue;
    pieces[seed] = seed;
    for (reached = {seed}; !reached.empty();) {
      const uint32_t slot = reached.back();
      reached.pop_back();
      for (uint32_t spring = 0; spring < layout::kSpringsPerNode; ++spring) {
        if (!springCount(lattice.nodes[slot], spring)) continue;
        const auto next = static_cast<uint32_t>(lattice.neighborSlot(slot, spring));
        if (std::exchange(pieces[next], seed) != seed) reached.push_back(next);
      }
    }
  }
  return pieces;
}

void removeBridges(const Lattice& lattice, Skin& skin) {
  const std::vector<uint32_t> pieces = piecesOf(lattice);
  TriangleMesh& mesh = skin.mesh;
  size_t kept = 0;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& corners = mesh.triangles[t];
    const auto piece = [&](size_t i) { return pieces[skin.bindings[corners[i]].slot0]; };
    if (piece(1) != piece(0) || piece(2) != piece(0)) continue;
    mesh.parts[kept] = mesh.parts[t];
    if (!mesh.charts.empty()) mesh.charts[kept] = mesh.charts[t];
    mesh.triangles[kept++] = corners;
  }
  skin.bridges_removed = mesh.triangles.size() - kept;
  mesh.triangles.resize(kept);
  mesh.parts.resize(kept);
  if (!mesh.charts.empty()) mesh.charts.resize(kept);
}

void listBoundSlots(const Lattice& lattice, Skin& skin) {
  for (const layout::SkinBinding& b : skin.bindings) {
    skin.bound_slots.insert(skin.bound_slots.end(), {b.slot0, b.slot1, b.slot2});
    if ((b.springs & layout::kInCellBit) == 0) continue;
    const uint32_t corner = b.springs >> layout::kCornerShift & 7u;
    const Vector3i lowest = lattice.nodeAt(b.slot0) - Vector3i(corner & 1u, corner >> 1 & 1u, corner >> 2);
    forEachCorner(lattice, static_cast<uint32_t>(lattice.slotAt(lowest)),
                  [&](const Vector3i&, uint32_t slot) { skin.bound_slots.push_back(slot); });
  }
  std::sort(skin.bound_slots.begin(), skin.bound_slots.end());
  skin.bound_slots.erase(std::unique(skin.bound_slots.begin(), skin.bound_slots.end()), skin.bound_slots.end());
}

}  // namespace

Skin bindSkin(const TriangleMesh& mesh, const Lattice& lattice, const Solid& solid, Mapping mapping,
              const Progress& progress) {
  Skin skin;
  skin.mesh = refine(mesh, lattice.spacing_m);
  bindVertices(lattice, solid, mapping, progress, skin);
  listBoundSlots(lattice, skin);
  removeBridges(lattice, skin);
  if (progress) progress("bind skin", 1);
  return skin;
}

}  // namespace viscera
