// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "cli/commands.h"
#include "model/scan/volume.h"
#include "model/scene/tissue_presets.h"

namespace viscera::cli {

/// Returns [largest label + 1] whether --rigid names a label, by name or number.
/// @throws SceneError  it names one that is not imported
std::vector<bool> rigidLabels(const std::vector<LabelName>& names, const ImportOptions& options);

/// Returns the YAML keys of a label's elasticity: those of its tissue, with a Poisson ratio that needs fewer substeps,
/// or else of a soft tissue.
/// @param tissue  null: no preset has the label's name
std::string materialOf(const TissuePreset* tissue);

/// Returns the YAML lines of a body made of all labels: its source and a part for each label that is not rigid.
/// @param there  [largest label + 1] whether the label has voxels
/// @throws SceneError  more labels than a body may have parts
std::string oneBodySource(const std::vector<LabelName>& names, const std::vector<bool>& there,
                          const std::vector<bool>& rigid, const ImportOptions& options);

/// Returns the entries that fix the rigid labels of such a body; empty if none is rigid.
std::string heldParts(const std::vector<LabelName>& names, const std::vector<bool>& there,
                      const std::vector<bool>& rigid);

}  // namespace viscera::cli
