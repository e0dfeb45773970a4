// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/body/skin.h"

#include <algorithm>
#include <array>

#include "model/body/skin_anchor.h"
#include "model/body/skin_binder.h"
#include "model/body/skin_ties.h"

namespace viscera {

namespace {

constexpr size_t kVerticesPerReport = 4096;
constexpr double kShareOfBinding = 0.7;  // of the whole time; the ties take the rest

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
    if (progress && v % kVerticesPerReport == 0) progress("bind skin", kShareOfBinding * v / count);
  }
}

void tieTriangles(const Lattice& lattice, Skin& skin) {
  TieFinder finder(lattice, skin.bindings);
  std::vector<std::array<uint32_t, 3>> whole;
  std::vector<uint16_t> parts;
  std::vector<uint32_t> charts;
  skin.tie_starts.push_back(0);
  for (size_t t = 0; t < skin.mesh.triangles.size(); ++t) {
    const auto& corners = skin.mesh.triangles[t];
    bool tied = true;
    for (int edge = 0; edge < 3 && tied; ++edge) {
      tied = finder.tie(corners[edge], corners[(edge + 1) % 3], skin.ties);
    }
    if (!tied) {
      skin.ties.resize(skin.tie_starts.back());
      ++skin.bridges_removed;
      continue;
    }
    skin.tie_starts.push_back(static_cast<uint32_t>(skin.ties.size()));
    whole.push_back(corners);
    parts.push_back(skin.mesh.parts[t]);
    if (!skin.mesh.charts.empty()) charts.push_back(skin.mesh.charts[t]);
  }
  skin.mesh.triangles.swap(whole);
  skin.mesh.parts.swap(parts);
  skin.mesh.charts.swap(charts);
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
  tieTriangles(lattice, skin);
  if (progress) progress("bind skin", 1);
  return skin;
}

}  // namespace viscera
