// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/import/list_scan.h"

#include <cmath>
#include <filesystem>
#include <iostream>
#include <set>

#include "math/number_text.h"
#include "math/one_line.h"
#include "model/scan/dicom.h"
#include "model/scan/labels.h"
#include "model/scan/voxels.h"

namespace viscera::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kLargestLabel = 1 << 24;  ///< as in labels.h
constexpr size_t kMostListed = 255;        ///< most labels of a map

std::string formatOf(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return "DICOM, a folder";
  const std::string end = fs::path(path).extension().string();
  if (end == ".gz" || end == ".nii") return "NIfTI";
  if (end == ".mhd" || end == ".mha") return "MetaImage";
  if (end == ".nrrd" || end == ".nhdr") return "NRRD";
  return end == ".dcm" || isDicomFile(path) ? "DICOM" : "";
}

void printFrame(const VolumeFrame& frame) {
  Eigen::AlignedBox3d box;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d index(corner & 1 ? frame.size.x() - 0.5 : -0.5, corner & 2 ? frame.size.y() - 0.5 : -0.5,
                         corner & 4 ? frame.size.z() - 0.5 : -0.5);
    box.extend(frame.axes * index + frame.origin);
  }
  std::string axes;
  for (int a = 0; a < 3; ++a) {
    Eigen::Index most = 0;
    frame.axes.col(a).cwiseAbs().maxCoeff(&most);
    axes += frame.axes(most, a) > 0 ? "ALS"[most] : "PRI"[most];
  }
  std::cout << "size: " << frame.size.x() << " x " << frame.size.y() << " x " << frame.size.z() << " voxels\n"
            << "spacing: " << listText(frame.spacing_m(), 1000) << " mm\n"
            << "world: from " << listText(box.min()) << " to " << listText(box.max())
            << " m (x anterior, y left, z up); directions of i, j, k: " << axes << '\n';
}

void printLabels(const ImportOptions& options) {
  const LabelVolume map = readLabels(options.scan, options.labels);
  std::vector<size_t> voxels(map.names.size(), 0);
  for (const uint8_t label : map.labels) ++voxels[label];
  std::cout << "labels, if this is a label map (value, name, voxels):\n";
  for (size_t n = 1; n < map.names.size(); ++n) {
    const std::string& name = map.names[n].name;
    std::cout << "  " << map.names[n].value << ", " << (name.empty() ? "-" : oneLine(name)) << ", " << voxels[n]
              << '\n';
  }
}

}  // namespace

std::string listText(const Vector3d& v, double scale) {
  TextOut out;
  out.precision(6);
  out << v.x() * scale << ", " << v.y() * scale << ", " << v.z() * scale;
  return out.str();
}

int listScan(const ImportOptions& options) {
  if (!formatOf(options.scan).empty()) std::cout << "format: " << formatOf(options.scan) << '\n';
  if (formatOf(options.scan).rfind("DICOM", 0) == 0) {
    const std::vector<DicomSeries> all = listDicom(options.scan);
    for (size_t n = 0; n < all.size(); ++n) {
      std::cout << "series " << n << ": " << oneLine(all[n].modality) << ", " << oneLine(all[n].description) << ", "
                << all[n].files << " files, " << oneLine(all[n].uid) << '\n';
    }
    if (all.size() > 1 && options.labels.series.empty()) {
      std::cout << "choose a series with --series\n";
      return 0;
    }
  }
  const std::unique_ptr<ScanSource> source = openScan(options.scan, options.labels);
  const VolumeFrame frame = source->frame();
  printFrame(frame);
  double least = INFINITY, largest = -INFINITY;
  bool whole = true;
  std::set<float> met;
  std::vector<float> values;
  for (int k = 0; k < frame.size.z(); ++k) {
    source->next(values);
    for (const float value : values) {
      const float label = std::round(value);
      whole =
          whole && label >= 0 && label <= kLargestLabel && std::abs(value - label) <= kNearlyWhole;  // false for NaN
      if (std::isnan(value)) continue;
      least = std::min<double>(least, value);
      largest = std::max<double>(largest, value);
      if (whole && label > 0 && met.size() <= kMostListed) met.insert(label);
    }
  }
  std::cout << "values: " << (least > largest ? NAN : least) << " to " << (least > largest ? NAN : largest) << '\n';
  if (whole && !met.empty() && met.size() <= kMostListed) printLabels(options);
  return 0;
}

}  // namespace viscera::cli
