// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <OgreAxisAlignedBox.h>
#include <OgreColourValue.h>
#include <OgreHardwareIndexBuffer.h>
#include <OgreHardwareVertexBuffer.h>
#include <OgreMaterial.h>
#include <OgreMesh.h>

#include <optional>
#include <string>
#include <vector>

#include "nodes/received/sent_surface.h"

namespace Ogre {
class Entity;
class SceneManager;
class SceneNode;
}  // namespace Ogre

namespace viscera::rviz_plugin {

/// Draws a surface with Ogre: one mesh that is updated in place, with a sub-mesh, a material and a draw call for each
/// body and for its cut walls. Vertices shared by cut walls and surface are shaded smoothly with the normals that were
/// sent.
class SurfaceMesh {
 public:
  SurfaceMesh(Ogre::SceneManager* scene, Ogre::SceneNode* node);
  ~SurfaceMesh();
  SurfaceMesh(const SurfaceMesh&) = delete;
  SurfaceMesh& operator=(const SurfaceMesh&) = delete;

  void clear();
  /// Updates the mesh. @param vertices  vertices of this topology
  /// @param alpha  opacity of vertex colours, if there are any; empty: the colours are those of paint()
  /// @returns whether materials were recreated, so that paint() must be called again
  bool show(const received::SentTopology& topology, const SurfaceVertices& vertices, bool topology_is_new,
            const std::optional<float>& alpha);
  /// Returns the bounding box of the mesh.
  const Ogre::AxisAlignedBox& bounds() const { return mesh_->getBounds(); }
  /// Sets the colours. @param colors  [parts of the mesh]; alpha below 1 blends, also with vertex colours
  void paint(const std::vector<Ogre::ColourValue>& colors);

 private:
  void make(size_t parts, bool colored);
  void writeTriangles(const received::SentTopology& topology);
  void writeVertices(const SurfaceVertices& vertices);
  void writeColors(const std::vector<uint32_t>& colors, float alpha);

  Ogre::SceneManager* const scene_;
  Ogre::SceneNode* const node_;
  const std::string name_;  ///< name unique among resources
  Ogre::MeshPtr mesh_;
  Ogre::Entity* entity_ = nullptr;
  std::vector<Ogre::MaterialPtr> materials_;
  Ogre::HardwareVertexBufferSharedPtr positions_, normals_, colors_;
  Ogre::HardwareIndexBufferSharedPtr indices_;
  std::vector<float> unpacked_;
  std::vector<uint32_t> seen_colors_;
  bool colored_ = false;  ///< whether vertices have colours
};

}  // namespace viscera::rviz_plugin
