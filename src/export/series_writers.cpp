// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>

#include "export/writers.h"
#include "math/number_text.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

template <class T>
void put(OutFile& file, T value) {
  file.write(&value, sizeof value);
}

const char* topologyOf(uint32_t corners) {
  return corners == 2 ? "Polyline\" NodesPerElement=\"2" : corners == 3 ? "Triangle" : "Hexahedron";
}

}  // namespace

XdmfSeries::XdmfSeries(const std::string& stem) : stem_(stem), binary_(stem + ".bin", FileKind::kBytes) {}

std::string XdmfSeries::item(const char* type, const std::string& dimensions, const void* data, size_t bytes) {
  const std::string name = std::filesystem::path(stem_).filename().string() + ".bin";
  std::string out = "<DataItem Dimensions=\"" + dimensions + "\" NumberType=\"" + type +
                    "\" Precision=\"4\" Format=\"Binary\" Endian=\"Little\" Seek=\"" + std::to_string(at_) + "\">" +
                    name + "</DataItem>";
  binary_.write(data, bytes);
  at_ += bytes;
  return out;
}

void XdmfSeries::add(const FieldMesh& mesh) {
  const std::string points = std::to_string(mesh.pointCount()), cells = std::to_string(mesh.cellCount());
  if (cells_item_.empty() || mesh.cells != cells_) {
    cells_ = mesh.cells;
    cells_item_ = item("UInt", cells + " " + std::to_string(mesh.corners), cells_.data(), 4 * cells_.size());
  }
  text_ += "<Grid Name=\"tick " + std::to_string(mesh.tick) + "\">\n<Time Value=\"" + exactText(mesh.time_s) + "\"/>\n";
  text_ += std::string("<Topology TopologyType=\"") + topologyOf(mesh.corners) + "\" NumberOfElements=\"" + cells +
           "\">" + cells_item_ + "</Topology>\n";
  text_ += "<Geometry GeometryType=\"XYZ\">" +
           item("Float", points + " 3", mesh.points.data(), 4 * mesh.points.size()) + "</Geometry>\n";
  const auto attributes = [&](const std::vector<MeshField>& fields, const char* center, const std::string& count) {
    for (const MeshField& field : fields) {
      const bool vector = field.components == 3;
      text_ += "<Attribute Name=\"" + field.name + "\" AttributeType=\"" + (vector ? "Vector" : "Scalar") +
               "\" Center=\"" + center + "\">" +
               item("Float", vector ? count + " 3" : count, field.values.data(), 4 * field.values.size()) +
               "</Attribute>\n";
    }
  };
  attributes(mesh.of_points, "Node", points);
  attributes(mesh.of_cells, "Cell", cells);
  text_ += "</Grid>\n";
}

void XdmfSeries::finish() {
  binary_.keep();
  writeFile(stem_ + ".xdmf", FileKind::kXdmf,
            "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n"
            "<Grid Name=\"viscera\" GridType=\"Collection\" CollectionType=\"Temporal\">\n" +
                text_ + "</Grid>\n</Domain>\n</Xdmf>\n");
}

Pc2Series::Pc2Series(const std::string& path, double every_s)
    : path_(path), file_(path, FileKind::kPc2), every_s_(every_s) {}

void Pc2Series::add(const FieldMesh& mesh) {
  if (points_ < 0) {
    points_ = static_cast<int32_t>(mesh.pointCount());
    file_.write("POINTCACHE2\0", 12);
    put<int32_t>(file_, 1);
    put<int32_t>(file_, points_);
    put<float>(file_, 0);
    put<float>(file_, static_cast<float>(every_s_));
    put<int32_t>(file_, 0);  // samples: known at the end
  }
  if (points_ != static_cast<int32_t>(mesh.pointCount())) {
    throw Error(path_ + ": a point cache must keep its " + std::to_string(points_) + " points, but at tick " +
                std::to_string(mesh.tick) + " there are " + std::to_string(mesh.pointCount()) +
                ": the skin was cut; use vtp, xdmf, ply or glb");
  }
  file_.write(mesh.points.data(), 4 * mesh.points.size());
  ++samples_;
}

void Pc2Series::finish() {
  constexpr uint64_t kAtSamples = 28;
  if (samples_ > 0) file_.writeAt(kAtSamples, &samples_, sizeof samples_);
  file_.keep();
}

}  // namespace viscera
