// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/dicom/frames.h"

#include <gdcmReader.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "cli/dicom/tags.h"

namespace viscera::dicom {
namespace {

namespace fs = std::filesystem;
using gdcm::Tag;
using Kept = std::vector<gdcm::SmartPointer<gdcm::SequenceOfItems>>;

constexpr size_t kMostFiles = 20000;
constexpr double kSamePlaceMm = 0.01;                   ///< nearer slices are one place twice
constexpr double kUnevenMm = 0.1, kUnevenShare = 0.02;  ///< how far a slice may be from its place
constexpr double kSameDirection = 1e-4, kSameSpacingMm = 1e-3;
const char kSegmentation[] = "1.2.840.10008.5.1.4.1.1.66.4";

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.2f", value);
  return buffer;
}

/// The header, up to the pixels. @returns false: no DICOM file
bool readHead(gdcm::Reader& reader, const std::string& file) {
  reader.SetFileName(file.c_str());
  return reader.CanRead() && reader.ReadUpToTag(Tag(0x7fe0, 0x0010), {Tag(0x7fe0, 0x0010)});
}

/// The first of groups that has an element of a macro's only item.
const gdcm::DataSet* macro(const std::vector<const gdcm::DataSet*>& groups, Tag tag, Kept& kept) {
  for (const gdcm::DataSet* group : groups) {
    const auto items = itemsOf(*group, tag, kept);
    if (!items.empty()) return items[0];
  }
  return nullptr;
}

void place(Frame& frame, const gdcm::DataSet& position, const gdcm::DataSet& orientation,
           const gdcm::DataSet& measures) {
  const auto p = numbersOf(position, Tag(0x0020, 0x0032)), o = numbersOf(orientation, Tag(0x0020, 0x0037)),
             s = numbersOf(measures, Tag(0x0028, 0x0030)), t = numbersOf(measures, Tag(0x0018, 0x0050)),
             b = numbersOf(measures, Tag(0x0018, 0x0088));
  if (p.size() != 3 || o.size() != 6 || s.size() != 2)
    throw SceneError(frame.file +
                     ": does not say where its slices are; accepted: ImagePositionPatient, ImageOrientationPatient and "
                     "PixelSpacing");
  frame.position = Vector3d(p[0], p[1], p[2]);
  frame.along_row = Vector3d(o[0], o[1], o[2]);
  frame.down_column = Vector3d(o[3], o[4], o[5]);
  frame.between_rows = s[0];
  frame.between_columns = s[1];
  frame.thickness = b.size() == 1 ? std::abs(b[0]) : t.size() == 1 ? t[0] : 0;
  if (!(std::abs(frame.normal().norm() - 1) < 1e-2))
    throw SceneError(
        frame.file +
        ": its rows and columns are not perpendicular unit vectors; accepted: ImageOrientationPatient of such");
}

}  // namespace

std::vector<Series> seriesOf(const std::string& path) {
  std::vector<std::string> files;
  if (fs::is_directory(path))
    for (const auto& entry : fs::directory_iterator(path)) {
      if (entry.is_regular_file()) files.push_back(entry.path().string());
      if (files.size() > kMostFiles) throw SceneError(path + ": too many files; accepted: at most 20000");
    }
  else
    files.push_back(path);
  std::sort(files.begin(), files.end());
  std::map<std::string, Series> all;
  for (const std::string& file : files) {
    gdcm::Reader reader;
    if (!readHead(reader, file)) continue;
    const gdcm::DataSet& data = reader.GetFile().GetDataSet();
    std::string uid = textOf(data, Tag(0x0020, 0x000e));
    if (uid.empty()) uid = "none";  // as who makes files nameless leaves it
    if (uid.find(' ') != std::string::npos || shortOf(data, Tag(0x0028, 0x0010)) == 0) continue;
    Series& series = all[uid];
    series.uid = uid;
    series.modality = textOf(data, Tag(0x0008, 0x0060)).substr(0, 16);
    if (series.modality.empty() || series.modality.find(' ') != std::string::npos) series.modality = "?";
    series.description = textOf(data, Tag(0x0008, 0x103e)).substr(0, 64);
    series.files.push_back(file);
  }
  if (all.empty()) throw SceneError(path + ": no DICOM file with pictures; accepted: files of DICOM part 10");
  std::vector<Series> list;
  for (auto& [uid, series] : all) list.push_back(std::move(series));
  return list;
}

bool isSegmentation(const std::string& file) {
  gdcm::Reader reader;
  return readHead(reader, file) && textOf(reader.GetFile().GetDataSet(), Tag(0x0008, 0x0016)) == kSegmentation;
}

std::vector<Frame> framesOf(const std::string& file) {
  gdcm::Reader reader;
  if (!readHead(reader, file)) throw SceneError(file + ": no DICOM file");
  const gdcm::DataSet& data = reader.GetFile().GetDataSet();
  Kept kept;
  Frame frame;
  frame.file = file;
  frame.rows = shortOf(data, Tag(0x0028, 0x0010));
  frame.columns = shortOf(data, Tag(0x0028, 0x0011));
  const auto shared = itemsOf(data, Tag(0x5200, 0x9229), kept), each = itemsOf(data, Tag(0x5200, 0x9230), kept);
  const auto count = numbersOf(data, Tag(0x0028, 0x0008));
  if (each.empty()) {
    if (!count.empty() && count[0] != 1)
      throw SceneError(file + ": several frames without a place of each; accepted: functional groups per frame");
    place(frame, data, data, data);
    return {frame};
  }
  if (count.size() != 1 || count[0] != static_cast<double>(each.size()))
    throw SceneError(file + ": NumberOfFrames is not the number of places of frames, " + std::to_string(each.size()));
  std::vector<Frame> frames;
  for (const gdcm::DataSet* group : each) {
    std::vector<const gdcm::DataSet*> groups = {group};
    groups.insert(groups.end(), shared.begin(), shared.end());
    static const gdcm::DataSet kNothing;
    const auto found = [&](Tag tag) {
      const gdcm::DataSet* item = macro(groups, tag, kept);
      return item ? item : &kNothing;
    };
    frame.index = static_cast<unsigned>(frames.size());
    place(frame, *found(Tag(0x0020, 0x9113)), *found(Tag(0x0020, 0x9116)), *found(Tag(0x0028, 0x9110)));
    frame.segment = shortOf(*found(Tag(0x0062, 0x000a)), Tag(0x0062, 0x000b));
    const gdcm::DataSet& rescale = *found(Tag(0x0028, 0x9145));
    frame.rescale = textOf(rescale, Tag(0x0028, 0x1053)) + " " + textOf(rescale, Tag(0x0028, 0x1052));
    frames.push_back(frame);
  }
  return frames;
}

Vector3d stepOf(const std::vector<Frame>& frames, bool gaps) {
  const Frame &first = frames.front(), &last = frames.back();
  const size_t count = frames.size();
  if (count == 1) {
    if (!(first.thickness > 0))
      throw SceneError(first.file + ": one slice that does not say how thick it is; accepted: SliceThickness");
    return first.normal() * first.thickness;
  }
  std::vector<double> steps;
  for (size_t n = 1; n < count; ++n) {
    steps.push_back(frames[n].height() - frames[n - 1].height());
    if (steps.back() < kSamePlaceMm)
      throw SceneError(frames[n].file + ": a slice is there twice, at " + text(frames[n].height()) +
                       " mm along the normal (and in " + frames[n - 1].file + "); accepted: one slice a place");
  }
  std::vector<double> sorted = steps;
  std::sort(sorted.begin(), sorted.end());
  double slices = static_cast<double>(count - 1);
  if (gaps) slices = std::round((last.height() - first.height()) / (first.thickness > 0 ? first.thickness : sorted[0]));
  if (slices < 1 || slices > 65534)
    throw SceneError(first.file + ": its slices are not on a grid; accepted: even steps");
  const Vector3d step = (last.position - first.position) / slices;
  const double usual = gaps ? first.normal().dot(step) : sorted[sorted.size() / 2],
               most = std::max(kUnevenMm, kUnevenShare * usual);
  for (size_t n = 1; n < count && !gaps; ++n) {
    const double times = std::round(steps[n - 1] / usual);
    if (times > 1.5 && std::abs(steps[n - 1] - times * usual) <= most)
      throw SceneError(frames[n].file + ": slices are missing, " + std::to_string(static_cast<int>(times) - 1) +
                       ", between " + text(frames[n - 1].height()) + " and " + text(frames[n].height()) +
                       " mm along the normal; accepted: steps of " + text(usual) + " mm");
  }
  for (size_t n = 1; n < count; ++n) {
    const double at = gaps ? std::round((frames[n].height() - first.height()) / usual) : static_cast<double>(n);
    if ((gaps || std::abs(steps[n - 1] - usual) <= most) &&
        (first.position + at * step - frames[n].position).norm() <= most)
      continue;
    throw SceneError(frames[n].file + ": uneven slices: the one at " + text(frames[n].height()) +
                     " mm along the normal is not " + text(usual) +
                     " mm from that before; accepted: steps that are equal within 0.1 mm or 2 %");
  }
  return step;
}

Stack stackOf(std::vector<Frame>& frames) {
  const Frame& one = frames.front();
  for (const Frame& f : frames)
    if (f.rows != one.rows || f.columns != one.columns || (f.along_row - one.along_row).norm() > kSameDirection ||
        (f.down_column - one.down_column).norm() > kSameDirection ||
        std::abs(f.between_rows - one.between_rows) > kSameSpacingMm ||
        std::abs(f.between_columns - one.between_columns) > kSameSpacingMm)
      throw SceneError(f.file + ": a slice of another size, direction or spacing than in " + one.file +
                       "; accepted: slices of one volume");
  std::stable_sort(frames.begin(), frames.end(),
                   [](const Frame& a, const Frame& b) { return a.height() < b.height(); });
  Stack stack;
  stack.size[0] = frames.front().columns;
  stack.size[1] = frames.front().rows;
  stack.size[2] = static_cast<int>(frames.size());
  stack.axes << frames.front().along_row * frames.front().between_columns,
      frames.front().down_column * frames.front().between_rows, Vector3d::Zero();
  stack.origin = frames.front().position;
  return stack;
}

}  // namespace viscera::dicom
