// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/scene/overlays.h"

#include <algorithm>

#include "math/nearest_names.h"
#include "viscera/math/error.h"

namespace viscera {

std::string overlayNames() {
  std::string all;
  for (const OverlayName& overlay : kOverlayNames) all += (all.empty() ? "" : ", ") + std::string(overlay.name);
  return all;
}

Overlays overlaysOf(const std::vector<std::string>& names) {
  Overlays out;
  for (const std::string& name : names) {
    const auto* const found = std::find_if(kOverlayNames.begin(), kOverlayNames.end(),
                                           [&](const OverlayName& overlay) { return name == overlay.name; });
    if (found == kOverlayNames.end()) {
      std::vector<std::string> known;
      for (const OverlayName& overlay : kOverlayNames) known.emplace_back(overlay.name);
      throw SceneError("unknown overlay '" + name + "'; accepted: " + nearestFirstText(name, known));
    }
    out.add(found->value);
  }
  return out;
}

}  // namespace viscera
