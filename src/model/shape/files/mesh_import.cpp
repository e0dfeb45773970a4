// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/shape/mesh_import.h"

#include <assimp/mesh.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <set>

#include "math/memory_for.h"
#include "math/number_text.h"
#include "math/one_line.h"
#include "model/scene/file_bounds.h"
#include "model/shape/files/float_gltf.h"
#include "model/shape/files/gltf_indices.h"
#include "model/shape/files/gltf_limits.h"
#include "model/shape/files/import_limits.h"
#include "model/shape/files/import_log.h"
#include "model/shape/files/mesh_appearance.h"
#include "model/shape/files/msh_reader.h"
#include "model/shape/files/ply_reader.h"
#include "model/shape/files/stl_reader.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMostParts = UINT16_MAX - 1;  // labels are 16 bits wide, and 0 means empty

[[noreturn]] void fail(const std::string& path, const std::string& what) {
  throw MeshError("mesh file '" + path + "': " + oneLine(what));  // assimp quotes from the file, which may be binary
}

void requireReadableFile(const std::string& path) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (!fs::exists(status)) fail(path, "no such file");
  if (fs::is_directory(status))
    fail(path, "is a directory; accepted: a mesh file (OBJ, STL, PLY, glTF, GLB or Gmsh .msh)");
  if (!fs::is_regular_file(status)) fail(path, "is not a regular file");
  if (fs::file_size(path, code) == 0) fail(path, "is empty (0 bytes)");
}

Eigen::Matrix4d toEigen(const aiMatrix4x4& m) {
  Eigen::Matrix4d out;
  for (unsigned row = 0; row < 4; ++row) {
    for (unsigned col = 0; col < 4; ++col) out(row, col) = static_cast<double>(m[row][col]);
  }
  return out;
}

/// Order of positions by their exact value, so that equal ones become one vertex.
struct LessPosition {
  bool operator()(const Vector3f& a, const Vector3f& b) const {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  }
};

/// Collector of a file's triangles, part by part, which traverses its node tree.
class Gatherer {
 public:
  Gatherer(double unit_scale_m, std::string path, const ImportLimits& limits, bool with_appearance)
      : unit_scale_m_(unit_scale_m), path_(std::move(path)), limits_(limits), with_appearance_(with_appearance) {}

  /// Visits parents before children and children in order, without recursion at any depth.
  void visit(const aiScene& scene) {
    struct Waiting {
      const aiNode* node;
      Eigen::Matrix4d parent;
    };
    MeshAppearance appearance(path_, with_appearance_ ? &scene : nullptr, limits_);
    appearance_ = &appearance;
    std::vector<Waiting> waiting = {{scene.mRootNode, Eigen::Matrix4d::Identity()}};
    while (!waiting.empty()) {
      const aiNode& node = *waiting.back().node;
      const Eigen::Matrix4d pose = waiting.back().parent * toEigen(node.mTransformation);
      waiting.pop_back();
      for (unsigned i = 0; i < node.mNumMeshes; ++i) addPart(*scene.mMeshes[node.mMeshes[i]], node, pose);
      for (unsigned i = node.mNumChildren; i > 0; --i) waiting.push_back({node.mChildren[i - 1], pose});
    }
    appearance.giveTo(mesh);
    report.appearance_notes = appearance.notes();
    appearance_ = nullptr;
  }

  TriangleMesh mesh;
  ImportReport report;

 private:
  void addPart(const aiMesh& source, const aiNode& node, const Eigen::Matrix4d& pose) {
    const std::string name = partName(source, node);
    const std::vector<uint32_t> vertices = weld(source, pose, name);
    const bool mirrored = pose.topLeftCorner<3, 3>().determinant() < 0;
    const size_t before = mesh.triangles.size();
    appearance_->addPart(source, name);
    for (unsigned f = 0; f < source.mNumFaces; ++f) addFace(source, source.mFaces[f], vertices, mirrored);
    if (mesh.triangles.size() == before) {
      appearance_->dropPart();
      ++report.parts_dropped;
      return;
    }
    if (mesh.part_names.size() == kMostParts) throw MeshError("has more than " + std::to_string(kMostParts) + " parts");
    mesh.parts.resize(mesh.triangles.size(), static_cast<uint16_t>(mesh.part_names.size()));
    mesh.part_names.push_back(uniqueName(name));
    ++report.parts;
  }

  /// Returns the name of a part: the node's if it has one mesh; for several, the meshes' own names distinguish them.
  static std::string partName(const aiMesh& source, const aiNode& node) {
    const std::string of_node = node.mName.C_Str(), of_mesh = source.mName.C_Str();
    const bool node_first = node.mNumMeshes == 1 && node.mParent != nullptr && !of_node.empty();
    const std::string& name = node_first || of_mesh.empty() ? of_node : of_mesh;
    return name.empty() ? "part" : name;
  }

  std::string uniqueName(const std::string& name) {
    std::string unique = name;
    int& copies = copies_[name];  // avoids counting from 2 for each of a thousand equal names
    for (copies = std::max(copies, 1); !names_.insert(unique).second;) unique = name + "_" + std::to_string(++copies);
    return unique;
  }

  /// Appends the distinct positions of a part; returns the mesh's vertex for every vertex of the source.
  std::vector<uint32_t> weld(const aiMesh& source, const Eigen::Matrix4d& pose, const std::string& name) {
    std::map<Vector3f, uint32_t, LessPosition> known;
    std::vector<uint32_t> vertices(source.mNumVertices);
    for (unsigned v = 0; v < source.mNumVertices; ++v) {
      const aiVector3D& p = source.mVertices[v];
      const Vector3d moved = (pose * Eigen::Vector4d(p.x, p.y, p.z, 1)).head<3>() * unit_scale_m_;
      const Vector3f position = moved.cast<float>();
      if (!position.allFinite()) {
        throw MeshError("vertex " + std::to_string(v) + " of part '" + name + "' has a non-finite coordinate");
      }
      const auto next = static_cast<uint32_t>(mesh.positions_m.size());
      const auto [found, is_new] = known.try_emplace(position, next);
      if (is_new) mesh.positions_m.push_back(position);
      vertices[v] = found->second;
    }
    return vertices;
  }

  void addFace(const aiMesh& source, const aiFace& face, const std::vector<uint32_t>& vertices, bool mirrored) {
    if (face.mNumIndices == 1) ++report.stray_points;
    if (face.mNumIndices == 2) ++report.stray_lines;
    if (face.mNumIndices != 3) return;
    std::array<uint32_t, 3> triangle;
    std::array<Vector3d, 3> corners_m;
    for (int c = 0; c < 3; ++c) {
      if (face.mIndices[c] >= vertices.size()) throw MeshError("a face refers to a vertex that does not exist");
      triangle[c] = vertices[face.mIndices[c]];
      corners_m[c] = mesh.positions_m[triangle[c]].cast<double>();
    }
    if (mirrored) std::swap(triangle[1], triangle[2]);
    if (hasArea(triangle)) {
      mesh.triangles.push_back(triangle);
      appearance_->addTriangle(source, corners_m, {face.mIndices[0], face.mIndices[1], face.mIndices[2]});
    } else {
      ++report.degenerate_triangles;
    }
  }

  bool hasArea(const std::array<uint32_t, 3>& t) const {
    const Vector3d a = mesh.positions_m[t[0]].cast<double>();
    const Vector3d ab = mesh.positions_m[t[1]].cast<double>() - a;
    const Vector3d ac = mesh.positions_m[t[2]].cast<double>() - a;
    return ab.cross(ac).norm() > kFlat * std::max(ab.squaredNorm(), ac.squaredNorm());
  }

  /// Height over length below which three single-precision points are on one line.
  static constexpr double kFlat = 1e-12;

  double unit_scale_m_;
  std::string path_;
  ImportLimits limits_;
  bool with_appearance_;
  MeshAppearance* appearance_ = nullptr;  ///< while visit() runs
  std::set<std::string> names_;
  std::map<std::string, int> copies_;
};

/// Removes the vertices that only stray points, lines and degenerate triangles used.
void dropUnusedVertices(TriangleMesh& mesh) {
  constexpr uint32_t kUnused = UINT32_MAX;
  std::vector<uint32_t> moved(mesh.positions_m.size(), kUnused);
  std::vector<Vector3f> kept;
  for (auto& triangle : mesh.triangles) {
    for (uint32_t& vertex : triangle) {
      if (moved[vertex] == kUnused) {
        moved[vertex] = static_cast<uint32_t>(kept.size());
        kept.push_back(mesh.positions_m[vertex]);
      }
      vertex = moved[vertex];
    }
  }
  mesh.positions_m.swap(kept);
}

/// Checks faces: a truncated file can have faces without vertices, which make assimp's triangulation abort the process.
void requireVerticesInFaces(const aiScene& scene) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    const bool corrupt = std::any_of(mesh.mFaces, mesh.mFaces + mesh.mNumFaces,
                                     [](const aiFace& face) { return face.mNumIndices == 0; });
    if (corrupt) throw MeshError("is corrupt or truncated: a face has no vertices");
  }
}

/// File access that opens only regular files within the limit, whatever a file refers to: reading a pipe could block
/// without end.
class BoundedFiles : public Assimp::DefaultIOSystem {
 public:
  /// @param made  files that exist in memory only, by path
  BoundedFiles(const ImportLimits& limits, std::map<std::string, std::string> made)
      : limits_(limits), made_(std::move(made)) {}

  bool Exists(const char* file) const override { return made_.count(file) > 0 || !nameOf(file).empty(); }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    const auto made = made_.find(file);
    if (made != made_.end())
      return new Assimp::MemoryIOStream(reinterpret_cast<const uint8_t*>(made->second.data()), made->second.size());
    const std::string name = nameOf(file);
    if (name.empty()) return nullptr;
    requireFileSize(name, limits_);
    return DefaultIOSystem::Open(name.c_str(), mode);
  }

 private:
  /// Returns the regular file of that name, or of that URI as in glTF; empty: there is none.
  static std::string nameOf(const std::string& file) {
    for (const std::string& name : {file, unescaped(file)}) {
      requireWithinBounds(name);
      std::error_code error;
      if (fs::is_regular_file(name, error)) return name;
    }
    return "";
  }

  ImportLimits limits_;
  std::map<std::string, std::string> made_;
};

double trianglesIn(const aiScene& scene) {
  double all = 0;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    all += static_cast<double>(
        std::count_if(mesh.mFaces, mesh.mFaces + mesh.mNumFaces, [](const aiFace& f) { return f.mNumIndices == 3; }));
  }
  return all;
}

/// Returns the scene that assimp reads from a file, with polygons as triangles; it belongs to the importer.
const aiScene& readScene(Assimp::Importer& importer, const std::string& path, const ImportLimits& limits) {
  requireKnownFormat(path, limits);
  GltfFacts gltf;
  if (looksLikeGltf(path)) gltf = requireGltfWithin(path, limits);
  std::map<std::string, std::string> made;
  if (gltf.is_quantised) made = withFloatAttributes(path, limits);
  importer.SetIOHandler(new BoundedFiles(limits, std::move(made)));  // the importer owns it
  const aiScene* scene = nullptr;
  requireVerticesOfFaces(assimpErrorsOf([&] { scene = importer.ReadFile(path, 0); }));
  const bool lost = scene != nullptr ? trianglesIn(*scene) < gltf.triangles
                                     : std::strstr(importer.GetErrorString(), "has no faces") != nullptr;
  if (lost && gltf.triangles > 0) requireGltfIndices(path, limits);
  if (scene != nullptr) {
    requireVerticesInFaces(*scene);
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  }
  if (scene == nullptr)
    throw MeshError((gltf.is_draco
                         ? "requires the extension KHR_draco_mesh_compression and cannot be decompressed; write it "
                           "without: "
                         : "cannot be read: ") +
                    std::string(importer.GetErrorString()));
  if (scene->mRootNode == nullptr) throw MeshError("contains no scene");
  requireScene(*scene, limits);
  return *scene;
}

void gather(const std::string& path, double unit_scale_m, const ImportLimits& limits, Gatherer& gatherer) {
  requireFileSize(path, limits);
  if (isMsh(path)) {
    std::string note;
    gatherer.mesh = readMsh(path, unit_scale_m, limits, note);
    gatherer.report.parts = static_cast<int>(gatherer.mesh.part_names.size());
    return gatherer.report.appearance_notes.push_back(path + ": " + note);
  }
  const bool is_ply = isPly(path);
  if (!is_ply && !isStl(path)) {
    Assimp::Importer importer;
    return gatherer.visit(readScene(importer, path, limits));
  }
  std::unique_ptr<aiScene> scene;
  std::vector<std::string> notes;
  try {
    scene = is_ply ? readPly(path) : readStl(path, notes);
  } catch (const MeshError& error) {
    throw MeshError(std::string("is corrupt or truncated: ") + error.what());
  }
  requireScene(*scene, limits);
  gatherer.visit(*scene);
  for (const std::string& note : notes) gatherer.report.appearance_notes.push_back(path + ": " + note);
}

}  // namespace

std::string ImportReport::text() const {
  TextOut out;
  out << parts << (parts == 1 ? " part" : " parts") << " imported; dropped: " << stray_points << " points, "
      << stray_lines << " lines, " << degenerate_triangles << " degenerate triangles, " << parts_dropped
      << " parts without triangles";
  return out.str();
}

TriangleMesh importMesh(const std::string& path, double unit_scale_m, ImportReport* report, const ImportLimits& limits,
                        bool with_appearance) {
  if (!std::isfinite(unit_scale_m) || unit_scale_m <= 0) {
    fail(path, "unit_scale_m must be a finite number > 0, not " + numberText(unit_scale_m));
  }
  requireWithinBounds(path);
  requireReadableFile(path);
  Gatherer gatherer(unit_scale_m, path, limits, with_appearance);
  try {
    memoryFor<MeshError>("reading it", [&] { gather(path, unit_scale_m, limits, gatherer); });
  } catch (const std::exception& error) {  // assimp's own too
    fail(path, error.what());
  }
  if (gatherer.mesh.triangles.empty()) fail(path, "contains no triangles (" + gatherer.report.text() + ")");
  dropUnusedVertices(gatherer.mesh);
  if (report != nullptr) *report = gatherer.report;
  return std::move(gatherer.mesh);
}

}  // namespace viscera
