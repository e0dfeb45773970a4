// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/body/skin.h"

#include <algorithm>
#include <array>

#include "model/body/skin_anchor.h"
#include "model/body/skin_basis.h"
#include "model/body/skin_ties.h"

namespace viscera {

namespace {

constexpr size_t kVerticesPerReport = 4096;
constexpr double kShareOfBinding = 0.7;  // of the whole time; the ties take the rest

layout::vec4 packed(const Vector3d& v) {
  const Vector3f f = v.cast<float>();
  return {f.x(), f.y(), f.z(), 0};
}

/// Binds the vertices of one skin to one lattice, one at a time.
class Binder {
 public:
  explicit Binder(const Lattice& lattice) : lattice_(lattice) {}

  layout::SkinBinding bind(const Anchor& anchor, const Vector3d& position_m, const Vector3d& normal) const {
    layout::SkinBinding binding{};
    const std::array<uint32_t, 3> slots = {slotOf(anchor.nodes[0]), slotOf(anchor.nodes[1]), slotOf(anchor.nodes[2])};
    binding.slot0 = slots[0];
    binding.slot1 = slots[1];
    binding.slot2 = slots[2];
    for (int edge = 0; edge < 3; ++edge) {
      const int spring = springIndex(anchor.nodes[(edge + 1) % 3] - anchor.nodes[edge]);
      binding.springs |= static_cast<uint32_t>(spring) << (5 * edge);
    }
    if (anchor.cell) {
      const Vector3i corner = anchor.nodes[0] - *anchor.cell;
      const int number = corner.x() + 2 * corner.y() + 4 * corner.z();
      binding.springs |= layout::kInCellBit | static_cast<uint32_t>(number) << layout::kCornerShift;
    }
    const float weight1 = static_cast<float>(anchor.weight1), weight2 = static_cast<float>(anchor.weight2);
    binding.weights = {1 - weight1 - weight2, weight1, weight2, 0};

    const Vector3d edge1 = (anchor.nodes[1] - anchor.nodes[0]).cast<double>();
    const Vector3d edge2 = (anchor.nodes[2] - anchor.nodes[0]).cast<double>();
    // The offset is taken from where the rounded weights put the reference point, so that the sum comes out right.
    const Vector3d reference =
        lattice_.restPosition(slots[0]) + lattice_.spacing_m * (weight1 * edge1 + weight2 * edge2);
    const Vector3d offset = position_m - reference;
    const SkinBasis constant = triangleBasis(edge1, edge2);
    binding.offset_constant = packed(constant.coordinates(offset));
    binding.normal_constant = packed(constant.coordinates(normal));
    if (const auto curved = interpolatedBasis(lattice_, slots, binding.weights, constant)) {
      binding.springs |= layout::kInterpolatedBit;
      binding.offset_interpolated = packed(curved->coordinates(offset));
      binding.normal_interpolated = packed(curved->coordinates(normal));
    }
    return binding;
  }

 private:
  uint32_t slotOf(const Vector3i& node) const { return static_cast<uint32_t>(lattice_.slotAt(node)); }

  const Lattice& lattice_;
};

void bindVertices(const Lattice& lattice, const Solid& solid, const Progress& progress, Skin& skin) {
  const AnchorFinder finder(solid);
  const Binder binder(lattice);
  const std::vector<Vector3f> normals = vertexNormals(skin.mesh);
  const size_t count = skin.mesh.positions_m.size();
  skin.bindings.reserve(count);
  for (size_t v = 0; v < count; ++v) {
    const Vector3d position = skin.mesh.positions_m[v].cast<double>(), normal = normals[v].cast<double>();
    const Anchor anchor = finder.find(position, normal);
    skin.deep_vertices += anchor.deep ? 1 : 0;
    skin.bindings.push_back(binder.bind(anchor, position, normal));
    if (progress && v % kVerticesPerReport == 0) progress("bind skin", kShareOfBinding * v / count);
  }
}

void tieTriangles(const Lattice& lattice, Skin& skin) {
  TieFinder finder(lattice, skin.bindings);
  std::vector<std::array<uint32_t, 3>> whole;
  std::vector<uint16_t> parts;
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
  }
  skin.mesh.triangles.swap(whole);
  skin.mesh.parts.swap(parts);
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

Skin bindSkin(const TriangleMesh& mesh, const Lattice& lattice, const Solid& solid, const Progress& progress) {
  Skin skin;
  skin.mesh = refine(mesh, lattice.spacing_m);
  bindVertices(lattice, solid, progress, skin);
  listBoundSlots(lattice, skin);
  tieTriangles(lattice, skin);
  if (progress) progress("bind skin", 1);
  return skin;
}

}  // namespace viscera
