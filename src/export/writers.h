// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "export/field_mesh.h"
#include "math/out_file.h"

namespace viscera {

// Writers of other programs' formats, without their libraries. All throw Error where a file cannot be written.

/// Writes VTK's XML with appended raw bytes: PolyData (.vtp) of triangles and lines, UnstructuredGrid (.vtu) of
/// hexahedra.
void writeVtk(const FieldMesh& mesh, const std::string& path);
/// Writes glTF binary, version 2: one primitive per body and kind, with its colour, or with vertex colours if the mesh
/// has them; y up, in metres, as the format requires.
/// @param skin  in the tissue frame
void writeGlb(const VisibleMesh& skin, const std::string& path);

/// Writes the whole surface mesh of a moment in the format of the file's ending: .ply, .glb, or .vtp with its fields.
/// @throws Error  another ending
void writeSkin(const Session& session, const VisibleMesh& skin, const std::string& path);

/// XDMF 3: one text file that names all times, and one of raw little-endian bytes. Cells are written once until they
/// change.
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

/// Positions alone, for Blender's Mesh Cache (PC2).
class Pc2Series {
 public:
  Pc2Series(const std::string& path, double every_s);
  /// Writes a moment. @throws Error  the number of points has changed: the mesh was cut
  void add(const FieldMesh& mesh);
  bool begun() const { return samples_ > 0; }
  void finish();

 private:
  std::string path_;
  OutFile file_;
  double every_s_;
  int32_t points_ = -1, samples_ = 0;
};

/// USD as text (.usda): a mesh with time samples of positions and colours, and of triangles where cuts change them;
/// cameras that do not move, and tools. Metres, z up. Positions are rounded to 1e-7 m.
class UsdSeries {
 public:
  /// @param moments_per_s  time codes per second; a code is a moment
  UsdSeries(const std::string& path, const Scene& scene, double moments_per_s);
  void add(uint64_t code, const VisibleMesh& skin, const ToolMotions& tools);
  void finish();

 private:
  /// Time samples of an attribute.
  struct Samples {
    std::string text, last;
    void add(uint64_t code, const std::string& value);  ///< only if it differs from the last one
    std::string written(const std::string& attribute, const std::string& metadata = "") const;
  };
  struct Tool {
    std::string name;
    double length_m, radius_m;
    Samples poses, visibility;
  };

  OutFile file_;
  uint64_t end_at_, end_ = 0;  ///< offset of the last time code in the file; that code
  uint64_t revision_ = 0;      ///< of the last triangles
  bool begun_ = false;
  Samples counts_, corners_, colors_, extents_;
  std::string cameras_;
  std::vector<Tool> tools_;
};

}  // namespace viscera
