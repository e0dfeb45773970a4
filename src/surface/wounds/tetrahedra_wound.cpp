// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/wounds/tetrahedra_wound.h"

#include <algorithm>

#include "surface/skins/keep_room.h"

namespace viscera {

namespace {

template <class Element>
void append(std::vector<Element>& to, const Element& element) {
  keepRoom(to, to.size() + 1);
  to.push_back(element);
}

/// The value of a key in a list that grows with its keys.
uint32_t& knownOf(std::vector<uint32_t>& values, uint32_t key) {
  keepRoom(values, key + 1);
  if (values.size() <= key) values.resize(key + 1, UINT32_MAX);
  return values[key];
}

layout::SkinBinding bindingOf(const TetrahedraPoints::Point& point) {
  layout::SkinBinding out{};
  out.slot0 = point.slots[0];
  out.slot1 = point.slots[1];
  out.slot2 = point.slots[2];
  out.springs = layout::kOneToOneBit;
  const Vector3f w = point.weights.cast<float>(), d = point.offset_m.cast<float>();
  out.weights = {w.x(), w.y(), w.z(), 0};
  out.offset_constant = {d.x(), d.y(), d.z(), 0};
  return out;
}

void setConstantNormal(const Vector3d& normal, layout::SkinBinding& binding) {
  const Vector3f n = normal.cast<float>();
  binding.normal_constant = {n.x(), n.y(), n.z(), 0};
}

}  // namespace

TetrahedraWound::TetrahedraWound(const Skin& skin, const SpringNetwork& network)
    : skin_(skin),
      network_(network),
      index_(network, skin),
      points_(network, index_),
      is_affected_(network.tetrahedra.size()),
      whole_(skin.bindings.size()),
      copies_(skin.bindings.size(), kNone) {
  for (const auto& triangle : skin.mesh.triangles)
    for (const uint32_t vertex : triangle) ++whole_[vertex];
  left_ = whole_;
}

/// What the last update has left in lists by vertex and by tetrahedron.
void TetrahedraWound::forget() {
  for (const uint32_t t : affected_) is_affected_[t] = false;
  for (const uint32_t triangle : replaced_)
    for (const uint32_t vertex : skin_.mesh.triangles[triangle]) left_[vertex] = whole_[vertex];
  for (const uint32_t vertex : copied_) copies_[vertex] = kNone;
  affected_.clear();
  replaced_.clear();
  copied_.clear();
  gaps_.clear();
  added_.clear();
  normals_.clear();
  walls_.clear();
  skin_vertices_.clear();
  wall_vertices_.clear();
}

void TetrahedraWound::update(const layout::NodeBits* nodes, const float* spring_cut) {
  forget();
  points_.update(nodes, spring_cut);
  findAffected();
  showSkin();
  first_wall_ = added_.size();
  addWalls();
}

/// Tetrahedra with a cut edge, and triangles of the skin with one.
void TetrahedraWound::findAffected() {
  for (const uint32_t spring : points_.cutSprings()) {
    for (uint32_t i = index_.of_spring.starts[spring]; i < index_.of_spring.starts[spring + 1]; ++i) {
      const uint32_t t = index_.of_spring.items[i];
      if (is_affected_[t]) continue;
      is_affected_[t] = true;
      append(affected_, t);
    }
  }
  for (const uint32_t t : affected_) {
    for (const uint32_t face : index_.tetrahedra[t].faces) {
      const uint32_t triangle = index_.faces[face].triangle;
      if (triangle == TetrahedraIndex::kNone) continue;
      const auto& springs = index_.triangle_springs[triangle];
      if (std::any_of(springs.begin(), springs.end(), [&](uint32_t spring) { return points_.isCut(spring); }))
        append(replaced_, triangle);
    }
  }
  std::sort(replaced_.begin(), replaced_.end());
  for (const uint32_t triangle : replaced_)
    for (const uint32_t vertex : skin_.mesh.triangles[triangle]) --left_[vertex];
}

void TetrahedraWound::showSkin() {
  const auto& whole = skin_.mesh.triangles;
  keepRoom(triangles_, 3 * whole.size() + 18 * replaced_.size());
  keepRoom(sources_, whole.size() + 6 * replaced_.size());
  triangles_.resize(3 * whole.size());
  sources_.resize(whole.size());
  for (uint32_t t = 0; t < whole.size(); ++t) {
    std::copy(whole[t].begin(), whole[t].end(), triangles_.begin() + 3 * static_cast<ptrdiff_t>(t));
    sources_[t] = t;
  }
  for (const uint32_t triangle : replaced_) showPieces(triangle);
  closeGaps();
}

void TetrahedraWound::showPieces(uint32_t triangle) {
  const auto& springs = index_.triangle_springs[triangle];
  uint32_t cut = 0;
  for (size_t i = 0; i < 3; ++i) cut |= points_.isCut(springs[i]) ? 1U << i : 0U;
  place_is_free_ = true;
  for (const FacePieces::Triangle& piece : facePieces(cut).triangles) {
    if (points_.isGone(skin_.bindings[skin_.mesh.triangles[triangle][piece.corner]].slot0)) continue;
    std::array<uint32_t, 3> corners{};
    for (size_t i = 0; i < 3; ++i) corners[i] = skinVertex(triangle, piece.vertices[i]);
    addPiece(triangle, corners);
  }
  if (place_is_free_) append(gaps_, triangle);
}

/// In the place of the whole triangle if that is free yet, else behind all.
void TetrahedraWound::addPiece(uint32_t triangle, const std::array<uint32_t, 3>& corners) {
  if (place_is_free_) {
    std::copy(corners.begin(), corners.end(), triangles_.begin() + 3 * static_cast<ptrdiff_t>(triangle));
    place_is_free_ = false;
    return;
  }
  triangles_.insert(triangles_.end(), corners.begin(), corners.end());
  sources_.push_back(triangle);
}

/// The last triangles take the places of those of which nothing is shown.
void TetrahedraWound::closeGaps() {
  for (; !gaps_.empty(); gaps_.pop_back()) {  // the highest first: the last triangle is never a gap below
    const auto to = static_cast<ptrdiff_t>(gaps_.back());
    std::copy(triangles_.end() - 3, triangles_.end(), triangles_.begin() + 3 * to);
    sources_[gaps_.back()] = sources_.back();
    triangles_.resize(triangles_.size() - 3);
    sources_.pop_back();
  }
}

Vector3d TetrahedraWound::restNormal(uint32_t own) const {
  const layout::vec4& n = skin_.bindings[own].normal_constant;
  return Vector3f(n.x, n.y, n.z).cast<double>();
}

uint32_t TetrahedraWound::addVertex(uint32_t point, const layout::SkinBinding& binding, uint32_t like) {
  append(added_, Vertex{binding, points_[point].rest_m, points_[point].depth_m, like, point});
  return static_cast<uint32_t>(ownVertices() + added_.size() - 1);
}

/// @param own  the vertex that it looks like   @param turned  its normal turns with the nodes that carry it; else it is
/// the own vertex's in every state
uint32_t TetrahedraWound::addToSkin(uint32_t point, uint32_t own, bool turned) {
  layout::SkinBinding binding = bindingOf(points_[point]);
  setConstantNormal(restNormal(own), binding);
  if (!turned) binding.springs |= own + 1;
  return addVertex(point, binding, own);
}

/// Of a vertex without a whole triangle around it, from which its normal would follow: one that turns with its node.
uint32_t TetrahedraWound::copyOf(uint32_t own) {
  if (copies_[own] != kNone) return copies_[own];
  append(copied_, own);
  return copies_[own] = addToSkin(points_.atNode(skin_.bindings[own].slot0), own, true);
}

uint32_t TetrahedraWound::skinVertex(uint32_t triangle, const FaceVertex& vertex) {
  const auto& corners = skin_.mesh.triangles[triangle];
  const auto& springs = index_.triangle_springs[triangle];
  const uint32_t own = corners[vertex.corner], slot = skin_.bindings[own].slot0;
  const uint32_t face = index_.triangle_faces[triangle];
  switch (vertex.kind) {
    case FaceVertex::kCorner:
      return left_[own] > 0 ? own : copyOf(own);
    case FaceVertex::kLip:
    case FaceVertex::kMiddle: {
      const uint32_t point = vertex.kind == FaceVertex::kLip ? points_.lip(springs[vertex.edge], slot)
                                                             : points_.middle(face, slot, springs);
      uint32_t& known = knownOf(skin_vertices_, point);
      if (known == kNone) known = addToSkin(point, own, left_[own] == 0);
      return known;
    }
    default: {
      const uint32_t point = points_.end(face, springs[vertex.edge]);
      uint32_t& known = knownOf(skin_vertices_, point);
      if (known != kNone) return known;
      known = addToSkin(point, own, true);
      setConstantNormal((restNormal(corners[0]) + restNormal(corners[1]) + restNormal(corners[2])).stableNormalized(),
                        added_.back().binding);
      return known;
    }
  }
}

uint32_t TetrahedraWound::wallVertex(uint32_t point) {
  uint32_t& known = knownOf(wall_vertices_, point);
  if (known != kNone) return known;
  append(normals_, Vector3d(Vector3d::Zero()));
  return known = addVertex(point, bindingOf(points_[point]), kNone);
}

void TetrahedraWound::addWall(const std::array<uint32_t, 3>& corners) {
  const auto rest = [&](size_t i) { return points_[corners[i]].rest_m; };
  const Vector3d normal = (rest(1) - rest(0)).cross(rest(2) - rest(0));
  for (const uint32_t point : corners) {
    const uint32_t vertex = wallVertex(point);
    normals_[vertex - firstWallVertex()] += normal;
    append(walls_, vertex);
  }
}

void TetrahedraWound::addWallsOf(const TetrahedraIndex::Tetrahedron& of) {
  const TetrahedronWalls& walls = tetrahedronWalls(points_.cutEdges(of));
  const auto lengthAcross = [&](uint8_t edge) {
    const auto& ends = kTetrahedronEdges[edge];
    const auto& far = kTetrahedronEdges[5U - edge];
    const uint32_t a = points_.lip(of.springs[edge], of.slots[ends[0]]);
    const uint32_t b = points_.lip(of.springs[5U - edge], of.slots[far[0]]);
    return (points_[a].rest_m - points_[b].rest_m).squaredNorm();
  };
  const bool turned = !walls.others.empty() && lengthAcross(walls.other_diagonal) < lengthAcross(walls.diagonal);
  std::array<uint32_t, 4> centres = {kNone, kNone, kNone, kNone};  // by component
  const auto pointOf = [&](const WallVertex& vertex) {
    if (vertex.kind != WallVertex::kCentre) return points_.onFace(of, vertex);
    uint32_t& centre = centres[vertex.at];
    if (centre == kNone) centre = points_.centre(of, walls.component, vertex.at);
    return centre;
  };
  for (const TetrahedronWalls::Triangle& triangle : turned ? walls.others : walls.triangles) {
    if (points_.isGone(of.slots[triangle.corner])) continue;
    std::array<uint32_t, 3> corners{};
    for (size_t i = 0; i < 3; ++i) corners[i] = pointOf(triangle.vertices[i]);
    addWall(corners);
  }
}

void TetrahedraWound::addWalls() {
  for (const uint32_t t : affected_) addWallsOf(index_.tetrahedra[t]);
  for (size_t v = 0; v < normals_.size(); ++v)
    setConstantNormal(normals_[v].stableNormalized(), added_[first_wall_ + v].binding);
}

}  // namespace viscera
