// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "export/writers.h"
#include "math/out_file.h"

namespace viscera {

namespace {

constexpr uint8_t kHexahedron = 12;  // VTK's number

/// Arrays as XML and as bytes, in the same order.
class Appended {
 public:
  template <class T>
  std::string array(const char* type, const std::string& name, int components, const std::vector<T>& values) {
    const uint64_t bytes = values.size() * sizeof(T);
    std::string out = std::string("<DataArray type=\"") + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
                      std::to_string(components) + "\" format=\"appended\" offset=\"" + std::to_string(bytes_.size()) +
                      "\"/>\n";
    bytes_.append(reinterpret_cast<const char*>(&bytes), sizeof bytes);
    bytes_.append(reinterpret_cast<const char*>(values.data()), bytes);
    return out;
  }
  std::string fields(const char* element, const std::vector<MeshField>& fields) {
    std::string out = std::string("<") + element + ">\n";
    for (const MeshField& field : fields) out += array("Float32", field.name, field.components, field.values);
    return out + "</" + element + ">\n";
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

}  // namespace

void writeVtk(const FieldMesh& mesh, const std::string& path) {
  const bool solid = mesh.corners == 8;
  const std::string type = solid ? "UnstructuredGrid" : "PolyData";
  const std::string cells = solid ? "Cells" : mesh.corners == 2 ? "Lines" : "Polys";
  Appended appended;
  std::vector<int64_t> ids(mesh.cells.begin(), mesh.cells.end()), ends(mesh.cellCount());
  for (size_t c = 0; c < ends.size(); ++c) ends[c] = static_cast<int64_t>((c + 1) * mesh.corners);
  std::string xml = "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + type +
                    "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<" + type +
                    ">\n<Piece NumberOfPoints=\"" + std::to_string(mesh.pointCount()) + "\" NumberOf" +
                    (solid ? "Cells" : cells) + "=\"" + std::to_string(mesh.cellCount()) + "\">\n";
  // Bytes are appended in the order in which the XML names them.
  xml += appended.fields("PointData", mesh.of_points);
  xml += appended.fields("CellData", mesh.of_cells);
  xml += "<Points>\n" + appended.array("Float32", "points", 3, mesh.points) + "</Points>\n<" + cells + ">\n";
  xml += appended.array("Int64", "connectivity", 1, ids);
  xml += appended.array("Int64", "offsets", 1, ends);
  if (solid) xml += appended.array("UInt8", "types", 1, std::vector<uint8_t>(mesh.cellCount(), kHexahedron));
  xml += "</" + cells + ">\n</Piece>\n</" + type + ">\n<AppendedData encoding=\"raw\">\n_";
  OutFile file(path, FileKind::kVtk);
  file.write(xml);
  file.write(appended.bytes());
  file.write("\n</AppendedData>\n</VTKFile>\n");
  file.keep();
}

}  // namespace viscera
