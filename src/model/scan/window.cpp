// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scan/window.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/number_text.h"
#include "model/scan/pieces.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

constexpr int kAround = 2;                                 ///< empty voxels around tissue: the surface net closes there
constexpr double kMostClosingMm = 20;                      ///< above it, organs merge
constexpr uint64_t kMostVoxelsAround = uint64_t{1} << 32;  ///< with the voxels around
constexpr size_t kListed = 6;

void requireOptions(const std::string& file, const WindowOptions& options) {
  if (!(options.low <= options.high))
    throw SceneError(file + ": window " + numberText(options.low) + " .. " + numberText(options.high) +
                     "; accepted: low <= high");
  if (!(options.closing_mm >= 0 && options.closing_mm <= kMostClosingMm))
    throw SceneError(file + ": a closing of " + numberText(options.closing_mm) + " mm; accepted: 0 .. 20");
  if (options.pieces < 0 || !(options.least_cm3 >= 0))
    throw SceneError(file +
                     ": the number or the size of pieces is negative; accepted: 0 or more pieces of 0 cm3 or more");
}

/// Returns the number of empty voxels on each side of an axis, so that closing does not reach past them.
Vector3i around(const Vector3d& spacing_m, double closing_mm) {
  Vector3i pad;
  for (int axis = 0; axis < 3; ++axis)
    pad[axis] = kAround + static_cast<int>(std::ceil(closing_mm / 1000 / spacing_m[axis]));
  return pad;
}

/// Reads the mask slice by slice, with empty voxels around it.
Mask readWindow(SliceSource& source, const WindowOptions& options, const Vector3i& pad, WindowReport& report) {
  const Vector3i size = source.frame().size;
  Mask mask;
  mask.size = size + 2 * pad;
  const double voxels = mask.size.cast<double>().prod();
  if (voxels > static_cast<double>(kMostVoxelsAround))
    throw SceneError(source.file() + ": " + numberText(voxels) +
                     " voxels including the margin; accepted: at most 2^32");
  mask.voxels.assign(static_cast<size_t>(voxels), 0);
  report.least = std::numeric_limits<double>::infinity();
  report.largest = -report.least;
  std::vector<float> values;
  for (int k = 0; k < size.z(); ++k) {
    source.next(values);
    size_t n = 0;
    for (int j = 0; j < size.y(); ++j) {
      uint8_t* row = mask.voxels.data() + mask.at(pad.x(), j + pad.y(), k + pad.z());
      const bool edge_row = j == 0 || j == size.y() - 1 || k == 0 || k == size.z() - 1;
      for (int i = 0; i < size.x(); ++i) {
        const auto value = static_cast<double>(values[n++]);
        if (std::isnan(value)) {
          ++report.not_numbers;
          continue;
        }
        report.least = std::min(report.least, value);
        report.largest = std::max(report.largest, value);
        if (value < options.low || value > options.high) continue;
        row[i] = 1;
        ++report.in_window;
        report.at_border += edge_row || i == 0 || i == size.x() - 1;
      }
    }
  }
  return mask;
}

void close(Mask& mask, const Vector3d& spacing_m, double closing_mm) {
  if (closing_mm <= 0) return;
  grow(mask, 1, spacing_m * 1000, closing_mm);
  grow(mask, 0, spacing_m * 1000, closing_mm);
}

void keepPieces(const std::string& file, Mask& mask, const WindowOptions& options, double voxel_cm3,
                WindowReport& report) {
  const Pieces pieces(mask, 1);
  std::vector<uint32_t> order;
  for (uint32_t piece = 0; piece < pieces.voxels().size(); ++piece)
    if (pieces.voxels()[piece] > 0) order.push_back(piece);
  report.pieces = order.size();
  const auto larger = [&](uint32_t a, uint32_t b) { return pieces.voxels()[a] > pieces.voxels()[b]; };
  std::stable_sort(order.begin(), order.end(), larger);
  const auto cm3 = [&](uint32_t piece) { return static_cast<double>(pieces.voxels()[piece]) * voxel_cm3; };
  for (size_t n = 0; n < std::min(kListed, order.size()); ++n) report.largest_cm3.push_back(cm3(order[n]));
  const size_t most = options.pieces == 0 ? order.size() : static_cast<size_t>(options.pieces);
  std::vector<bool> kept(pieces.voxels().size(), false);
  for (size_t n = 0; n < std::min(most, order.size()) && cm3(order[n]) >= options.least_cm3; ++n) {
    kept[order[n]] = true;
    ++report.kept;
    report.kept_cm3 += cm3(order[n]);
  }
  if (report.kept == 0)
    throw SceneError(file + ": no piece within the window has " + numberText(options.least_cm3) +
                     " cm3; accepted: at most " + numberText(report.largest_cm3.at(0)) +
                     " cm3, the size of the largest piece");
  pieces.assign(
      mask, [&](uint32_t piece) { return !kept[piece]; }, 0);
}

void fillHoles(Mask& mask, double voxel_cm3, WindowReport& report) {
  const Pieces outside(mask, 0);
  for (uint32_t piece = 0; piece < outside.voxels().size(); ++piece)
    if (!outside.atBorder(piece)) report.filled_cm3 += static_cast<double>(outside.voxels()[piece]) * voxel_cm3;
  outside.assign(
      mask, [&](uint32_t piece) { return !outside.atBorder(piece); }, 1);
}

/// Crops what is farther than kAround from tissue, in place. @returns its first voxel
Vector3i crop(Mask& mask) {
  Vector3i low = mask.size, high = Vector3i::Zero();
  for (int k = 0; k < mask.size.z(); ++k)
    for (int j = 0; j < mask.size.y(); ++j) {
      const auto begin = mask.voxels.begin() + static_cast<std::ptrdiff_t>(mask.at(0, j, k)),
                 end = begin + mask.size.x();
      const auto first = std::find(begin, end, 1);
      if (first == end) continue;
      auto last = end;
      while (*(last - 1) == 0) --last;
      low = low.cwiseMin(Vector3i(static_cast<int>(first - begin), j, k));
      high = high.cwiseMax(Vector3i(static_cast<int>(last - begin), j + 1, k + 1));
    }
  low = (low.array() - kAround).cwiseMax(0);
  high = (high.array() + kAround).matrix().cwiseMin(mask.size);
  const Vector3i size = high - low;
  auto to = mask.voxels.begin();
  for (int k = low.z(); k < high.z(); ++k)
    for (int j = low.y(); j < high.y(); ++j) {
      const auto row = mask.voxels.begin() + static_cast<std::ptrdiff_t>(mask.at(low.x(), j, k));
      to = std::copy(row, row + size.x(), to);  // never overtakes the read position
    }
  mask.size = size;
  mask.voxels.erase(to, mask.voxels.end());
  mask.voxels.shrink_to_fit();
  return low;
}

}  // namespace

LabelVolume windowed(SliceSource& source, const WindowOptions& options, WindowReport* report) {
  WindowReport found;
  requireOptions(source.file(), options);
  const VolumeFrame& frame = source.frame();
  const Vector3d spacing = frame.spacing_m();
  const double voxel_cm3 = std::abs(frame.axes.determinant()) * 1e6;
  const Vector3i pad = around(spacing, options.closing_mm);
  Mask mask = readWindow(source, options, pad, found);
  if (found.in_window == 0)
    throw SceneError(source.file() + ": no voxel is within the window " + numberText(options.low) + " .. " +
                     numberText(options.high) + "; accepted: a range within its values, " + numberText(found.least) +
                     " .. " + numberText(found.largest));
  close(mask, spacing, options.closing_mm);
  keepPieces(source.file(), mask, options, voxel_cm3, found);
  if (options.fill_holes) fillHoles(mask, voxel_cm3, found);
  found.first = crop(mask) - pad;
  LabelVolume volume;
  volume.frame = frame;
  volume.frame.size = mask.size;
  volume.frame.origin += frame.axes * found.first.cast<double>();
  volume.labels = std::move(mask.voxels);
  volume.names = {{0, ""}, {1, "window " + numberText(options.low) + " .. " + numberText(options.high)}};
  if (report) *report = found;
  return volume;
}

}  // namespace viscera
