// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "model/shape/detail/detail_bake.h"

namespace viscera {

/// Pictures of a bake.
struct Baked {
  TextureImage relief, color;  ///< color is empty where none was asked for
  BakeReport report;
};

/// Bakes of earlier runs, one file each, named after a hash of all that goes into one. A file that is missing, cut
/// short or of another version is no bake; a folder that cannot be written to keeps none.
class DetailCache {
 public:
  /// @param folder  empty: none   @param tile_px  of the atlas
  DetailCache(const std::string& folder, const BakeInput& input, int tile_px);
  bool find(Baked& out) const;
  void keep(const Baked& baked) const;

 private:
  std::string file_;
};

}  // namespace viscera
