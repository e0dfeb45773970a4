// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A process with bound folders reads no scene, no mesh and no file that these refer to from elsewhere.
#include "model/scene/file_bounds.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>

#include "support/temporary_folder.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/scene.h"
#include "viscera/model/shape/mesh_import.h"

namespace viscera {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

/// Word in the files outside that no error may contain.
constexpr const char* kSecret = "s3cret";
constexpr const char* kTetrahedron =
    "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nvt 0 0\n"
    "usemtl m\nf 1/1 3/1 2/1\nf 1/1 2/1 4/1\nf 2/1 3/1 4/1\nf 3/1 1/1 4/1\n";

class FileBounds : public ::testing::Test {
 protected:
  FileBounds() {
    fs::create_directory(inside_);
    fs::create_directory(inside_ + "_too");  // begins with the folder's name
    bindFilesTo({inside_}, "parameter ~scene_folders");
  }
  ~FileBounds() override { bindFilesTo({}, ""); }
  std::string write(const std::string& name, const std::string& text) const { return folder_.write(name, text); }
  std::string scene(const std::string& name, const std::string& keys) const {
    return write(name, "bodies: [{name: a, spacing_m: 0.02, " + keys + "}]\n");
  }
  static void load(const std::string& path) { (void)buildModel(loadScene(path)); }
  /// Expects that the call is refused for `path`, without a hint of its content.
  static void expectRefused(const std::function<void()>& call, const std::string& path) {
    try {
      call();
      ADD_FAILURE() << path << " was read";
    } catch (const Error& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find("parameter ~scene_folders"), std::string::npos) << text;
      EXPECT_NE(text.find(path), std::string::npos) << text;
      EXPECT_EQ(text.find(kSecret), std::string::npos) << text;
    }
  }

  TemporaryFolder folder_;
  std::string inside_ = folder_.file("in"), secret_ = folder_.write("secret.yaml", std::string(kSecret) + ": 1\n");
};

TEST_F(FileBounds, WhatIsInsideIsRead) {
  write("in/a.obj", kTetrahedron);
  load(scene("in/a.yaml", "source: mesh, mesh_file: a.obj"));
  load(inside_ + "/../in/a.yaml");
  fs::create_symlink(inside_, folder_.file("way_in"));
  load(folder_.file("way_in") + "/a.yaml");
}

TEST_F(FileBounds, AnyFileIsReadWhereNothingBinds) {
  bindFilesTo({}, "");
  load(scene("a.yaml", "source: box"));
}

TEST_F(FileBounds, SceneElsewhereIsRefusedThereOrNot) {
  for (const std::string& path : {secret_, folder_.file("absent.yaml"), inside_ + "/../secret.yaml",
                                  scene("in_too/a.yaml", "source: box"), std::string("/etc/passwd")})
    expectRefused([&] { loadScene(path); }, path);
}

TEST_F(FileBounds, LinksThatLeadElsewhereAreRefused) {
  fs::create_symlink(secret_, inside_ + "/link.yaml");
  fs::create_directory_symlink(folder_.path(), inside_ + "/up");
  for (const std::string& path : {inside_ + "/link.yaml", inside_ + "/up/secret.yaml"})
    expectRefused([&] { loadScene(path); }, path);
}

TEST_F(FileBounds, MeshesElsewhereAreRefused) {
  write("a.obj", kTetrahedron);
  write("a.msh", kSecret);
  expectRefused([&] { load(scene("in/a.yaml", "source: mesh, mesh_file: ../a.obj")); }, "../a.obj");
  expectRefused([&] { load(scene("in/a.yaml", "source: mesh, mesh_file: " + folder_.file("no.obj"))); }, "no.obj");
  expectRefused([&] { load(scene("in/a.yaml", "source: mesh, mesh_file: ../a.msh")); }, "../a.msh");
  expectRefused([&] { load(scene("in/a.yaml", "source: box, detail_mesh: ../a.obj")); }, "../a.obj");
}

TEST_F(FileBounds, ScansAndTheirNamesElsewhereAreRefused) {
  const std::string scan =
      "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 1 1 1\nspace: RAS\nspace directions: (9,0,0) (0,9,0) (0,0,9)\n"
      "space origin: (0,0,0)\nencoding: raw\n\n\1";
  write("a.nrrd", scan);
  write("in/a.nrrd", scan);
  expectRefused([&] { load(scene("in/a.yaml", "source: labels, scan: {file: ../a.nrrd}")); }, "../a.nrrd");
  expectRefused([&] { load(scene("in/a.yaml", "source: labels, scan: {file: a.nrrd, names_file: ../secret.yaml}")); },
                "../secret.yaml");
}

TEST_F(FileBounds, WhatAMeshNamesElsewhereIsRefused) {
  write("a.mtl", "newmtl " + std::string(kSecret) + "\n");
  const std::string mesh = write("in/a.obj", "mtllib ../a.mtl\n" + std::string(kTetrahedron));
  expectRefused([&] { importMesh(mesh, 1); }, "../a.mtl");
  write("in/b.mtl", "newmtl m\nmap_Kd ../secret.yaml\n");
  const std::string textured = write("in/b.obj", "mtllib b.mtl\n" + std::string(kTetrahedron));
  ImportReport report;
  expectRefused([&] { importMesh(textured, 1, &report); }, "../secret.yaml");
}

TEST_F(FileBounds, FoldersAreAbsoluteAndThere) {
  for (const std::string& folder : {std::string("."), folder_.file("absent"), secret_}) {
    try {
      bindFilesTo({folder}, "parameter ~scene_folders");
      ADD_FAILURE() << folder;
    } catch (const FileBoundError& error) {
      EXPECT_EQ(std::string(error.what()),
                "parameter ~scene_folders: '" + folder + "' must be the absolute path of an existing folder");
    }
  }
}

}  // namespace
}  // namespace viscera
