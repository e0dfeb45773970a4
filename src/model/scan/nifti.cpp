// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstring>
#include <sstream>

#include "math/number_text.h"
#include "model/scan/voxels.h"
#include "viscera/math/error.h"

// NIfTI-1 and NIfTI-2, one file, plain or gzipped. The world frame of a file is RAS.
namespace viscera {
namespace {

using Affine = Eigen::Matrix<double, 3, 4>;

constexpr size_t kHeader1 = 348, kHeader2 = 540;

/// Numbers in a header, by their offsets.
class Fields {
 public:
  Fields(std::vector<uint8_t> bytes, bool big_endian)
      : bytes_(std::move(bytes)), big_endian_(big_endian), second_(bytes_.size() == kHeader2) {}
  bool second() const { return second_; }
  bool bigEndian() const { return big_endian_; }
  const uint8_t* at(size_t position) const { return bytes_.data() + position; }

  template <typename T>
  T get(size_t position) const {
    uint8_t bytes[sizeof(T)];
    for (size_t b = 0; b < sizeof(T); ++b) bytes[b] = bytes_.at(position + (big_endian_ ? sizeof(T) - 1 - b : b));
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
  }
  /// Returns real number n of a field: float in version 1, double in version 2.
  double real(size_t position1, size_t position2, size_t n = 0) const {
    return second_ ? get<double>(position2 + 8 * n) : static_cast<double>(get<float>(position1 + 4 * n));
  }
  int64_t dim(size_t n) const { return second_ ? get<int64_t>(16 + 8 * n) : get<int16_t>(40 + 2 * n); }
  int64_t code(size_t position1, size_t position2) const {
    return second_ ? get<int32_t>(position2) : get<int16_t>(position1);
  }
  double pixdim(size_t n) const { return n == 0 ? real(76, 104, n) : unit_mm * real(76, 104, n); }

  double unit_mm = 1;  ///< unit of lengths [mm]

 private:
  std::vector<uint8_t> bytes_;
  bool big_endian_, second_;
};

Fields readHeader(ByteStream& stream) {
  const std::string& path = stream.path();
  stream.requireHolds(kHeader1);
  std::vector<uint8_t> bytes(kHeader1);
  stream.read(bytes.data(), 4);
  const uint32_t little = bytes[0] | bytes[1] << 8 | bytes[2] << 16 | static_cast<uint32_t>(bytes[3]) << 24;
  const uint32_t big = bytes[3] | bytes[2] << 8 | bytes[1] << 16 | static_cast<uint32_t>(bytes[0]) << 24;
  const bool second = little == kHeader2 || big == kHeader2;
  if (!second && little != kHeader1 && big != kHeader1)
    throw SceneError(path + ": not a NIfTI file: its header does not have 348 or 540 bytes");
  bytes.resize(second ? kHeader2 : kHeader1);
  stream.read(bytes.data() + 4, bytes.size() - 4);
  const Fields fields(std::move(bytes), little != kHeader1 && little != kHeader2);
  const char* magic = reinterpret_cast<const char*>(fields.at(second ? 4 : 344));
  if (std::memcmp(magic, second ? "n+2" : "n+1", 4) != 0)
    throw SceneError(path +
                     ": not a NIfTI file with its data inside; accepted: one file, .nii or .nii.gz, of NIfTI-1 or 2");
  return fields;
}

VoxelType voxelType(const std::string& path, int code) {
  switch (code) {
    case 2:
      return VoxelType::kUint8;
    case 4:
      return VoxelType::kInt16;
    case 8:
      return VoxelType::kInt32;
    case 16:
      return VoxelType::kFloat;
    case 64:
      return VoxelType::kDouble;
    case 256:
      return VoxelType::kInt8;
    case 512:
      return VoxelType::kUint16;
    case 768:
      return VoxelType::kUint32;
    case 1024:
      return VoxelType::kInt64;
    case 1280:
      return VoxelType::kUint64;
    default:
      throw SceneError(path + ": datatype " + std::to_string(code) + (code == 128 || code == 2304 ? " (colours)" : "") +
                       "; accepted: one number per voxel (2, 4, 8, 16, 64, 256, 512, 768, 1024, 1280)");
  }
}

std::array<int64_t, 3> sizeOf(const std::string& path, const Fields& fields, uint64_t* volumes) {
  const int64_t dims = fields.dim(0);
  if (dims < 3 || dims > 7) throw SceneError(path + ": dim[0] is " + std::to_string(dims) + "; accepted: 3 .. 7");
  for (int64_t n = 5; n <= dims; ++n)
    if (fields.dim(static_cast<size_t>(n)) != 1)
      throw SceneError(path + ": dim[" + std::to_string(n) + "] is " +
                       std::to_string(fields.dim(static_cast<size_t>(n))) +
                       "; accepted: 1 (one number per voxel; volumes are in dim[4])");
  const int64_t count = dims > 3 ? fields.dim(4) : 1;
  if (count < 1 || count > 65535)
    throw SceneError(path + ": dim[4] is " + std::to_string(count) + "; accepted: 1 .. 65535");
  *volumes = static_cast<uint64_t>(count);
  const std::array<int64_t, 3> size = {fields.dim(1), fields.dim(2), fields.dim(3)};
  requireSize(path, size);
  return size;
}

Affine sform(const Fields& fields) {
  Affine affine;
  for (int n = 0; n < 12; ++n) affine(n / 4, n % 4) = fields.unit_mm * fields.real(280, 400, static_cast<size_t>(n));
  return affine;
}

Affine qform(const Fields& fields) {
  const double b = fields.real(256, 352), c = fields.real(260, 360), d = fields.real(264, 368);
  const double a = std::sqrt(std::max(0.0, 1 - (b * b + c * c + d * d)));
  Affine affine;
  affine.leftCols<3>() = Quaterniond(a, b, c, d).normalized().toRotationMatrix();
  for (int axis = 0; axis < 3; ++axis) affine.col(axis) *= fields.pixdim(static_cast<size_t>(axis) + 1);
  if (fields.pixdim(0) < 0) affine.col(2) *= -1;  // qfac
  affine.col(3) = fields.unit_mm * Vector3d(fields.real(268, 376), fields.real(272, 384), fields.real(276, 392));
  return affine;
}

void requireFinite(const std::string& path, const Affine& affine, const char* which) {
  if (!affine.allFinite()) throw SceneError(path + ": " + which + " is not finite; accepted: 12 finite numbers");
}

/// Returns the name of the steps, for errors.
const char* stepsOf(const Fields& fields, bool sform) {
  if (fields.unit_mm == 1) return sform ? "steps of its sform" : "pixdim";
  return sform ? "steps of its sform in the unit of xyzt_units" : "pixdim in the unit of xyzt_units";
}

/// Returns whether pixdim can be the steps of a volume.
bool hasSteps(const Fields& fields) {
  bool all = true;
  for (size_t axis = 1; axis <= 3; ++axis) all = all && isSpacing(fields.pixdim(axis));  // false for NaN
  return all;
}

/// Returns a note if sform and pixdim differ; other programs take pixdim for the size of voxels. sform takes
/// precedence. @returns a line; empty: they agree
std::string stepsNote(const std::string& path, const Fields& fields, const Affine& affine) {
  constexpr double kAlike = 0.01;
  bool alike = true;
  std::ostringstream out;
  out << path << ": pixdim has voxels of";
  for (int axis = 0; axis < 3; ++axis) {
    const double said = fields.pixdim(static_cast<size_t>(axis) + 1), step = affine.col(axis).norm();
    alike = alike && std::abs(said - step) <= kAlike * step;
    out << (axis > 0 ? " x " : " ") << said;
  }
  out << " mm, but sform has " << affine.col(0).norm() << " x " << affine.col(1).norm() << " x " << affine.col(2).norm()
      << " mm; sform is used";
  return alike ? "" : out.str();
}

/// Returns whether both put the corners of the volume within half a voxel of each other.
bool agree(const Affine& a, const Affine& b, const std::array<int64_t, 3>& size) {
  const double half = a.leftCols<3>().colwise().norm().minCoeff() / 2;
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector4d at(0, 0, 0, 1);
    for (int axis = 0; axis < 3; ++axis)
      if (corner >> axis & 1) at[axis] = static_cast<double>(size[static_cast<size_t>(axis)] - 1);
    if (((a - b) * at).norm() > half) return false;
  }
  return true;
}

/// Returns the transform from voxels to RAS [mm].
Affine affineOf(const std::string& path, const Fields& fields, const std::array<int64_t, 3>& size,
                const ScanOptions& options) {
  const std::string& given = options.transform;
  const bool has_s = fields.code(254, 348) > 0, said_q = fields.code(252, 344) > 0;
  const bool has_q = said_q && (hasSteps(fields) || !has_s || given == "qform");
  if (!has_s || given == "qform")  // the transform from pixdim
    for (size_t axis = 1; axis <= 3; ++axis) requireSpacing(path, stepsOf(fields, false), fields.pixdim(axis));
  if (!given.empty() && given != "sform" && given != "qform")
    throw SceneError(path + ": transform '" + given + "'; accepted: sform or qform");
  if ((given == "sform" && !has_s) || (given == "qform" && !has_q))
    throw SceneError(path + ": has no " + given + " (its code is 0); accepted: " +
                     (has_s   ? "sform"
                      : has_q ? "qform"
                              : "axes"));
  if (has_s) requireFinite(path, sform(fields), "sform (srow_x, srow_y, srow_z)");
  if (has_q) requireFinite(path, qform(fields), "qform (quatern_b, c, d and qoffset)");
  if (!has_s && !has_q) {
    const bool guessed =
        options.axes.empty() && isGuessed(path, options, "does not state its orientation; axes RAS are a guess");
    if (options.axes.empty() && !guessed)
      throw SceneError(
          path +
          ": does not state its orientation (sform_code and qform_code are 0); set axes, the directions of i, j "
          "and k, such as axes: RAS");
    Affine affine = Affine::Zero();
    affine.leftCols<3>() = Vector3d(-1, -1, 1).asDiagonal() * lpsFromAxes(path, guessed ? "RAS" : options.axes);
    for (int axis = 0; axis < 3; ++axis) affine.col(axis) *= fields.pixdim(static_cast<size_t>(axis) + 1);
    return affine;
  }
  if (!options.axes.empty()) throw SceneError(path + ": the file states its orientation; remove the key axes");
  if (has_s && has_q && given.empty() && !agree(sform(fields), qform(fields), size) &&
      !isGuessed(path, options, "its sform and its qform are more than half a voxel apart; sform is used"))
    throw SceneError(path +
                     ": its sform and its qform are more than half a voxel apart; set transform to sform or qform");
  if (given == "qform" || !has_s) return qform(fields);
  for (int axis = 0; axis < 3; ++axis) requireSpacing(path, stepsOf(fields, true), sform(fields).col(axis).norm());
  const std::string note = stepsNote(path, fields, sform(fields));
  if (options.notes && !note.empty()) options.notes->push_back(note);
  return sform(fields);
}

/// Returns the unit of the header's lengths [mm].
double unitMm(const std::string& path, const Fields& fields) {
  const int64_t code = (fields.second() ? fields.get<int32_t>(500) : *fields.at(123)) & 7;
  if (code == 0 || code == 2) return 1;
  if (code == 1) return 1000;
  if (code == 3) return 1e-3;
  throw SceneError(path + ": xyzt_units is " + std::to_string(code) +
                   "; accepted: 1 (m), 2 (mm), 3 (um), or 0, which is read as mm");
}

void scaling(const std::string& path, const Fields& fields, VoxelLayout& layout) {
  const double slope = fields.real(112, 176), intercept = fields.real(116, 184);
  if (slope == 0 || !std::isfinite(slope)) return;  // by the standard, values are then unscaled
  if (!std::isfinite(intercept)) throw SceneError(path + ": scl_inter is not finite; accepted: a finite number");
  layout.slope = slope;
  layout.intercept = intercept;
}

}  // namespace

std::unique_ptr<ScanSource> openNifti(const std::string& path, const ScanOptions& options) {
  auto stream = std::make_unique<ByteStream>(path, 0, beginsAsGzip(path));
  Fields fields = readHeader(*stream);
  VoxelLayout layout;
  const std::array<int64_t, 3> size = sizeOf(path, fields, &layout.volumes);
  layout.type = voxelType(path, fields.get<int16_t>(fields.second() ? 12 : 70));
  layout.big_endian = fields.bigEndian();
  layout.volume = chosenVolume(path, options.volume, layout.volumes, options);
  fields.unit_mm = unitMm(path, fields);
  const Affine ras = affineOf(path, fields, size, options);
  const Eigen::DiagonalMatrix<double, 3> lps(-1, -1, 1);
  layout.frame = frameFromLps(path, size, lps * ras.leftCols<3>(), lps * ras.col(3));
  scaling(path, fields, layout);
  const uint64_t header = fields.second() ? kHeader2 : kHeader1;
  const double least = static_cast<double>(header) + 4;
  double offset = fields.second() ? static_cast<double>(fields.get<int64_t>(168)) : fields.real(108, 168);
  if (offset == 0) offset = least;
  if (!(offset >= least && offset <= 1e15))
    throw SceneError(path + ": vox_offset is " + numberText(offset) + "; accepted: " + numberText(least) + " or more");
  const auto before = static_cast<uint64_t>(offset);
  stream->requireHolds(before);
  stream->skip(before - header);
  return slicesOf(std::move(stream), std::move(layout), before);
}

}  // namespace viscera
