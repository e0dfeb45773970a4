// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "export/field_mesh.h"
#include "math/out_file.h"

namespace viscera {

// Writers of what other programs open, without their libraries. All throw Error where a file cannot be written.

/// VTK's XML with raw bytes behind it: PolyData (.vtp) of triangles and lines, UnstructuredGrid (.vtu) of hexahedra.
void writeVtk(const FieldMesh& mesh, const std::string& path);
/// glTF binary, version 2: one primitive per body and kind with its colour, or those of its vertices where the skin has
/// some; y up, in metres, as the format wants it.
/// @param skin  in the tissue frame
void writeGlb(const ShownMesh& skin, const std::string& path);

/// The whole skin of a moment by the file's ending: .ply, .glb, or .vtp with its fields.
/// @throws Error  another ending
void writeSkin(const Session& session, const ShownMesh& skin, const std::string& path);

/// XDMF 3: one text file that names all times, and one of raw little-endian bytes; cells are there once for as long as
/// they stay the same.
class XdmfSeries {
 public:
  explicit XdmfSeries(const std::string& stem);  ///< .xdmf and .bin
  void add(const FieldMesh& mesh);
  void finish();

 private:
  std::string item(const char* type, const std::string& dimensions, const void* data, size_t bytes);

  std::string stem_, text_, cells_item_;
  std::vector<uint32_t> cells_;
  OutFile binary_;
  uint64_t at_ = 0;
};

/// Positions alone, as Blender's Mesh Cache takes them (PC2).
class Pc2Series {
 public:
  Pc2Series(const std::string& path, double every_s);
  /// @throws Error  not as many points as at first: the skin was cut
  void add(const FieldMesh& mesh);
  bool begun() const { return samples_ > 0; }
  void finish();

 private:
  std::string path_;
  OutFile file_;
  double every_s_;
  int32_t points_ = -1, samples_ = 0;
};

}  // namespace viscera
