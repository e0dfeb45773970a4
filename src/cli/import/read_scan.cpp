// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/import/read_scan.h"

#include <iostream>

namespace viscera::cli {
namespace {

ReadScan inWindow(const ImportOptions& options, Stages& stages) {
  WindowReport report;
  ReadScan read;
  LabelVolume& map = read.map;
  map = windowed(*openScan(options.scan, options.labels), options.window, &report);
  map.names = {{0, ""}, {1, "window"}};
  stages.end();  // its line
  std::cout << "values: " << report.least << " to " << report.largest << "; " << report.in_window
            << " voxels in the window, " << report.at_border << " of them at the scan's border, " << report.not_numbers
            << " no numbers\npieces: " << report.pieces << ", kept " << report.kept << ": " << report.kept_cm3
            << " cm3, holes filled " << report.filled_cm3 << " cm3; largest [cm3]:";
  for (const double cm3 : report.largest_cm3) std::cout << ' ' << cm3;
  std::cout << "\nThis is no segmentation: what has the same values and touches came along (docs/scans.md).\n";
  stages.begin("reading values at borders");
  const std::unique_ptr<ScanSource> source = openScan(options.scan, options.labels);
  const Vector3i middle = middleOf(map).cast<int>() + report.first;
  SlicedSource sliced(*source, middle.cwiseMax(0).cwiseMin((source->frame().size.array() - 1).matrix()));
  read.values = std::make_unique<BorderValues>(sliced, map, report.first);
  read.slices = std::move(sliced.slices);
  return read;
}

ReadScan byLabels(const ImportOptions& options, Stages& stages, std::vector<std::string>& notes) {
  ReadScan read;
  read.map = readLabels(options.scan, options.labels);
  if (options.no_previews) return read;
  if (!options.grey.empty()) {
    stages.begin("reading the scan below");
    ScanOptions of_grey = options.labels;
    of_grey.volume = -1;
    of_grey.series.clear();
    const VolumeFrame& frame = read.map.frame;
    read.slices = slicesAt(*openScan(options.grey, of_grey), frame.axes * middleOf(read.map) + frame.origin);
    if (read.slices.empty()) notes.push_back(options.grey + ": the labels' middle is not in it: previews are without");
  }
  if (read.slices.empty()) read.slices = slicesOf(read.map);
  return read;
}

}  // namespace

ReadScan readScan(const ImportOptions& options, Stages& stages, std::vector<std::string>& notes) {
  return options.by_window ? inWindow(options, stages) : byLabels(options, stages, notes);
}

SurfaceNet netOf(const ReadScan& read, const WindowOptions& window) {
  if (!read.values) return surfaceNet(read.map);
  const ValueWindow values = {static_cast<float>(window.low), static_cast<float>(window.high),
                              [&](size_t voxel) { return read.values->at(voxel); }};
  return surfaceNet(read.map, &values);
}

}  // namespace viscera::cli
