// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "model/shape/detail/detail_bake.h"

namespace viscera {

/// Images of a bake.
struct Baked {
  TextureImage relief, color;  ///< color is empty where not requested
  BakeReport report;
};

/// Cache of earlier bakes, one file each, named after a hash of all its input. A file that is missing, cut short or of
/// another version is ignored; nothing is kept in a folder that is not writable.
class DetailCache {
 public:
  /// @param folder  empty: no cache   @param tile_px  of the atlas
  DetailCache(const std::string& folder, const BakeInput& input, int tile_px);
  bool find(Baked& out) const;
  void keep(const Baked& baked) const;

 private:
  std::string file_;
};

}  // namespace viscera
