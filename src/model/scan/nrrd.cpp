// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "model/scan/text_header.h"
#include "model/scan/voxels.h"
#include "viscera/math/error.h"

// NRRD, and the keys in which 3D Slicer stores segments (.seg.nrrd).
namespace viscera {
namespace {

struct NrrdHeader : TextHeader {
  std::map<std::string, std::string> keys;  ///< key := value, as in the file
  uint64_t end = 0;                         ///< offset of data in the same file
};

NrrdHeader readNrrdHeader(const std::string& path) {
  NrrdHeader header;
  header.path = path;
  ByteStream stream(path, 0, false);
  uint64_t left = kMostHeaderBytes;
  const std::string magic = headerLine(stream, left);
  if (magic.size() != 8 || magic.compare(0, 7, "NRRD000") != 0 || magic[7] < '1' || magic[7] > '5')
    throw SceneError(path + ": not a NRRD file; accepted: a file that begins with NRRD0001 .. NRRD0005");
  uint64_t done = magic.size() + 1;
  const uint64_t held = fileBytes(path);
  while (done < held) {  // the header of a detached data file may end with the file
    const uint64_t before = left;
    const std::string line = headerLine(stream, left);
    done += before - left;
    if (line.empty()) break;
    if (line[0] == '#') continue;
    const size_t key = line.find(":="), field = line.find(": ");
    if (key != std::string::npos && (field == std::string::npos || key < field))
      header.keys[line.substr(0, key)] = line.substr(key + 2);
    else if (line.find(':') != std::string::npos)
      header.fields[lower(line.substr(0, line.find(':')))] = trimmed(line.substr(line.find(':') + 1));
    else if (header.textOr("data file", header.textOr("datafile", "")).rfind("LIST", 0) == 0)
      break;  // file names follow, to the end
    else
      throw SceneError(path + ": a line of its header is neither 'field: value' nor 'key:=value'");
  }
  header.end = kMostHeaderBytes - left;
  for (const auto& [other, name] :
       {std::pair("datafile", "data file"), {"byteskip", "byte skip"}, {"lineskip", "line skip"}})
    if (header.has(other)) header.fields[name] = header.text(other);
  return header;
}

VoxelType nrrdVoxelType(const TextHeader& header) {
  static const std::map<std::string, VoxelType> kTypes = {{"signed char", VoxelType::kInt8},
                                                          {"int8", VoxelType::kInt8},
                                                          {"int8_t", VoxelType::kInt8},
                                                          {"uchar", VoxelType::kUint8},
                                                          {"unsigned char", VoxelType::kUint8},
                                                          {"uint8", VoxelType::kUint8},
                                                          {"uint8_t", VoxelType::kUint8},
                                                          {"short", VoxelType::kInt16},
                                                          {"short int", VoxelType::kInt16},
                                                          {"signed short", VoxelType::kInt16},
                                                          {"signed short int", VoxelType::kInt16},
                                                          {"int16", VoxelType::kInt16},
                                                          {"int16_t", VoxelType::kInt16},
                                                          {"ushort", VoxelType::kUint16},
                                                          {"unsigned short", VoxelType::kUint16},
                                                          {"unsigned short int", VoxelType::kUint16},
                                                          {"uint16", VoxelType::kUint16},
                                                          {"uint16_t", VoxelType::kUint16},
                                                          {"int", VoxelType::kInt32},
                                                          {"signed int", VoxelType::kInt32},
                                                          {"int32", VoxelType::kInt32},
                                                          {"int32_t", VoxelType::kInt32},
                                                          {"uint", VoxelType::kUint32},
                                                          {"unsigned int", VoxelType::kUint32},
                                                          {"uint32", VoxelType::kUint32},
                                                          {"uint32_t", VoxelType::kUint32},
                                                          {"longlong", VoxelType::kInt64},
                                                          {"long long", VoxelType::kInt64},
                                                          {"int64", VoxelType::kInt64},
                                                          {"int64_t", VoxelType::kInt64},
                                                          {"ulonglong", VoxelType::kUint64},
                                                          {"unsigned long long", VoxelType::kUint64},
                                                          {"uint64", VoxelType::kUint64},
                                                          {"uint64_t", VoxelType::kUint64},
                                                          {"float", VoxelType::kFloat},
                                                          {"double", VoxelType::kDouble}};
  const auto found = kTypes.find(lower(header.text("type")));
  if (found == kTypes.end()) header.refuse("type", "whole numbers of 8 to 64 bits, float, double");
  return found->second;
}

constexpr int kNone = -1;

/// Returns the axis of volumes or layers for a header with four axes: the first or the last; kNone for three.
int listAxis(const TextHeader& header, size_t dims, const std::vector<std::string>& directions,
             const std::vector<std::string>& kinds) {
  int list = kNone;
  for (size_t axis = 0; axis < dims; ++axis) {
    const std::string kind = kinds.empty() ? "domain" : lower(kinds[axis]);
    const bool in_space = kind == "domain" || kind == "space" || kind == "none" || kind == "???";
    if (!in_space && kind != "list" && kind != "time")
      header.refuse("kinds", "domain, space, list, time: one number per voxel");
    const bool none = !directions.empty() && directions[axis] == "none";
    if (none || !in_space) list = list == kNone ? static_cast<int>(axis) : 99;
  }
  if (dims == 4 && list == kNone && directions.empty()) list = 3;
  if ((dims == 4 && list != 0 && list != 3) || (dims == 3 && list != kNone))
    header.refuse("dimension", "3 axes in space, and one more axis, the first or the last");
  return list;
}

std::vector<std::string> vectorsOf(const TextHeader& header, const std::string& name, size_t count) {
  std::vector<std::string> all;  // "(1,0,0) none (0, 1, 0)": blanks within brackets do not separate
  std::string one;
  int depth = 0;
  for (const char c : header.text(name) + " ") {
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    const bool blank = c == ' ' || c == '\t';
    if (!blank) one += c;
    if (depth == 0 && (blank || c == ')') && !one.empty()) all.push_back(std::exchange(one, ""));
  }
  if (all.size() != count || !one.empty()) header.refuse(name, std::to_string(count) + " items, each (x,y,z) or none");
  return all;
}

Vector3d vectorOf(const TextHeader& header, const std::string& name, const std::string& text) {
  Vector3d vector;
  size_t at = 1;
  for (int c = 0; c < 3; ++c) {
    const size_t end = text.find(c < 2 ? ',' : ')', at);
    if (text.empty() || text[0] != '(' || end == std::string::npos ||
        !parseNumber(text.substr(at, end - at), vector[c]))
      header.refuse(name, "three numbers, (x,y,z)");
    at = end + 1;
  }
  return vector;
}

/// Returns signs that turn a named space into LPS; false: the name does not determine left and right.
bool lpsOfSpace(const std::string& name, Vector3d& signs) {
  static const std::map<std::string, Vector3d> kSpaces = {
      {"right-anterior-superior", {-1, -1, 1}}, {"ras", {-1, -1, 1}},
      {"left-anterior-superior", {1, -1, 1}},   {"las", {1, -1, 1}},
      {"left-posterior-superior", {1, 1, 1}},   {"lps", {1, 1, 1}}};
  const auto found = kSpaces.find(lower(name));
  if (found != kSpaces.end()) signs = found->second;
  return found != kSpaces.end();
}

void requireMillimetres(const TextHeader& header, const std::string& name, size_t count) {
  if (!header.has(name)) return;
  std::string text = header.text(name);  // "mm" "mm" "mm"; axes that are not spatial have ""
  size_t units = 0;
  for (size_t at = text.find('"'); at != std::string::npos; at = text.find('"', at + 1)) {
    const size_t end = text.find('"', at + 1);
    const std::string unit = end == std::string::npos ? "?" : text.substr(at + 1, end - at - 1);
    if (unit != "mm" && unit != "" && unit != "???") header.refuse(name, "\"mm\" for each axis");
    ++units;
    at = end;
  }
  if (units > count) header.refuse(name, "\"mm\" for each axis");
}

VolumeFrame frameOf(const NrrdHeader& header, const std::array<int64_t, 3>& size, int list, size_t dims,
                    const std::vector<std::string>& directions, const ScanOptions& options) {
  const std::string& given = options.axes;
  requireMillimetres(header, "space units", 3);
  if (directions.empty()) requireMillimetres(header, "units", dims);
  Vector3d signs(1, 1, 1);
  const bool said = !directions.empty() && header.has("space") && lpsOfSpace(header.text("space"), signs);
  const bool guessed =
      !said && given.empty() && isGuessed(header.path, options, "does not state its orientation; axes LPS are a guess");
  if (!said && given.empty() && !guessed)
    throw SceneError(
        header.path + ": does not state its orientation (space '" + header.textOr("space", "") + "'" +
        (directions.empty() ? ", no space directions" : "") +
        "); accepted: a space of RAS, LAS or LPS with space directions. Otherwise set axes, such as axes: RAS");
  if (said && !given.empty()) throw SceneError(header.path + ": the file states its orientation; remove the key axes");
  const Eigen::Matrix3d to_lps =
      said ? Eigen::Matrix3d(signs.asDiagonal()) : lpsFromAxes(header.path, guessed ? "LPS" : given);
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Vector3d origin = Vector3d::Zero();
  std::vector<double> spacings;
  if (directions.empty()) spacings = header.numbers("spacings", dims);
  for (int axis = 0, n = 0; axis < static_cast<int>(dims); ++axis) {
    if (axis == list) continue;
    const auto at = static_cast<size_t>(axis);
    if (directions.empty()) requireSpacing(header.path, "spacings", spacings[at]);
    if (directions.empty())
      axes.col(n) *= spacings[at];
    else
      axes.col(n) = vectorOf(header, "space directions", directions[at]);
    ++n;
  }
  if (header.has("space origin")) origin = vectorOf(header, "space origin", vectorsOf(header, "space origin", 1)[0]);
  return frameFromLps(header.path, size, to_lps * axes, to_lps * origin);
}

/// Returns the colour "red green blue", 0..1; none: another text.
std::optional<Vector3d> colorOf(const std::string& text) {
  const std::vector<std::string> numbers = words(text);
  Vector3d color = Vector3d::Zero();
  bool good = numbers.size() == 3;
  for (size_t c = 0; good && c < 3; ++c) good = parseNumber(numbers[c], color[static_cast<Eigen::Index>(c)]);
  if (!good || (color.array() < 0).any() || (color.array() > 1).any()) return {};
  return color;
}

/// Returns the segments, from keys such as Segment0_LabelValue:=1. Without values: 0, 1, ... have a layer each in files
/// before Slicer 4.11; in one layer they are 1, 2, ...
std::vector<Segment> segmentsOf(const NrrdHeader& header, int64_t layers) {
  std::vector<Segment> segments;
  for (int n = 0;; ++n) {
    const std::string prefix = "Segment" + std::to_string(n) + "_";
    const auto key = [&](const char* name) {
      const auto found = header.keys.find(prefix + name);
      return found == header.keys.end() ? std::string() : trimmed(found->second);
    };
    if (key("ID").empty() && key("Name").empty() && key("LabelValue").empty()) return segments;
    Segment segment{
        n, {layers > 1 ? 1 : n + 1, key("Name"), colorOf(key("Color"))}};  // each has a layer, or all share one
    int64_t layer = n;
    const bool value = key("LabelValue").empty() || parseInteger(key("LabelValue"), segment.label.value);
    if (!value || (!key("Layer").empty() && !parseInteger(key("Layer"), layer)) || layer < 0 || layer > 65535)
      throw SceneError(header.path + ": " + prefix + "LabelValue, " + prefix +
                       "Layer: not a whole number; accepted: whole numbers, and for the layer 0 .. 65535");
    segment.layer = static_cast<int>(layer);
    segments.push_back(segment);
  }
}

constexpr int64_t kMostLines = 1000000;

/// Returns the offset after a number of text lines that precede the data. @throws SceneError  the file ends before
uint64_t afterLines(const std::string& file, uint64_t offset, int64_t lines) {
  ByteStream stream(file, offset, false);
  for (char c = 0; lines > 0; lines -= c == '\n') {
    stream.read(&c, 1);
    ++offset;
  }
  return offset;
}

std::unique_ptr<ByteStream> dataOf(const NrrdHeader& header, uint64_t bytes) {
  const std::string encoding = lower(header.text("encoding"));
  const bool packed = encoding == "gzip" || encoding == "gz";
  if (!packed && encoding != "raw") header.refuse("encoding", "raw or gzip");
  const std::string name = header.textOr("data file", "");
  if (header.has("data file") &&
      (words(name).empty() || words(name)[0] == "LIST" || name.find('%') != std::string::npos))
    header.refuse("data file", "the name of one file; lists of slices are not read");
  const std::string file = header.has("data file") ? dataFileBeside(header.path, name, "data file") : header.path;
  const int64_t lines = header.has("line skip") ? header.integers("line skip", 1)[0] : 0;
  if (lines < 0 || lines > kMostLines) header.refuse("line skip", "0 .. 1000000");
  const int64_t skip = header.has("byte skip") ? header.integers("byte skip", 1)[0] : 0;
  if (skip < -1 || (packed && skip < 0))
    header.refuse("byte skip", "0 or more, or -1: raw data at the end of the file");
  uint64_t offset = afterLines(file, file == header.path ? header.end : 0, lines);
  const uint64_t held = fileBytes(file);
  if (skip < 0) {
    if (held < offset + bytes)
      throw SceneError(file + ": ends early: its header asks for " + std::to_string(bytes) + " bytes");
    return std::make_unique<ByteStream>(file, held - bytes, false);
  }
  if (!packed) {  // in 64 bits: the skip is at most 2^63 - 1
    offset += static_cast<uint64_t>(skip);
    return std::make_unique<ByteStream>(file, offset, false);
  }
  auto stream = std::make_unique<ByteStream>(file, offset, true);
  stream->requireHolds(static_cast<uint64_t>(skip));
  stream->skip(static_cast<uint64_t>(skip));
  return stream;
}

}  // namespace

std::unique_ptr<ScanSource> openNrrd(const std::string& path, const ScanOptions& options) {
  const NrrdHeader header = readNrrdHeader(path);
  const int64_t dims = header.integers("dimension", 1)[0];
  if (dims != 3 && dims != 4) header.refuse("dimension", "3, or 4: several volumes");
  const auto axes = static_cast<size_t>(dims);
  const std::vector<int64_t> sizes = header.integers("sizes", axes);
  std::vector<std::string> directions, kinds;
  if (header.has("space directions")) directions = vectorsOf(header, "space directions", axes);
  if (header.has("kinds")) kinds = words(header.text("kinds"));
  if (!kinds.empty() && kinds.size() != axes) header.refuse("kinds", "one per axis");
  const int list = listAxis(header, axes, directions, kinds);
  std::array<int64_t, 3> size{};
  for (int axis = 0, n = 0; axis < static_cast<int>(dims); ++axis)
    if (axis != list) size.at(static_cast<size_t>(n++)) = sizes[static_cast<size_t>(axis)];
  VoxelLayout layout;
  layout.type = nrrdVoxelType(header);
  layout.frame = frameOf(header, size, list, axes, directions, options);
  if (bytesOf(layout.type) > 1) {
    const std::string endian = lower(header.text("endian"));
    if (endian != "little" && endian != "big") header.refuse("endian", "little or big");
    layout.big_endian = endian == "big";
  }
  const int64_t volumes = list == kNone ? 1 : sizes[static_cast<size_t>(list)];
  layout.segments = segmentsOf(header, volumes);
  if (volumes < 1 || volumes > 65535) header.refuse("sizes", "1 .. 65535 volumes");
  const int asked =
      options.volume < 0 && !layout.segments.empty() ? 0 : options.volume;  // readLabels() reads all layers
  const uint64_t chosen = chosenVolume(path, asked, static_cast<uint64_t>(volumes), options);
  (list == 0 ? layout.components : layout.volumes) = static_cast<uint64_t>(volumes);
  (list == 0 ? layout.component : layout.volume) = chosen;
  if (volumes == 1)
    for (Segment& segment : layout.segments) segment.layer = 0;
  for (const Segment& segment : layout.segments)
    if (segment.layer >= volumes)
      throw SceneError(path + ": segment '" + segment.label.name + "' is in layer " + std::to_string(segment.layer) +
                       "; accepted: 0 .. " + std::to_string(volumes - 1));
  const uint64_t bytes = layout.frame.voxels() * static_cast<uint64_t>(volumes) * bytesOf(layout.type);
  return slicesOf(dataOf(header, bytes), std::move(layout), 0);
}

}  // namespace viscera
