// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/tissue/features.h"
#include "viscera/model/scene/scene.h"

namespace viscera::test {

/// Returns the features that a scene of leapfrog needs for a model, and no more. @param tools  with a stylus
inline FeatureSet featuresFor(const Model& model, bool tools) {
  Scene scene;
  if (tools) scene.styluses.emplace_back();
  return featuresOf(model, scene, 1);
}

}  // namespace viscera::test
