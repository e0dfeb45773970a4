// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scan/dicom.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "math/number_text.h"
#include "model/scan/child_process.h"
#include "model/scan/text_header.h"
#include "model/scan/voxels.h"
#include "model/scene/file_bounds.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

constexpr char kProgram[] = "viscera-dicom";
constexpr int kMostSegments = 65535, kMostSeries = 65535;

std::string program() {
  if (const char* given = std::getenv("VISCERA_DICOM")) return given;
  std::error_code error;
  const std::filesystem::path beside = std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / kProgram;
  return !error && std::filesystem::exists(beside, error) ? beside.string() : kProgram;
}

/// Returns a note on the slices, which src/cli/dicom writes ahead of them; empty: none.
std::string noteIn(const std::string& line) {
  return line.rfind("note ", 0) == 0 ? line.substr(5) : "";
}

std::unique_ptr<ChildProcess> start(std::vector<std::string> arguments, const DicomLimits& limits,
                                    const std::string& path) {
  requireWithinBounds(path);
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw SceneError(path + ": no such file or folder");
  arguments.insert(arguments.begin(), program());
  return std::make_unique<ChildProcess>(arguments, limits.bytes, limits.silence_s, path);
}

[[noreturn]] void misunderstood(const std::string& path) {
  throw SceneError(path + ": the version of viscera-dicom differs from that of this program; build both together");
}

/// Scan read from the output of src/cli/dicom: sizes, positions of voxels, segments; then float32 slices.
class DicomSlices : public ScanSource {
 public:
  DicomSlices(std::unique_ptr<ChildProcess> child, const std::string& path, int layer, std::vector<std::string>* notes)
      : child_(std::move(child)), path_(path) {
    std::string line = child_->line();
    for (std::string note = noteIn(line); !note.empty(); note = noteIn(line = child_->line()))
      if (notes) notes->push_back(note);
    TextIn first(line);
    std::string magic;
    std::array<int64_t, 3> size{};
    int segments = 0;
    first >> magic >> size[0] >> size[1] >> size[2] >> layers_ >> segments;
    if (!first || magic != "viscera-dicom-2" || layers_ < 1 || segments < 0 || segments > kMostSegments)
      misunderstood(path);
    const std::vector<std::string> numbers = words(child_->line());
    double value[12];
    if (numbers.size() != 12) misunderstood(path);
    for (size_t n = 0; n < 12; ++n)
      if (!parseNumber(numbers[n], value[n])) misunderstood(path);
    frame_ =
        frameFromLps(path, size, Eigen::Map<const Eigen::Matrix3d>(value), Vector3d(value[9], value[10], value[11]));
    for (int n = 0; n < segments; ++n) {
      TextIn line(child_->line());
      Segment segment;
      Vector3i color;  // bytes, or -1
      line >> segment.layer >> segment.label.value >> color[0] >> color[1] >> color[2];
      if (!line) misunderstood(path);
      if (color.minCoeff() >= 0) segment.label.color = (color.cast<double>() / 255).cwiseMin(1);
      std::getline(line, segment.label.name);
      segment.label.name = trimmed(segment.label.name);
      segments_.push_back(segment);
      if (segment.layer == layer) names_.push_back(segment.label);
    }
  }
  const VolumeFrame& frame() const override { return frame_; }
  const std::vector<LabelName>& names() const override { return names_; }
  const std::vector<Segment>& segments() const override { return segments_; }
  const std::string& file() const override { return path_; }
  int layers() const override { return layers_; }
  void next(std::vector<float>& values) override {
    if (slice_ >= frame_.size.z()) throw SceneError(path_ + ": no slice is left");
    values.resize(static_cast<size_t>(frame_.size.x()) * static_cast<size_t>(frame_.size.y()));
    child_->read(values.data(), values.size() * sizeof(float));
    if (++slice_ == frame_.size.z()) child_->finish();
  }

 private:
  std::unique_ptr<ChildProcess> child_;
  std::string path_;
  VolumeFrame frame_;
  std::vector<Segment> segments_;
  std::vector<LabelName> names_;
  int layers_ = 1, slice_ = 0;
};

}  // namespace

bool isDicomFile(const std::string& path) {
  constexpr int kMagicAt = 128;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  std::ifstream file(path, std::ios::binary);
  char magic[4] = {};
  file.seekg(kMagicAt);
  file.read(magic, sizeof magic);
  return file && std::string(magic, sizeof magic) == "DICM";
}

std::vector<DicomSeries> listDicom(const std::string& path, const DicomLimits& limits) {
  auto child = start({"list", path}, limits, path);
  int count = 0;
  if (!(TextIn(child->line()) >> count) || count < 0 || count > kMostSeries) misunderstood(path);
  std::vector<DicomSeries> all;
  for (int n = 0; n < count; ++n) {
    TextIn line(child->line());
    DicomSeries series;
    line >> series.uid >> series.modality >> series.files;
    if (!line) misunderstood(path);
    std::getline(line, series.description);
    series.description = trimmed(series.description);
    all.push_back(series);
  }
  child->finish();
  return all;
}

std::unique_ptr<ScanSource> openDicom(const std::string& path, const ScanOptions& options, const DicomLimits& limits) {
  if (!options.axes.empty()) throw SceneError(path + ": the axes of DICOM are always LPS; remove the key axes");
  const int layer = std::max(options.volume, 0);
  const std::string gaps = options.fill_slices ? "fill" : "refuse";
  return std::make_unique<DicomSlices>(start({"read", path, options.series, std::to_string(layer), gaps}, limits, path),
                                       path, layer, options.notes);
}

}  // namespace viscera
