// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "viscera/math/error.h"
#include "viscera/math/types.h"

namespace viscera::dicom {

/// One image of a file, with its pose in LPS [mm].
struct Frame {
  std::string file;
  unsigned index = 0;  ///< index in its file
  int rows = 0, columns = 0;
  Vector3d position = Vector3d::Zero(), along_row = Vector3d::Zero(), down_column = Vector3d::Zero();
  double between_columns = 0, between_rows = 0;
  double between = 0;    ///< SpacingBetweenSlices [mm]; 0: not specified
  double thickness = 0;  ///< SliceThickness [mm]; 0: not specified
  int segment = 0;       ///< segment number in DICOM SEG
  std::string rescale;   ///< slope and intercept of this frame, as text; empty: the file's

  Vector3d normal() const { return along_row.cross(down_column); }
  double height() const { return normal().dot(position); }
};

struct Series {
  std::string uid, modality, description;
  std::vector<std::string> files;
};

struct Stack {
  int size[3] = {0, 0, 0};
  Matrix3d axes = Matrix3d::Zero();
  Vector3d origin = Vector3d::Zero();
};

/// Records which file is read, for the error message if the library ends this process.
void nowReading(const std::string& file);

/// Returns the series of a folder or file, ordered by UID. @throws SceneError  there is none
std::vector<Series> seriesOf(const std::string& path);
bool isSegmentation(const std::string& file);
/// Returns the frames of a file. @throws SceneError  names the file: it has no position, or its pixels are truncated
std::vector<Frame> framesOf(const std::string& file);

/// Checks that a file does not end within its pixels, which GDCM does not report. @throws SceneError
void requireWhole(const std::string& file);

/// Sorts frames along their normal.
/// @throws SceneError  missing, duplicate or uneven frames, or several sizes; says where
Stack stackOf(std::vector<Frame>& frames);
/// Returns the step between sorted slices from their positions. For one slice, returns the step in its file.
/// @param gaps  whether slices may be missing, as in DICOM SEG
Vector3d stepOf(const std::vector<Frame>& frames, bool gaps);
/// Returns the slice index of each frame for this step, from 0.
std::vector<int> slicesOf(const std::vector<Frame>& frames, const Vector3d& step);

void writeHeader(const Stack& stack, int layers, const std::vector<std::string>& segments);
void writeSlice(const std::vector<float>& values);
/// Writes a volume. @param fill  whether missing slices are copied from the nearest
void writeVolume(const std::vector<std::string>& files, bool fill);
/// Writes a line before the header about something unusual that is not an error.
void writeNote(const std::string& note);
void writeSegmentation(const std::string& file, int layer);

}  // namespace viscera::dicom
