// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scan/scan_source.h"

#include <filesystem>

#include "model/scan/dicom.h"
#include "model/scan/text_header.h"
#include "model/scene/file_bounds.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

/// Wrapper that reports how far another source has been read.
class ObservedSource : public ScanSource {
 public:
  ObservedSource(std::unique_ptr<ScanSource> source, std::function<void(double)> progress)
      : source_(std::move(source)), progress_(std::move(progress)) {}
  const VolumeFrame& frame() const override { return source_->frame(); }
  const std::vector<LabelName>& names() const override { return source_->names(); }
  const std::string& file() const override { return source_->file(); }
  int layers() const override { return source_->layers(); }
  const std::vector<Segment>& segments() const override { return source_->segments(); }
  void next(std::vector<float>& values) override {
    source_->next(values);
    progress_(static_cast<double>(++read_) / frame().size.z());
  }

 private:
  std::unique_ptr<ScanSource> source_;
  std::function<void(double)> progress_;
  int read_ = 0;
};

std::unique_ptr<ScanSource> openByName(const std::string& path, const ScanOptions& options) {
  requireWithinBounds(path);
  const std::string name = lower(path);
  const auto ends = [&](const std::string& end) {
    return name.size() >= end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
  };
  if (ends(".nii") || ends(".nii.gz")) return openNifti(path, options);
  if (ends(".nrrd") || ends(".nhdr")) return openNrrd(path, options);
  if (ends(".mhd") || ends(".mha")) return openMetaImage(path, options);
  std::error_code error;
  if (ends(".dcm") || std::filesystem::is_directory(path, error) || isDicomFile(path)) return openDicom(path, options);
  if (ends(".hdr") || ends(".img"))
    throw SceneError(path + ": pairs of .hdr and .img are not read; accepted: one file, .nii or .nii.gz");
  throw SceneError(
      path + ": unknown format; accepted: .nii, .nii.gz, .nrrd, .nhdr, .mhd, .mha, .dcm, or a folder of DICOM files");
}

}  // namespace

std::unique_ptr<ScanSource> openScan(const std::string& path, const ScanOptions& options) {
  std::unique_ptr<ScanSource> source = openByName(path, options);
  return options.progress ? std::make_unique<ObservedSource>(std::move(source), options.progress) : std::move(source);
}

}  // namespace viscera
