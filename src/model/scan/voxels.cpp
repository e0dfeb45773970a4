// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scan/voxels.h"

#include <cmath>
#include <cstring>
#include <utility>

#include "math/number_text.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

constexpr int64_t kMostAlongAxis = 65535;
constexpr uint64_t kMostVoxels = uint64_t{1} << 31;      ///< one byte per label: 2 GiB
constexpr uint64_t kMostSliceBytes = uint64_t{1} << 29;  ///< in memory at a time
constexpr uint64_t kMostVolumes = 65535;
constexpr double kLeastSpacingMm = 1e-3, kMostSpacingMm = 100, kMostOriginMm = 1e6;
constexpr double kLeastDeterminant = 1e-3;  ///< of the axes' directions: below it, they are nearly coplanar

template <typename T>
void convert(const std::vector<uint8_t>& raw, const VoxelLayout& layout, std::vector<float>& values) {
  const bool scaled = layout.slope != 1 || layout.intercept != 0;
  const size_t step = sizeof(T) * layout.components;
  const uint8_t* from = raw.data() + sizeof(T) * layout.component;
  for (float& value : values) {
    uint8_t bytes[sizeof(T)];
    for (size_t b = 0; b < sizeof(T); ++b) bytes[b] = from[layout.big_endian ? sizeof(T) - 1 - b : b];
    T x;
    std::memcpy(&x, bytes, sizeof(T));
    value =
        scaled ? static_cast<float>(static_cast<double>(x) * layout.slope + layout.intercept) : static_cast<float>(x);
    from += step;
  }
}

class StreamedSlices : public ScanSource {
 public:
  StreamedSlices(std::unique_ptr<ByteStream> stream, VoxelLayout layout)
      : stream_(std::move(stream)), layout_(std::move(layout)) {
    for (const Segment& segment : layout_.segments)
      if (segment.layer == static_cast<int>(std::max(layout_.volume, layout_.component)))
        names_.push_back(segment.label);
  }
  const VolumeFrame& frame() const override { return layout_.frame; }
  const std::vector<LabelName>& names() const override { return names_; }
  const std::vector<Segment>& segments() const override { return layout_.segments; }
  const std::string& file() const override { return stream_->path(); }
  int layers() const override {
    return layout_.segments.empty() ? 1 : static_cast<int>(std::max(layout_.volumes, layout_.components));
  }

  void next(std::vector<float>& values) override {
    const Vector3i& size = layout_.frame.size;
    if (slice_ >= size.z()) throw SceneError(stream_->path() + ": no slice is left");
    const size_t voxels = static_cast<size_t>(size.x()) * static_cast<size_t>(size.y());
    const size_t bytes = voxels * layout_.components * bytesOf(layout_.type);
    const uint64_t volume_bytes = uint64_t{bytes} * static_cast<uint64_t>(size.z());
    if (slice_ == 0) stream_->skip(layout_.volume * volume_bytes);
    raw_.resize(bytes);
    stream_->read(raw_.data(), bytes);
    values.resize(voxels);
    toFloat(values);
    if (++slice_ < size.z()) return;
    stream_->skip((layout_.volumes - 1 - layout_.volume) * volume_bytes);
    stream_->finish();
  }

 private:
  void toFloat(std::vector<float>& values) const {
    switch (layout_.type) {
      case VoxelType::kUint8:
        return convert<uint8_t>(raw_, layout_, values);
      case VoxelType::kInt8:
        return convert<int8_t>(raw_, layout_, values);
      case VoxelType::kUint16:
        return convert<uint16_t>(raw_, layout_, values);
      case VoxelType::kInt16:
        return convert<int16_t>(raw_, layout_, values);
      case VoxelType::kUint32:
        return convert<uint32_t>(raw_, layout_, values);
      case VoxelType::kInt32:
        return convert<int32_t>(raw_, layout_, values);
      case VoxelType::kUint64:
        return convert<uint64_t>(raw_, layout_, values);
      case VoxelType::kInt64:
        return convert<int64_t>(raw_, layout_, values);
      case VoxelType::kFloat:
        return convert<float>(raw_, layout_, values);
      case VoxelType::kDouble:
        return convert<double>(raw_, layout_, values);
    }
  }

  std::unique_ptr<ByteStream> stream_;
  VoxelLayout layout_;
  std::vector<LabelName> names_;
  std::vector<uint8_t> raw_;
  int slice_ = 0;
};

}  // namespace

size_t bytesOf(VoxelType type) {
  static constexpr size_t kBytes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kBytes[static_cast<size_t>(type)];
}

std::unique_ptr<ScanSource> slicesOf(std::unique_ptr<ByteStream> stream, VoxelLayout layout, uint64_t before) {
  // The products cannot overflow: 2^31 voxels, 2^16 volumes or components, 2^3 bytes.
  if (layout.volumes > kMostVolumes || layout.components > kMostVolumes ||
      (layout.volumes > 1 && layout.components > 1))
    throw SceneError(stream->path() + ": too many volumes; accepted: at most " + std::to_string(kMostVolumes));
  const Vector3i& size = layout.frame.size;
  const uint64_t slice = uint64_t{static_cast<uint32_t>(size.x())} * static_cast<uint32_t>(size.y()) *
                         layout.components * bytesOf(layout.type);
  if (slice > kMostSliceBytes)
    throw SceneError(stream->path() + ": a slice has " + std::to_string(slice) + " bytes; accepted: at most " +
                     std::to_string(kMostSliceBytes));
  stream->requireHolds(before + layout.frame.voxels() * layout.volumes * layout.components * bytesOf(layout.type));
  return std::make_unique<StreamedSlices>(std::move(stream), std::move(layout));
}

void requireSize(const std::string& path, const std::array<int64_t, 3>& size) {
  uint64_t voxels = 1;
  for (const int64_t n : size) {
    if (n < 1 || n > kMostAlongAxis)
      throw SceneError(path + ": " + std::to_string(n) + " voxels along an axis; accepted: 1 .. " +
                       std::to_string(kMostAlongAxis));
    voxels *= static_cast<uint64_t>(n);
  }
  if (voxels > kMostVoxels)
    throw SceneError(path + ": " + std::to_string(voxels) + " voxels; accepted: at most " +
                     std::to_string(kMostVoxels));
}

bool isSpacing(double spacing_mm) {
  return spacing_mm >= kLeastSpacingMm && spacing_mm <= kMostSpacingMm;  // false for NaN
}

void requireSpacing(const std::string& path, const char* key, double spacing_mm) {
  if (isSpacing(spacing_mm)) return;
  throw SceneError(path + ": " + key + ": voxels are " + numberText(spacing_mm) +
                   " mm apart; accepted: 0.001 .. 100 mm");
}

bool isGuessed(const std::string& path, const ScanOptions& options, const std::string& what) {
  if (options.guesses && options.notes) options.notes->push_back(path + ": " + what);
  return options.guesses;
}

uint64_t chosenVolume(const std::string& path, int asked, uint64_t volumes, const ScanOptions& options) {
  if (asked < 0 && volumes == 1) return 0;
  if (asked < 0 && isGuessed(path, options, "has " + std::to_string(volumes) + " volumes; volume 0 is used")) return 0;
  if (asked >= 0 && static_cast<uint64_t>(asked) < volumes) return static_cast<uint64_t>(asked);
  throw SceneError(path + ": has " + std::to_string(volumes) + " volumes" +
                   (asked < 0 ? ": choose one" : " and no volume " + std::to_string(asked)) +
                   "; accepted: volume 0 .. " + std::to_string(volumes - 1));
}

VolumeFrame frameFromLps(const std::string& path, const std::array<int64_t, 3>& size, const Eigen::Matrix3d& axes_mm,
                         const Vector3d& origin_mm) {
  requireSize(path, size);
  if (!axes_mm.allFinite() || !origin_mm.allFinite())
    throw SceneError(path + ": the transform of its voxels is not finite; accepted: 12 finite numbers");
  for (int axis = 0; axis < 3; ++axis) requireSpacing(path, "steps along the axes", axes_mm.col(axis).norm());
  if (std::abs(axes_mm.colwise().normalized().determinant()) < kLeastDeterminant)
    throw SceneError(path + ": its axes are in one plane; accepted: three axes that are not");
  if (origin_mm.cwiseAbs().maxCoeff() > kMostOriginMm)
    throw SceneError(path + ": its first voxel is more than 1000 m away; accepted: at most 1e6 mm");
  Eigen::Matrix3d body;
  body << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  VolumeFrame frame;
  frame.size = Vector3i(static_cast<int>(size[0]), static_cast<int>(size[1]), static_cast<int>(size[2]));
  frame.axes = body * axes_mm / 1000;
  frame.origin = body * origin_mm / 1000;
  return frame;
}

Eigen::Matrix3d lpsFromAxes(const std::string& path, const std::string& axes) {
  static const std::string kTo = "LPSRAI";  // first the directions along LPS, then the opposite ones
  Eigen::Matrix3d turned = Eigen::Matrix3d::Zero();
  if (axes.size() == 3)
    for (int axis = 0; axis < 3; ++axis) {
      const size_t position = kTo.find(axes[static_cast<size_t>(axis)]);
      if (position != std::string::npos) turned(static_cast<int>(position % 3), axis) = position < 3 ? 1 : -1;
    }
  if (std::abs(turned.determinant()) == 1) return turned;
  throw SceneError(path + ": axes '" + axes +
                   "'; accepted: three letters, one each of L or R, A or P, S or I, such as LPS");
}

}  // namespace viscera
