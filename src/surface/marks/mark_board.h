// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "surface/marks/rest_skin.h"
#include "viscera/model/model.h"
#include "viscera/surface/skin_marks.h"

namespace viscera {

/// Puts marks on the surface meshes of a model at rest.
class MarkBoard {
 public:
  /// @param model  must outlive this
  explicit MarkBoard(const Model& model);

  /// Returns marks on the surface; null where there are none. Marks that differ from the last ones only in colours and
  /// patterns keep their strokes. A mark that meets no surface has no strokes.
  std::shared_ptr<const VisibleMarks> show(const std::vector<MarkConfig>& marks);
  /// Returns why a mark of the last call is not shown where it is meant to be, or empty.
  std::string faultOf(size_t mark) const;

 private:
  const Model& model_;
  std::unique_ptr<RestSkins> skins_;  ///< null until there is a mark
  std::vector<MarkConfig> marks_;     ///< of strokes_
  std::shared_ptr<const std::vector<MarkStroke>> strokes_;
};

}  // namespace viscera
