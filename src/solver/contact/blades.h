// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "solver/contact/blade_edge.h"
#include "solver/contact/blade_point.h"
#include "viscera/tools/stylus.h"

namespace viscera {

/// The edges of all styluses in all bodies that resist blades, with what they have parted.
class Blades {
 public:
  Blades(const Model& model, const std::vector<StylusConfig>& styluses);
  /// After a substep that was made. @param motions  of the tick   @param substep  [kMaxStyluses] of the substep
  void act(BladeTarget& target, const ToolMotions& motions, const layout::ToolMotion* substep, double dt_s);
  /// The state was put back, or no stylus cuts. @returns whether there was a blade, which may have cut until then
  bool leave(BladeTarget& target);
  void reset();
  BladeWork done(uint32_t stylus) const;
  void persist(Archive& archive);

 private:
  struct Cut {
    Cut(const Model& model, size_t body, const std::vector<StylusConfig>& styluses);
    size_t body;
    std::unique_ptr<RestTissue> tissue;
    std::vector<BladeEdge> edges;                   ///< [kMaxStyluses]
    std::vector<std::optional<BladePoint>> points;  ///< [kMaxStyluses] of those that part by their points too
  };
  std::vector<Cut> cuts_;  ///< of bodies that resist blades
};

}  // namespace viscera
