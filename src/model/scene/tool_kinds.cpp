// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scene/tool_kinds.h"

#include "viscera/model/scene/scene.h"

namespace viscera {

bool hasSuturesOrClips(const Scene& scene) {
  return !scene.sutures.empty() || mayClip(scene.styluses);
}

}  // namespace viscera
