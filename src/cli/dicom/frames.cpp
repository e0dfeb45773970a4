// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/dicom/frames.h"

#include <gdcmReader.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>

#include "cli/dicom/tags.h"

namespace viscera::dicom {
namespace {

namespace fs = std::filesystem;
using gdcm::Tag;
using Kept = std::vector<gdcm::SmartPointer<gdcm::SequenceOfItems>>;

constexpr size_t kMostFiles = 20000;
constexpr double kMostSlices = 65534;
constexpr double kSamePositionMm = 0.01;                ///< closer slices are duplicates
constexpr double kUnevenMm = 0.1, kUnevenShare = 0.02;  ///< largest deviation of a slice from its position
constexpr double kSameDirection = 1e-4, kSameSpacingMm = 1e-3;
const char kSegmentation[] = "1.2.840.10008.5.1.4.1.1.66.4";

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.2f", value);
  return buffer;
}

/// Reads a file up to its pixels. @returns false: not a DICOM file
bool readHead(gdcm::Reader& reader, const std::string& file) {
  nowReading(file);
  reader.SetFileName(file.c_str());
  return reader.CanRead() && reader.ReadUpToTag(Tag(0x7fe0, 0x0010), {Tag(0x7fe0, 0x0010)});
}

/// Returns the only item of a macro in the first group that has it.
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
    throw SceneError(
        frame.file +
        ": does not state the positions of its slices; it needs ImagePositionPatient, ImageOrientationPatient and "
        "PixelSpacing");
  frame.position = Vector3d(p[0], p[1], p[2]);
  frame.along_row = Vector3d(o[0], o[1], o[2]);
  frame.down_column = Vector3d(o[3], o[4], o[5]);
  frame.between_rows = s[0];
  frame.between_columns = s[1];
  if (b.size() == 1) frame.between = std::abs(b[0]);
  if (t.size() == 1) frame.thickness = t[0];
  if (!(std::abs(frame.normal().norm() - 1) < 1e-2))
    throw SceneError(
        frame.file +
        ": its rows and columns are not perpendicular unit vectors; ImageOrientationPatient must hold such vectors");
}

bool beginsAsDicom(const std::string& file, std::string& head) {
  constexpr size_t kMagicAt = 128, kHead = 1024;
  head.assign(kHead, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), kHead);
  head.resize(static_cast<size_t>(stream.gcount()));
  return head.compare(std::min(kMagicAt, head.size()), 4, "DICM") == 0;
}

/// Returns the first few folders below that contain DICOM files.
std::vector<std::string> foldersBelow(const std::string& path) {
  constexpr int kMostEntries = 5000;
  constexpr size_t kMostFolders = 3;
  std::vector<std::string> found;
  std::error_code error;
  int entries = 0;
  for (fs::recursive_directory_iterator at(path, error), end; at != end && !error; at.increment(error)) {
    if (++entries > kMostEntries || found.size() == kMostFolders) break;
    const std::string folder = at->path().parent_path().string();
    std::string head;
    if (!at->is_regular_file(error) || folder == path || (!found.empty() && found.back() == folder)) continue;
    if (beginsAsDicom(at->path().string(), head)) found.push_back(folder);
  }
  return found;
}

/// Throws an error that says why a folder or file has no readable series.
[[noreturn]] void refuseEmpty(const std::string& path, const std::vector<std::string>& files) {
  const std::string deflated = "1.2.840.10008.1.2.1.99", directory = "1.2.840.10008.1.3.10";
  std::string why, head;
  for (const std::string& file : files) {
    if (!beginsAsDicom(file, head)) continue;
    if (head.find(deflated) != std::string::npos)
      why = "; " + file + " is a deflated file, which is not read; convert it with dcmconv +te";
    else if (why.empty() && head.find(directory) != std::string::npos)
      why = "; " + file + " is the index of a medium; name the folder with the images";
  }
  if (fs::is_directory(path)) {
    const std::vector<std::string> below = foldersBelow(path);
    for (size_t n = 0; n < below.size(); ++n) why += (n == 0 ? "; subfolders are not read; name " : " or ") + below[n];
  }
  throw SceneError(path + ": no DICOM file with images" + (why.empty() ? "; accepted: files of DICOM part 10" : why));
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
    if (uid.empty()) uid = "none";  // files written without a UID
    if (uid.find(' ') != std::string::npos || shortOf(data, Tag(0x0028, 0x0010)) == 0) continue;
    Series& series = all[uid];
    series.uid = uid;
    series.modality = textOf(data, Tag(0x0008, 0x0060)).substr(0, 16);
    if (series.modality.empty() || series.modality.find(' ') != std::string::npos) series.modality = "?";
    series.description = textOf(data, Tag(0x0008, 0x103e)).substr(0, 64);
    series.files.push_back(file);
  }
  if (all.empty()) refuseEmpty(path, files);
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
  if (!readHead(reader, file)) throw SceneError(file + ": not a DICOM file");
  const gdcm::DataSet& data = reader.GetFile().GetDataSet();
  const std::string kind = textOf(data, Tag(0x0008, 0x0008));
  if (kind.find("MOSAIC") != std::string::npos)
    throw SceneError(file + ": is a mosaic of slices in one image (ImageType " + kind +
                     "), which is not read; accepted: one image per slice, or NIfTI, which dcm2niix makes from it");
  Kept kept;
  Frame frame;
  frame.file = file;
  frame.rows = shortOf(data, Tag(0x0028, 0x0010));
  frame.columns = shortOf(data, Tag(0x0028, 0x0011));
  const auto shared = itemsOf(data, Tag(0x5200, 0x9229), kept), each = itemsOf(data, Tag(0x5200, 0x9230), kept);
  const auto count = numbersOf(data, Tag(0x0028, 0x0008));
  if (each.empty()) {
    if (!count.empty() && count[0] != 1)
      throw SceneError(file + ": several frames without a position for each; accepted: per-frame functional groups");
    place(frame, data, data, data);
    return {frame};
  }
  if (count.size() != 1 || count[0] != static_cast<double>(each.size()))
    throw SceneError(file + ": NumberOfFrames differs from the number of frame positions, " +
                     std::to_string(each.size()));
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

namespace {

[[noreturn]] void refuseUneven(const Frame& frame, double usual) {
  throw SceneError(frame.file + ": uneven slices: the one at " + text(frame.height()) + " mm along the normal is not " +
                   text(usual) + " mm from the one before; accepted: steps that are equal within 0.1 mm or 2 %");
}

/// Returns the largest accepted deviation of a slice from its position.
double mostOff(double step) {
  return std::max(kUnevenMm, kUnevenShare * step);
}

/// Returns the step if every slice is a multiple of `height` above the previous one; nothing otherwise.
/// @param off  largest accepted deviation
std::optional<Vector3d> stepOfHeight(const std::vector<Frame>& frames, double height, double off) {
  std::vector<double> positions = {0};
  for (size_t n = 1; n < frames.size(); ++n) {
    const double step = frames[n].height() - frames[n - 1].height(), times = std::round(step / height);
    if (times < 1 || std::abs(step - times * height) > off) return {};
    positions.push_back(positions.back() + times);
  }
  const Vector3d step = (frames.back().position - frames.front().position) / positions.back();
  for (size_t n = 0; n < frames.size(); ++n)
    if ((frames.front().position + positions[n] * step - frames[n].position).norm() > off) return {};
  if (positions.back() > kMostSlices)
    throw SceneError(frames.front().file + ": its slices are not on a grid; accepted: even steps");
  return step;
}

/// Returns the largest step of which all distances between slices are multiples. If positions do not determine whether
/// planes between slices are empty or do not exist, the specified spacing decides.
Vector3d sparseStep(const std::vector<Frame>& frames, double least) {
  constexpr int kMostParts = 3;  // most fractions of the least step: more would fit anything
  if (const auto step = stepOfHeight(frames, least, mostOff(least))) return *step;
  const double said = frames.front().between;
  if (said > kSamePositionMm)
    if (const auto step = stepOfHeight(frames, said, mostOff(said))) return *step;
  for (int parts = 2; parts <= kMostParts; ++parts)
    if (const auto step = stepOfHeight(frames, least / parts, kUnevenShare * least / parts)) return *step;
  for (size_t n = 1; n < frames.size(); ++n) {
    const double step = frames[n].height() - frames[n - 1].height();
    if (std::abs(step - std::round(step / least) * least) > mostOff(least)) refuseUneven(frames[n], least);
  }
  refuseUneven(frames.back(), least);
}

Vector3d evenStep(const std::vector<Frame>& frames, const std::vector<double>& steps) {
  const Frame &first = frames.front(), &last = frames.back();
  std::vector<double> sorted = steps;
  std::sort(sorted.begin(), sorted.end());
  const Vector3d step = (last.position - first.position) / static_cast<double>(steps.size());
  const double usual = sorted[sorted.size() / 2], most = mostOff(usual);
  for (size_t n = 1; n < frames.size(); ++n) {
    const double times = std::round(steps[n - 1] / usual);
    if (times > 1.5 && std::abs(steps[n - 1] - times * usual) <= most)
      throw SceneError(frames[n].file + ": slices are missing, " + std::to_string(static_cast<int>(times) - 1) +
                       ", between " + text(frames[n - 1].height()) + " and " + text(frames[n].height()) +
                       " mm along the normal; accepted: steps of " + text(usual) +
                       " mm, or --fill-slices, which repeats the nearest slice");
  }
  for (size_t n = 1; n < frames.size(); ++n)
    if (std::abs(steps[n - 1] - usual) > most ||
        (first.position + static_cast<double>(n) * step - frames[n].position).norm() > most)
      refuseUneven(frames[n], usual);
  return step;
}

}  // namespace

Vector3d stepOf(const std::vector<Frame>& frames, bool gaps) {
  const Frame& first = frames.front();
  if (frames.size() == 1) {
    const double height = first.between > 0 ? first.between : first.thickness;
    if (!(height > 0)) throw SceneError(first.file + ": a single slice without a thickness; it needs SliceThickness");
    return first.normal() * height;
  }
  std::vector<double> steps;
  for (size_t n = 1; n < frames.size(); ++n) {
    steps.push_back(frames[n].height() - frames[n - 1].height());
    if (steps.back() < kSamePositionMm)
      throw SceneError(frames[n].file + ": two slices have the same position, " + text(frames[n].height()) +
                       " mm along the normal (the other is in " + frames[n - 1].file +
                       "); accepted: one slice per position. Remove one of them from the folder");
  }
  return gaps ? sparseStep(frames, *std::min_element(steps.begin(), steps.end())) : evenStep(frames, steps);
}

std::vector<int> slicesOf(const std::vector<Frame>& frames, const Vector3d& step) {
  const double height = frames.front().normal().dot(step);
  std::vector<int> slices;
  for (const Frame& frame : frames)
    slices.push_back(static_cast<int>(std::lround((frame.height() - frames.front().height()) / height)));
  return slices;
}

Stack stackOf(std::vector<Frame>& frames) {
  const Frame& one = frames.front();
  for (const Frame& f : frames)
    if (f.rows != one.rows || f.columns != one.columns || (f.along_row - one.along_row).norm() > kSameDirection ||
        (f.down_column - one.down_column).norm() > kSameDirection ||
        std::abs(f.between_rows - one.between_rows) > kSameSpacingMm ||
        std::abs(f.between_columns - one.between_columns) > kSameSpacingMm)
      throw SceneError(f.file + ": a slice with another size, direction or spacing than in " + one.file +
                       "; accepted: slices of one volume. Remove it from the folder");
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
