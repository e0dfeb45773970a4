// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scan/scan_source.h"

#include <filesystem>

#include "model/scan/dicom.h"
#include "model/scan/text_header.h"
#include "model/scene/file_bounds.h"
#include "viscera/math/error.h"

namespace viscera {

std::unique_ptr<ScanSource> openScan(const std::string& path, const ScanOptions& options) {
  requireWithinBounds(path);
  const std::string name = lower(path);
  const auto ends = [&](const std::string& end) {
    return name.size() >= end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
  };
  if (ends(".nii") || ends(".nii.gz")) return openNifti(path, options);
  if (ends(".nrrd") || ends(".nhdr")) return openNrrd(path, options);
  if (ends(".mhd") || ends(".mha")) return openMetaImage(path, options);
  std::error_code error;
  if (ends(".dcm") || std::filesystem::is_directory(path, error)) return openDicom(path, options);
  throw SceneError(path + ": accepted: .nii, .nii.gz, .nrrd, .nhdr, .mhd, .mha, .dcm, or a folder of DICOM files");
}

}  // namespace viscera
