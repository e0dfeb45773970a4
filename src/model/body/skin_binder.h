// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "model/body/skin_anchor.h"
#include "viscera/layout/skin.h"
#include "viscera/model/body/lattice.h"

namespace viscera {

/// Binder of the vertices of one surface mesh to one lattice, one at a time, by one of the mappings of
/// docs/surface.md.
class SkinBinder {
 public:
  SkinBinder(const Lattice& lattice, Mapping mapping) : lattice_(lattice), mapping_(mapping) {}

  /// Binds a vertex.
  /// @param anchor  on the boundary, unless the mapping is kAuto   @param normal  unit
  layout::SkinBinding bind(const Anchor& anchor, const Vector3d& position_m, const Vector3d& normal) const;
  /// Returns whether a vertex is bound by the requested mapping, not by the constant basis in its place.
  bool isAsAsked(const layout::SkinBinding& binding) const;

 private:
  layout::SkinBinding bindToTriangle(const Anchor& anchor, const Vector3d& position_m, const Vector3d& normal) const;
  layout::SkinBinding bindAlongNormal(const Anchor& anchor, const Vector3d& position_m, const Vector3d& normal) const;
  uint32_t slotOf(const Vector3i& node) const { return static_cast<uint32_t>(lattice_.slotAt(node)); }
  Vector3d referenceOf(const Anchor& anchor, const layout::SkinBinding& binding) const;

  const Lattice& lattice_;
  Mapping mapping_;
};

}  // namespace viscera
