// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/scan/scan_source.h"

namespace viscera {

/// DICOM is read by the program viscera-dicom (src/cli/dicom), a child process: what its libraries do with spoilt
/// files ends with it. It may have so much memory, and be silent for so long.
struct DicomLimits {
  uint64_t bytes = uint64_t{2} << 30;
  int silence_s = 60;
};

struct DicomSeries {
  std::string uid, modality, description;
  int files = 0;
};

/// Whether a file is one of DICOM, whatever its name.
bool isDicomFile(const std::string& path);

/// The series of a folder, or of one file, in order of their UIDs.
/// @throws SceneError  no DICOM file is there, or viscera-dicom is missing
std::vector<DicomSeries> listDicom(const std::string& path, const DicomLimits& limits = {});
std::unique_ptr<ScanSource> openDicom(const std::string& path, const ScanOptions& options,
                                      const DicomLimits& limits = {});

}  // namespace viscera
