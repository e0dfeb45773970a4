// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/tube_painter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/mesh_uniforms.h"
#include "render/shapes/tube.h"
#include "viscera/layout/picture_labels.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

namespace {

constexpr double kLeastRadius_px = 0.75;  // 1.5 pixels cover a pixel centre in every row or column that they cross

size_t allVertices(const std::vector<TubeStyle>& sutures) {
  size_t out = 0;
  for (const TubeStyle& suture : sutures) out += suture.most * tubeVertices(suture.nodes);
  return out + kMostParted * tubeVertices(2);  // both pieces have the node at which a suture is cut
}

/// Returns triangles of the longest tube. They depend only on the number of nodes, and those of a shorter tube come
/// first.
std::vector<uint32_t> longestTube(const std::vector<TubeStyle>& sutures) {
  size_t nodes = 0;
  for (const TubeStyle& suture : sutures) nodes = std::max(nodes, suture.nodes);
  ToolShape tube;
  addTube(std::vector<Vector3f>(nodes, Vector3f::Zero()), std::vector<float>(nodes), {}, tube);
  return tube.indices;
}

}  // namespace

TubePainter::TubePainter(std::vector<TubeStyle> sutures, const std::vector<std::string>& features)
    : sutures_(std::move(sutures)),
      program_(gpu::Program::graphics("mesh.vert", "tool.frag", features)),
      vertices_(allVertices(sutures_), "sutures"),
      indices_(longestTube(sutures_), "sutures") {
  inputs_.readTools(vertices_.id(), indices_.id());
}

/// Makes the tube of a suture in the optical frame of a camera.
void TubePainter::shape(const TubeStyle& suture, const VisibleTube& piece, const Pose& optical_from_tissue,
                        double pixel) {
  points_m_.clear();
  radii_m_.clear();
  tube_.vertices.clear();
  tube_.indices.clear();
  const auto nodes = static_cast<double>(piece.positions_m.size());
  for (size_t i = 0; i < piece.positions_m.size(); ++i) {
    const Vector3d at_m = optical_from_tissue * piece.positions_m[i];
    const double off_middle = std::abs(2 * static_cast<double>(i) / (nodes - 1) - 1);
    const double radius_m = suture.radius_m * (piece.waist + off_middle * (1 - piece.waist));
    points_m_.push_back(at_m.cast<float>());
    radii_m_.push_back(static_cast<float>(std::max(radius_m, kLeastRadius_px * pixel * at_m.z())));
  }
  addTube(points_m_, radii_m_, suture.color, tube_);
}

/// Draws all sutures. @param strands  draw them too   @param before  called with each suture first
template <class Before>
void TubePainter::drawWith(const gpu::Program& program, const VisibleTubes& shown, const Pose& optical_from_tissue,
                           const Eigen::Matrix4f& clip_from_optical, double pixel, bool strands, Before before) {
  glBindVertexArray(inputs_.id());
  program.use();
  setMeshMatrices(program, Pose{}, clip_from_optical);
  size_t first_vertex = 0;
  for (const VisibleTube& piece : shown) {
    const auto style = std::find_if(sutures_.begin(), sutures_.end(), [&](const TubeStyle& suture) {
      return suture.suture == piece.suture && suture.part == piece.part;
    });
    if (piece.part == TubeKind::kStrand && !strands) continue;
    if (style == sutures_.end() || piece.positions_m.size() < 2 || piece.positions_m.size() > style->nodes) continue;
    shape(*style, piece, optical_from_tissue, pixel);
    const size_t first = first_vertex;
    first_vertex += tube_.vertices.size();
    vertices_.write(tube_.vertices, first);
    before(*style);
    glDrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(tube_.indices.size()), GL_UNSIGNED_INT, nullptr,
                             static_cast<GLint>(first));
  }
  glBindVertexArray(0);
}

void TubePainter::draw(const VisibleTubes& shown, const Pose& optical_from_tissue,
                       const Eigen::Matrix4f& clip_from_optical, double pixel) {
  drawWith(program_, shown, optical_from_tissue, clip_from_optical, pixel, true, [](const TubeStyle&) {});
}

void TubePainter::drawGeometry(const gpu::Program& program, const VisibleTubes& shown, const Pose& optical_from_tissue,
                               const Eigen::Matrix4f& clip_from_optical, double pixel) {
  drawWith(program, shown, optical_from_tissue, clip_from_optical, pixel, false, [&](const TubeStyle& style) {
    const auto of_suture = static_cast<uint32_t>(layout::kFirstSutureLabel + style.suture);
    program.set("label", style.part == TubeKind::kClip ? layout::kClipLabel : of_suture);
  });
}

}  // namespace viscera
