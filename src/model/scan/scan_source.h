// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "model/scan/volume.h"

namespace viscera {

/// What the file does not say, and which of its content to read (docs/scans.md).
struct ScanOptions {
  int volume = -1;        ///< index of the volume in a file with several, 0 .. ; -1: it must have one
  std::string axes;       ///< directions of i, j, k, such as LPS or RAS, where the file does not give them
  std::string transform;  ///< sform or qform, where a NIfTI file has two that differ
  /// Series in a folder of DICOM files: its number, 0 .. , or its UID; all: one volume of all of them.
  std::string series;
  bool fill_slices = false;                    ///< DICOM: missing slices are copies of the nearest, with a note
  bool guesses = false;                        ///< for a listing: missing information is guessed, with a note
  std::vector<std::string>* notes = nullptr;   ///< gets oddities that are no errors
  std::function<void(double share)> progress;  ///< receives the share of the volume that has been read, slice by slice
};

/// Label with its layer: labels of several layers may overlap.
struct Segment {
  int layer = 0;
  LabelName label;
};

class ScanSource : public SliceSource {
 public:
  virtual int layers() const { return 1; }  ///< layers of overlapping labels; ScanOptions::volume chooses one
  virtual const std::vector<Segment>& segments() const = 0;  ///< of all layers
};

/// Opens a scan: NIfTI, NRRD, MHD and MHA by the name's ending, a folder or a .dcm file as DICOM. Reads only the header
/// before the first slice.
/// @throws SceneError  names the file, what is wrong and what is accepted
std::unique_ptr<ScanSource> openScan(const std::string& path, const ScanOptions& options = {});

std::unique_ptr<ScanSource> openNifti(const std::string& path, const ScanOptions& options);
std::unique_ptr<ScanSource> openNrrd(const std::string& path, const ScanOptions& options);
std::unique_ptr<ScanSource> openMetaImage(const std::string& path, const ScanOptions& options);

}  // namespace viscera
