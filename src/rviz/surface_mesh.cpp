// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/surface_mesh.h"

#include <OgreEntity.h>
#include <OgreHardwareBufferManager.h>
#include <OgreMaterialManager.h>
#include <OgreMeshManager.h>
#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <OgreSubEntity.h>
#include <OgreSubMesh.h>
#include <OgreTechnique.h>

#include <algorithm>
#include <cmath>

namespace viscera::rviz_plugin {
namespace {

constexpr const char* kGroup = "General";  // Ogre's own resource group, which always exists
constexpr size_t kVectorBytes = 3 * sizeof(float);
// Half of the colour is ambient; the other half is lit by rviz's light, which is at the camera. So the top of a flat
// pad seen at a grazing angle has more than half of the brightness of surfaces that face the camera.
constexpr float kOfEach = 0.5F;
constexpr float kSpecular = 0.15F;  // appears wet, not like plastic
constexpr float kShininess = 30;

/// Uses two passes, one for ambient and one for lit colour: in a single pass, GL applies vertex colours to only one of
/// them.
void makeColored(Ogre::Technique& technique) {
  technique.getPass(0)->setLightingEnabled(false);
  technique.createPass()->setVertexColourTracking(Ogre::TVC_DIFFUSE);
}

size_t withRoom(size_t count) {
  return std::max<size_t>(count + count / 4, 64);
}  // a cut adds some in every tick

std::string uniqueName() {
  static size_t made = 0;
  return "viscera surface " + std::to_string(made++);
}

}  // namespace

SurfaceMesh::SurfaceMesh(Ogre::SceneManager* scene, Ogre::SceneNode* node)
    : scene_(scene), node_(node), name_(uniqueName()) {}

SurfaceMesh::~SurfaceMesh() {
  clear();
}

void SurfaceMesh::clear() {
  if (entity_) scene_->destroyEntity(entity_);
  entity_ = nullptr;
  if (mesh_) Ogre::MeshManager::getSingleton().remove(mesh_->getHandle());
  mesh_.reset();
  for (const Ogre::MaterialPtr& material : materials_)
    Ogre::MaterialManager::getSingleton().remove(material->getHandle());
  materials_.clear();
  positions_.reset();
  normals_.reset();
  colors_.reset();
  indices_.reset();
}

void SurfaceMesh::make(size_t parts, bool colored) {
  clear();
  colored_ = colored;
  mesh_ = Ogre::MeshManager::getSingleton().createManual(name_, kGroup);
  mesh_->sharedVertexData = new Ogre::VertexData;  // the mesh deletes it
  Ogre::VertexDeclaration& layout = *mesh_->sharedVertexData->vertexDeclaration;
  layout.addElement(0, 0, Ogre::VET_FLOAT3, Ogre::VES_POSITION);
  layout.addElement(1, 0, Ogre::VET_FLOAT3, Ogre::VES_NORMAL);
  if (colored) layout.addElement(2, 0, Ogre::VET_UBYTE4_NORM, Ogre::VES_DIFFUSE);
  for (size_t part = 0; part < parts; ++part) {
    Ogre::MaterialPtr material =
        Ogre::MaterialManager::getSingleton().create(name_ + " part " + std::to_string(part), kGroup);
    material->setReceiveShadows(false);
    material->setLightingEnabled(true);
    if (colored) makeColored(*material->getTechnique(0));
    material->setCullingMode(Ogre::CULL_NONE);  // back faces are visible inside a cut
    materials_.push_back(material);
    Ogre::SubMesh* shown = mesh_->createSubMesh();
    shown->useSharedVertices = true;
    shown->setMaterialName(material->getName(), kGroup);
  }
}

bool SurfaceMesh::show(const received::SentTopology& topology, const SurfaceVertices& vertices, bool topology_is_new,
                       const std::optional<float>& alpha) {
  if (topology.triangles.empty()) {
    clear();
    return false;
  }
  const bool colored = alpha && !vertices.colors.empty();
  const bool begins = !mesh_ || materials_.size() != topology.parts.size() || colored != colored_;
  if (begins) make(topology.parts.size(), colored);
  writeVertices(vertices);
  if (colored) writeColors(vertices.colors, *alpha);
  if (begins || topology_is_new) writeTriangles(topology);
  if (begins) {
    mesh_->load();
    entity_ = scene_->createEntity(mesh_);
    node_->attachObject(entity_);
  }
  for (size_t part = 0; part < topology.parts.size(); ++part)
    entity_->getSubEntity(part)->setVisible(topology.parts[part].count > 0);
  node_->needUpdate();
  return begins;
}

void SurfaceMesh::writeTriangles(const received::SentTopology& topology) {
  const size_t count = topology.triangles.size();
  if (!indices_ || indices_->getNumIndexes() < count)
    indices_ = Ogre::HardwareBufferManager::getSingleton().createIndexBuffer(
        Ogre::HardwareIndexBuffer::IT_32BIT, withRoom(count), Ogre::HardwareBuffer::HBU_DYNAMIC_WRITE_ONLY);
  indices_->writeData(0, count * sizeof(uint32_t), topology.triangles.data(), true);
  for (size_t part = 0; part < topology.parts.size(); ++part) {
    Ogre::IndexData& drawn = *mesh_->getSubMesh(part)->indexData;
    drawn.indexBuffer = indices_;
    drawn.indexStart = 3 * topology.parts[part].first;
    drawn.indexCount = 3 * topology.parts[part].count;
  }
}

void SurfaceMesh::writeVertices(const SurfaceVertices& vertices) {
  const size_t count = vertices.normals.size();
  if (!positions_ || positions_->getNumVertices() < count) {
    Ogre::HardwareBufferManager& manager = Ogre::HardwareBufferManager::getSingleton();
    for (Ogre::HardwareVertexBufferSharedPtr* buffer : {&positions_, &normals_})
      *buffer = manager.createVertexBuffer(kVectorBytes, withRoom(count),
                                           Ogre::HardwareBuffer::HBU_DYNAMIC_WRITE_ONLY_DISCARDABLE);
    mesh_->sharedVertexData->vertexBufferBinding->setBinding(0, positions_);
    mesh_->sharedVertexData->vertexBufferBinding->setBinding(1, normals_);
  }
  unpacked_.resize(3 * count);
  Ogre::Vector3 least(vertices.positions_m.data()), most = least;
  for (size_t v = 0; v < count; ++v) {
    const std::array<float, 3> normal = received::normalOf(vertices.normals[v]);
    std::copy(normal.begin(), normal.end(), &unpacked_[3 * v]);
    const Ogre::Vector3 point(&vertices.positions_m[3 * v]);
    least.makeFloor(point);
    most.makeCeil(point);
  }
  positions_->writeData(0, count * kVectorBytes, vertices.positions_m.data(), true);
  normals_->writeData(0, count * kVectorBytes, unpacked_.data(), true);
  mesh_->sharedVertexData->vertexStart = 0;
  mesh_->sharedVertexData->vertexCount = count;
  mesh_->_setBounds(Ogre::AxisAlignedBox(least, most), false);
  mesh_->_setBoundingSphereRadius(std::max(least.length(), most.length()));
}

void SurfaceMesh::writeColors(const std::vector<uint32_t>& colors, float alpha) {
  if (!colors_ || colors_->getNumVertices() < colors.size()) {
    colors_ = Ogre::HardwareBufferManager::getSingleton().createVertexBuffer(
        sizeof(uint32_t), withRoom(colors.size()), Ogre::HardwareBuffer::HBU_DYNAMIC_WRITE_ONLY_DISCARDABLE);
    mesh_->sharedVertexData->vertexBufferBinding->setBinding(2, colors_);
  }
  const uint32_t top = static_cast<uint32_t>(std::lround(255 * alpha)) << 24U;
  seen_colors_.resize(colors.size());
  std::transform(colors.begin(), colors.end(), seen_colors_.begin(),
                 [top](uint32_t color) { return (color >> 1U & 0x7f7f7fU) | top; });  // kOfEach
  colors_->writeData(0, colors.size() * sizeof(uint32_t), seen_colors_.data(), true);
}

void SurfaceMesh::paint(const std::vector<Ogre::ColourValue>& colors) {
  for (size_t part = 0; part < materials_.size() && part < colors.size(); ++part) {
    Ogre::Material& material = *materials_[part];
    const Ogre::ColourValue& color = colors[part];
    const bool blends = color.a < 1;
    material.setAmbient(Ogre::ColourValue::Black);
    material.setSelfIllumination(colored_ ? Ogre::ColourValue::Black : color * kOfEach);
    material.setDiffuse(color.r * kOfEach, color.g * kOfEach, color.b * kOfEach, color.a);
    material.setSpecular(Ogre::ColourValue(kSpecular, kSpecular, kSpecular, color.a));
    material.setShininess(kShininess);
    material.setSceneBlending(blends ? Ogre::SBT_TRANSPARENT_ALPHA : Ogre::SBT_REPLACE);
    material.setDepthWriteEnabled(!blends);
    if (colored_) material.getTechnique(0)->getPass(1)->setSceneBlending(Ogre::SBF_SOURCE_ALPHA, Ogre::SBF_ONE);
  }
}

}  // namespace viscera::rviz_plugin
