// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/model/scene/body_config.h"

namespace viscera {

struct Scene;

// What a scene may ask for together: one table (feature_rules.cpp), which every refusal and the table of the docs read.

/// Says why a body's keys do not go with its structure. @returns empty: they do
std::string featureFault(const BodyConfig& body);

/// @throws SceneError  a key of the scene, or of one of its bodies, does not go with its structure, integrator or
/// backend
void requireFeatures(const Scene& scene);

/// @throws SceneError  a key of the scene asks for something that the float64 reference does not have
void requireReferenceFeatures(const Scene& scene);

/// Returns the table as Markdown: `viscera keys features`.
std::string featuresTable();

}  // namespace viscera
