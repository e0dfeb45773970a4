// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/scene/knot_kind.h"

#include "viscera/model/scene/scene.h"

namespace viscera {

KnotKind knotNamed(const std::string& name) {
  std::string all;
  for (size_t k = 1; k < kKnotNames.size(); ++k) {
    if (name == kKnotNames[k]) return static_cast<KnotKind>(k);
    all += (k > 1 ? ", " : "") + std::string(kKnotNames[k]);
  }
  throw SceneError("unknown knot '" + name + "'; accepted: " + all);
}

}  // namespace viscera
