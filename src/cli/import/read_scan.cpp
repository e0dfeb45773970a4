// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/import/read_scan.h"

#include <iostream>
#include <sstream>

#include "model/scan/repeated_voxels.h"
#include "viscera/math/error.h"

namespace viscera::cli {
namespace {

ReadScan inWindow(const ImportOptions& options, Stages& stages) {
  WindowReport report;
  ReadScan read;
  LabelVolume& map = read.map;
  map = windowed(*openScan(options.scan, options.labels), options.window, &report);
  map.names = {{0, ""}, {1, "window"}};
  stages.end();  // ends the line of progress
  std::cout << "values: " << report.least << " to " << report.largest << "; " << report.in_window
            << " voxels in the window, " << report.at_border << " of them at the border of the scan, "
            << report.not_numbers << " not numbers\npieces: " << report.pieces << ", kept " << report.kept << ": "
            << report.kept_cm3 << " cm3, holes filled " << report.filled_cm3 << " cm3; largest [cm3]:";
  for (const double cm3 : report.largest_cm3) std::cout << ' ' << cm3;
  std::cout << "\nThis is not a segmentation: connected tissue with the same values is included (docs/scans.md).\n";
  stages.begin("reading values at borders");
  const std::unique_ptr<ScanSource> source = openScan(options.scan, options.labels);
  const Vector3i middle = middleOf(map).cast<int>() + report.first;
  SlicedSource sliced(*source, middle.cwiseMax(0).cwiseMin((source->frame().size.array() - 1).matrix()));
  read.values = std::make_unique<BorderValues>(sliced, map, report.first);
  read.slices = std::move(sliced.slices);
  return read;
}

/// Undoes upsampling: an upsampled map has steps of several voxels, which surface nets do not smooth.
void takeRepeats(LabelVolume& map, const ImportOptions& options, std::vector<std::string>& notes) {
  const std::array<Repeats, 3> repeats = repeatsOf(map);
  std::string along;
  for (size_t axis = 0; axis < 3; ++axis)
    if (repeats[axis].times > 1)
      along += (along.empty() ? "" : ", ") + std::to_string(repeats[axis].times) + " along " + "ijk"[axis];
  if (along.empty()) return;
  notes.push_back(options.scan + ": its labels change only every few voxels (" + along +
                  "): it was resampled to a finer grid; " +
                  (options.smooth ? "read at its original resolution"
                                  : "--smooth reads it at its original resolution, for smooth surfaces"));
  if (options.smooth) map = withoutRepeats(map, repeats);
}

ReadScan byLabels(const ImportOptions& options, Stages& stages, std::vector<std::string>& notes) {
  ReadScan read;
  read.map = readLabels(options.scan, options.labels);
  takeRepeats(read.map, options, notes);
  if (options.no_previews) return read;
  if (!options.grey.empty()) {
    stages.begin("reading the scan below");
    ScanOptions of_grey = options.labels;
    of_grey.volume = -1;
    of_grey.series.clear();
    const VolumeFrame& frame = read.map.frame;
    read.slices = slicesAt(*openScan(options.grey, of_grey), frame.axes * middleOf(read.map) + frame.origin);
    if (read.slices.empty())
      notes.push_back(options.grey + ": does not contain the centre of the labels; previews do not show it");
  }
  if (read.slices.empty()) read.slices = slicesOf(read.map);
  return read;
}

/// Checks the position before surfaces are computed, which takes longest.
/// @throws SceneError  the organs are too far away for a scene
void requireNear(const VolumeFrame& frame, const std::string& scan) {
  constexpr double kFarthest_m = 10;  // as for bodies[].position_m
  const Vector3d last = (frame.size.array() - 1).matrix().cast<double>();
  const Vector3d middle_m = frame.axes * (0.5 * last) + frame.origin;
  if (middle_m.cwiseAbs().maxCoeff() <= kFarthest_m) return;
  std::ostringstream out;
  out << scan << ": its centre is at " << middle_m.x() << ", " << middle_m.y() << ", " << middle_m.z()
      << " m; accepted: within " << kFarthest_m << " m of the origin. Set the offset of its sform, its qform or its "
      << "space origin to 0";
  throw SceneError(out.str());
}

}  // namespace

ReadScan readScan(const ImportOptions& options, Stages& stages, std::vector<std::string>& notes) {
  ReadScan read = options.by_window ? inWindow(options, stages) : byLabels(options, stages, notes);
  requireNear(read.map.frame, options.scan);
  return read;
}

SurfaceNet netOf(const ReadScan& read, const WindowOptions& window) {
  if (!read.values) return surfaceNet(read.map);
  const ValueWindow values = {static_cast<float>(window.low), static_cast<float>(window.high),
                              [&](size_t voxel) { return read.values->at(voxel); }};
  return surfaceNet(read.map, &values);
}

}  // namespace viscera::cli
