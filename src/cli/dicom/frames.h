// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "viscera/math/error.h"
#include "viscera/math/types.h"

namespace viscera::dicom {

/// One picture of a file, and where it is in LPS [mm].
struct Frame {
  std::string file;
  unsigned index = 0;  ///< in its file
  int rows = 0, columns = 0;
  Vector3d position = Vector3d::Zero(), along_row = Vector3d::Zero(), down_column = Vector3d::Zero();
  double between_columns = 0, between_rows = 0;
  double between = 0;    ///< SpacingBetweenSlices; 0: not said
  double thickness = 0;  ///< SliceThickness; 0: not said
  int segment = 0;       ///< of DICOM SEG
  std::string rescale;   ///< slope and intercept of this frame, as text; empty: of the file

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

/// Says which file is read, in case that the library ends this process there.
void nowReading(const std::string& file);

/// Of a folder or one file, in order of UIDs. @throws SceneError  none is there
std::vector<Series> seriesOf(const std::string& path);
bool isSegmentation(const std::string& file);
/// @throws SceneError  naming the file: it has no place, or its pixels are cut off
std::vector<Frame> framesOf(const std::string& file);

/// A file may end within its pixels, of which GDCM says nothing. @throws SceneError
void requireWhole(const std::string& file);

/// Sorts frames along their normal. @throws SceneError  missing, doubled, uneven, or of several sizes, saying where
Stack stackOf(std::vector<Frame>& frames);
/// Step between sorted slices, as their positions have it. Of one slice: what its file says.
/// @param gaps  slices may be missing, as in DICOM SEG
Vector3d stepOf(const std::vector<Frame>& frames, bool gaps);
/// Which slice of such a step each frame is, from 0.
std::vector<int> slicesOf(const std::vector<Frame>& frames, const Vector3d& step);

void writeHeader(const Stack& stack, int layers, const std::vector<std::string>& segments);
void writeSlice(const std::vector<float>& values);
/// @param fill  missing slices are like the nearest
void writeVolume(const std::vector<std::string>& files, bool fill);
/// A line ahead of the header: what is odd and no mistake.
void writeNote(const std::string& note);
void writeSegmentation(const std::string& file, int layer);

}  // namespace viscera::dicom
