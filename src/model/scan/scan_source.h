// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "model/scan/volume.h"

namespace viscera {

/// What the file cannot say, or what of it is wanted (docs/scans.md).
struct ScanOptions {
  int volume = -1;        ///< of a file with several: 0 .. ; -1: it must have one
  std::string axes;       ///< where i, j, k lead to, such as LPS or RAS, where the file does not say
  std::string transform;  ///< sform or qform, where a NIfTI file has two that differ
  std::string series;     ///< of a folder of DICOM files: its number, 0 .. , or its UID; all: one volume of all of them
  bool fill_slices = false;                    ///< of DICOM: missing slices are like the nearest, which is noted
  bool guesses = false;                        ///< for a listing: what the file leaves open is guessed, which is noted
  std::vector<std::string>* notes = nullptr;   ///< gets what is odd and no mistake
  std::function<void(double share)> progress;  ///< told how much of a volume has been read, slice by slice
};

/// A label with its layer: labels of several layers may overlap.
struct Segment {
  int layer = 0;
  LabelName label;
};

class ScanSource : public SliceSource {
 public:
  virtual int layers() const { return 1; }  ///< of labels that overlap; ScanOptions::volume chooses one
  virtual const std::vector<Segment>& segments() const = 0;  ///< of all layers
};

/// Reads NIfTI, NRRD, MHD and MHA by the name's ending, a folder or a .dcm file as DICOM. Nothing but the header is
/// read before the first slice.
/// @throws SceneError  naming the file, what is wrong and what is accepted
std::unique_ptr<ScanSource> openScan(const std::string& path, const ScanOptions& options = {});

std::unique_ptr<ScanSource> openNifti(const std::string& path, const ScanOptions& options);
std::unique_ptr<ScanSource> openNrrd(const std::string& path, const ScanOptions& options);
std::unique_ptr<ScanSource> openMetaImage(const std::string& path, const ScanOptions& options);

}  // namespace viscera
