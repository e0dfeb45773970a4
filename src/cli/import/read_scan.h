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

/// The data read from a scan: labels, slices and values.
struct ReadScan {
  LabelVolume map;
  ScanSlices slices;                     ///< slices for previews; empty: no previews
  std::unique_ptr<BorderValues> values;  ///< values for a window; null: no window
};

/// Reads a scan and prints the result of a window. @param notes  receives what is unusual but not an error
ReadScan readScan(const ImportOptions& options, Stages& stages, std::vector<std::string>& notes);

/// Returns the surfaces. With a window, they are where values cross it.
SurfaceNet netOf(const ReadScan& read, const WindowOptions& window);

}  // namespace viscera::cli
