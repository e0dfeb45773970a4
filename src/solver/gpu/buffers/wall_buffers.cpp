// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/buffers/wall_buffers.h"

#include <set>

#include "layout/bindings.h"
#include "layout/law.h"

namespace viscera {

namespace {

std::vector<uint32_t> wallNodes(const Model& model, const JoinedMoments& moments) {
  std::set<uint32_t> out;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Lattice& lattice = model.bodies[b].lattice;
    const uint32_t first = model.slotOffset(b);
    for (const uint32_t cell : lattice.active_slots) {
      if (!moments.wallOf(first + cell)) continue;
      forEachCorner(lattice, cell, [&](const Vector3i& /*corner*/, uint32_t slot) { out.insert(first + slot); });
    }
  }
  return {out.begin(), out.end()};
}

}  // namespace

WallBuffers::WallBuffers(const Model& model, const JoinedMoments& moments)
    : nodes(wallNodes(model, moments), "nodes of thin walls"),
      rows(layout::kRowVectors * model.slots(), "rows of nodes"),
      pulls(layout::kWallVectors * model.slots(), "pulls of thin walls"),
      row_texels_(rows.raw(), gpu::TexelFormat::kRgba32f),
      pull_texels_(pulls.raw(), gpu::TexelFormat::kRgba32f) {}

void WallBuffers::bind() const {
  if (!nodes.size()) return;
  nodes.bindStorage(layout::kBindWallNodes);
  rows.bindStorage(layout::kBindRows);
  pulls.bindStorage(layout::kBindWallPulls);
  row_texels_.bind(layout::kUnitRows);
  pull_texels_.bind(layout::kUnitWallPulls);
}

}  // namespace viscera
