// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/import/preview.h"
#include "cli/import/stages.h"
#include "model/scan/border_values.h"
#include "model/scan/surface_net.h"

namespace viscera::cli {

/// What is read of a scan: who is where, and what is beside it.
struct ReadScan {
  LabelVolume map;
  ScanSlices slices;                     ///< none: no previews are wanted
  std::unique_ptr<BorderValues> values;  ///< null: not by a window
};

/// Prints what a window came to. @param notes  get what is odd and no mistake
ReadScan readScan(const ImportOptions& options, Stages& stages, std::vector<std::string>& notes);

/// Surfaces: where values cross the window, where there is one.
SurfaceNet netOf(const ReadScan& read, const WindowOptions& window);

}  // namespace viscera::cli
