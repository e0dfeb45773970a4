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

#include "rviz/sent_surface.h"

namespace Ogre {
class Entity;
class SceneManager;
class SceneNode;
}  // namespace Ogre

namespace viscera::rviz_plugin {

/// A surface as Ogre draws it: one mesh, written over in place; a part, a material and a draw call per body and its
/// walls. Vertices that walls and skin share are smooth by the normals that were sent.
class SurfaceMesh {
 public:
  SurfaceMesh(Ogre::SceneManager* scene, Ogre::SceneNode* node);
  ~SurfaceMesh();
  SurfaceMesh(const SurfaceMesh&) = delete;
  SurfaceMesh& operator=(const SurfaceMesh&) = delete;

  void clear();
  /// @param vertices  of this topology   @param alpha  of the colours of vertices, where they have some; none: they
  /// have those of paint()   @returns whether materials are new: what paint() said is gone
  bool show(const SentTopology& topology, const SurfaceVertices& vertices, bool topology_is_new,
            const std::optional<float>& alpha);
  /// Box around what is shown.
  const Ogre::AxisAlignedBox& bounds() const { return mesh_->getBounds(); }
  /// @param colors  of each part that was shown; alpha below 1 blends, of vertices' colours too
  void paint(const std::vector<Ogre::ColourValue>& colors);

 private:
  void make(size_t parts, bool colored);
  void writeTriangles(const SentTopology& topology);
  void writeVertices(const SurfaceVertices& vertices);
  void writeColors(const std::vector<uint32_t>& colors, float alpha);

  Ogre::SceneManager* const scene_;
  Ogre::SceneNode* const node_;
  const std::string name_;  ///< no other resource's
  Ogre::MeshPtr mesh_;
  Ogre::Entity* entity_ = nullptr;
  std::vector<Ogre::MaterialPtr> materials_;
  Ogre::HardwareVertexBufferSharedPtr positions_, normals_, colors_;
  Ogre::HardwareIndexBufferSharedPtr indices_;
  std::vector<float> unpacked_;
  std::vector<uint32_t> seen_colors_;
  bool colored_ = false;  ///< by vertices
};

}  // namespace viscera::rviz_plugin
