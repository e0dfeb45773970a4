// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/model/scene/body_config.h"

namespace viscera {

struct Scene;

// Which keys a scene can combine: one table (feature_rules.cpp) for every error and for the table in the docs.

/// Returns why a body's keys cannot be combined with its structure; empty: they can.
std::string featureFault(const BodyConfig& body);

/// Checks the keys of a scene.
/// @throws SceneError  a key of the scene, or of one of its bodies, does not go with its structure, integrator or
/// backend
void requireFeatures(const Scene& scene);

/// Checks that the float64 reference supports the scene.
/// @throws SceneError  a key of the scene needs something that the float64 reference does not have
void requireReferenceFeatures(const Scene& scene);

/// Returns the table as Markdown: `viscera keys features`.
std::string featuresTable();

}  // namespace viscera
