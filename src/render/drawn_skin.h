// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "gpu/buffer.h"
#include "surface/surface.h"
#include "viscera/model/model.h"

namespace viscera {

/// A run of triangles that is drawn.
struct DrawnPart {
  uint32_t indices = 0, charts = 0;  ///< as those of MeshView
  size_t first = 0, count = 0;       ///< of indices
  bool fronts_only = false;          ///< backs are not drawn: fronts hide all of them
};

/// Which triangles of a surface one camera draws: those of the groups that it can see, in the order in which all of
/// them are drawn, so that no pixel differs.
class DrawnSkin {
 public:
  /// Looks at the triangles only if something is another thing than the last time.
  /// @param shown  [groups] 1: can be seen   @param fronts_only  [bodies] 1: see DrawnPart
  void choose(const Surface& surface, const std::vector<uint8_t>& shown, const std::vector<uint8_t>& fronts_only);
  const std::vector<DrawnPart>& parts() const { return parts_; }

 private:
  void addLive(const Surface& surface, size_t first, size_t count, bool fronts_only);
  void addListed(const uint32_t* corners, uint32_t chart, bool fronts_only);
  void addAll(const Surface& surface);
  void addSeen(const Surface& surface);
  void addBody(const Surface& surface, size_t body, size_t first_triangle);
  void addBeyond(const Surface& surface, const std::vector<uint8_t>& bodies);
  void send(const Surface& surface);

  std::vector<DrawnPart> parts_;
  std::vector<uint8_t> shown_, fronts_only_;
  uint64_t live_revision_ = 0;
  bool chosen_ = false;
  std::vector<uint32_t> indices_, charts_;  ///< of the list
  gpu::Buffer<uint32_t> index_buffer_, chart_buffer_;
  gpu::TexelView charts_view_;
};

/// [bodies] Is the skin closed, its triangles turned outwards and both sides of their edges alike, so that from outside
/// fronts hide every back?
std::vector<uint8_t> closedBodies(const Model& model);

}  // namespace viscera
