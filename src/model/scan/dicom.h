// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/scan/scan_source.h"

namespace viscera {

/// Limits of the child process viscera-dicom (src/cli/dicom), which reads DICOM: if its libraries crash on corrupt
/// files, only the child ends. Its memory [bytes], and the time without output.
struct DicomLimits {
  uint64_t bytes = uint64_t{2} << 30;
  int silence_s = 60;
};

struct DicomSeries {
  std::string uid, modality, description;
  int files = 0;
};

/// Returns whether a file is DICOM, whatever its name.
bool isDicomFile(const std::string& path);

/// Returns the series of a folder, or of one file, in order of their UIDs.
/// @throws SceneError  no DICOM file is there, or viscera-dicom is missing
std::vector<DicomSeries> listDicom(const std::string& path, const DicomLimits& limits = {});
std::unique_ptr<ScanSource> openDicom(const std::string& path, const ScanOptions& options,
                                      const DicomLimits& limits = {});

}  // namespace viscera
