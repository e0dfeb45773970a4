// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <map>

#include "model/scan/text_header.h"
#include "model/scan/voxels.h"
#include "viscera/math/error.h"

// MetaImage: a text header (.mhd) with a data file next to it, or both in one file (.mha). Its world frame is LPS.
namespace viscera {
namespace {

struct MetaHeader : TextHeader {
  uint64_t end = 0;  ///< offset of data in the same file
};

MetaHeader readMetaHeader(const std::string& path) {
  MetaHeader header;
  header.path = path;
  ByteStream stream(path, 0, false);
  uint64_t left = kMostHeaderBytes;
  while (!header.has("elementdatafile")) {
    std::string line;
    try {
      line = headerLine(stream, left);
    } catch (const SceneError&) {  // the data were read as lines
      if (!header.has("ndims")) throw;
      throw SceneError(path +
                       ": its header has no ElementDataFile, which locates its data; accepted: LOCAL, or the "
                       "name of one file");
    }
    const size_t equals = line.find('=');
    if (equals == std::string::npos) throw SceneError(path + ": not a MetaImage file: a line of its header has no '='");
    header.fields[lower(trimmed(line.substr(0, equals)))] = trimmed(line.substr(equals + 1));
  }
  header.end = kMostHeaderBytes - left;
  return header;
}

VoxelType metaVoxelType(const TextHeader& header) {
  static const std::map<std::string, VoxelType> kTypes = {
      {"met_uchar", VoxelType::kUint8},       {"met_char", VoxelType::kInt8},       {"met_ushort", VoxelType::kUint16},
      {"met_short", VoxelType::kInt16},       {"met_uint", VoxelType::kUint32},     {"met_int", VoxelType::kInt32},
      {"met_ulong_long", VoxelType::kUint64}, {"met_long_long", VoxelType::kInt64}, {"met_float", VoxelType::kFloat},
      {"met_double", VoxelType::kDouble}};
  const auto found = kTypes.find(lower(header.text("elementtype")));
  if (found == kTypes.end())
    header.refuse("elementtype", "MET_UCHAR, CHAR, USHORT, SHORT, UINT, INT, ULONG_LONG, LONG_LONG, FLOAT, DOUBLE");
  return found->second;
}

bool isTrue(const TextHeader& header, const std::string& name, bool otherwise) {
  if (!header.has(name)) return otherwise;
  const std::string value = lower(header.text(name));
  if (value != "true" && value != "false") header.refuse(name, "True or False");
  return value == "true";
}

/// Returns the first of some names that the header has; the first name if it has none.
std::string alias(const TextHeader& header, std::initializer_list<const char*> names) {
  for (const char* name : names)
    if (header.has(name)) return name;
  return *names.begin();
}

VolumeFrame frameOf(const TextHeader& header, const std::array<int64_t, 3>& size, size_t dims) {
  const std::string spacing_key = alias(header, {"elementspacing", "elementsize"});
  const std::string origin_key = alias(header, {"offset", "position", "origin"});
  const std::string axes_key = alias(header, {"transformmatrix", "rotation", "orientation"});
  if (header.has("distanceunits") && lower(header.text("distanceunits")) != "mm") header.refuse("distanceunits", "mm");
  const std::vector<double> spacing = header.numbers(spacing_key, dims);
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  if (header.has(axes_key)) {
    const std::vector<double> rows = header.numbers(axes_key, dims * dims);  // each row is the direction of an axis
    for (size_t axis = 0; axis < 3; ++axis)
      for (size_t c = 0; c < 3; ++c) axes(static_cast<int>(c), static_cast<int>(axis)) = rows[axis * dims + c];
  }
  for (int axis = 0; axis < 3; ++axis) {
    requireSpacing(header.path, spacing_key.c_str(), spacing[static_cast<size_t>(axis)]);
    axes.col(axis) *= spacing[static_cast<size_t>(axis)];
  }
  Vector3d origin = Vector3d::Zero();
  if (header.has(origin_key)) {
    const std::vector<double> at = header.numbers(origin_key, dims);
    origin = Vector3d(at[0], at[1], at[2]);
  }
  return frameFromLps(header.path, size, axes, origin);
}

std::unique_ptr<ByteStream> dataOf(const MetaHeader& header, bool packed, uint64_t bytes) {
  const std::string& name = header.text("elementdatafile");
  const bool local = name == "LOCAL";
  if (name == "LIST" || words(name).size() > 1 || name.find('%') != std::string::npos)
    header.refuse("elementdatafile", "LOCAL, or the name of one file; lists of slices are not read");
  const std::string file = local ? header.path : dataFileBeside(header.path, name, "ElementDataFile");
  uint64_t offset = local ? header.end : 0;
  if (header.has("headersize")) {
    const int64_t skipped = header.integers("headersize", 1)[0];
    const uint64_t held = fileBytes(file);
    if (skipped < -1 || (local && skipped > 0) || (packed && skipped < 0))
      header.refuse("headersize", "0 or more bytes of a separate data file, or -1: raw data at the end of the file");
    if (skipped < 0 && held < bytes)
      throw SceneError(file + ": ends early: its header asks for " + std::to_string(bytes) + " bytes");
    if (skipped != 0) offset = skipped < 0 ? held - bytes : static_cast<uint64_t>(skipped);
  }
  return std::make_unique<ByteStream>(file, offset, packed);
}

}  // namespace

std::unique_ptr<ScanSource> openMetaImage(const std::string& path, const ScanOptions& options) {
  const MetaHeader header = readMetaHeader(path);
  if (!options.axes.empty())
    throw SceneError(path + ": the axes of MetaImage files are always LPS; remove the key axes");
  if (lower(header.textOr("objecttype", "image")) != "image") header.refuse("objecttype", "Image");
  const int64_t dims = header.integers("ndims", 1)[0];
  if (dims != 3 && dims != 4) header.refuse("ndims", "3, or 4: several volumes");
  if (header.has("elementnumberofchannels") && header.integers("elementnumberofchannels", 1)[0] != 1)
    header.refuse("elementnumberofchannels", "1: one number per voxel");
  if (!isTrue(header, "binarydata", true)) header.refuse("binarydata", "True");
  const std::vector<int64_t> sizes = header.integers("dimsize", static_cast<size_t>(dims));
  VoxelLayout layout;
  layout.type = metaVoxelType(header);
  layout.big_endian = isTrue(header, alias(header, {"binarydatabyteordermsb", "elementbyteordermsb"}), false);
  layout.frame = frameOf(header, {sizes[0], sizes[1], sizes[2]}, static_cast<size_t>(dims));
  const int64_t volumes = dims == 4 ? sizes[3] : 1;
  if (volumes < 1 || volumes > 65535) header.refuse("dimsize", "1 .. 65535 volumes");
  layout.volumes = static_cast<uint64_t>(volumes);
  layout.volume = chosenVolume(path, options.volume, layout.volumes, options);
  const uint64_t bytes = layout.frame.voxels() * layout.volumes * bytesOf(layout.type);
  auto stream = dataOf(header, isTrue(header, "compresseddata", false), bytes);
  return slicesOf(std::move(stream), std::move(layout), 0);
}

}  // namespace viscera
