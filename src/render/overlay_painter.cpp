// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/overlay_painter.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <utility>

#include "math/decompositions.h"
#include "math/number_text.h"
#include "render/mesh_parts.h"
#include "render/mesh_uniforms.h"
#include "render/renderer.h"
#include "render/shapes/lathe.h"

namespace viscera {

namespace {

constexpr std::array<float, 4> kSpringColor = {0.95f, 0.95f, 0.85f, 0.9f}, kNormalColor = {0.35f, 0.75f, 1.0f, 0.95f},
                               kForceColor = {1.0f, 0.85f, 0.2f, 0.95f};  // sRGB
constexpr float kThrough = 0.15f;                                         // alpha behind tissue
constexpr double kNearestDepths = 0.01;  // share of the depth range for arrows, which are in front of all else
constexpr std::array<float, 4> kLegend = {0.82f, -0.94f, 0.97f, -0.30f};  // left, top, right, bottom

/// Returns an arrow of length 1 along +z.
ToolShape unitArrow(const std::array<uint8_t, 4>& color) {
  constexpr float kShaft = 0.03f, kHead = 0.09f, kNeck = 0.78f;
  ToolShape shape;
  const Profile outline = Profile()
                              .line(0, 0, kShaft, 0)
                              .line(kShaft, 0, kShaft, kNeck)
                              .line(kShaft, kNeck, kHead, kNeck)
                              .line(kHead, kNeck, 0, 1);
  addLathe(outline, Eigen::Affine3f::Identity(), color, shape);
  return shape;
}

/// Returns the first four characters of a number such as "0.300", for legend.frag.
std::array<float, 4> digitsOf(double value) {
  const std::string text = fixedText(value, value < 1 ? 3 : 2);
  const char* at = text[0] == '0' ? text.c_str() + 1 : text.c_str();  // ".300", "1.50", "10.0"
  std::array<float, 4> out{};
  for (size_t i = 0; i < out.size(); ++i) {
    out[i] = at[i] == '.' ? 10.0f : static_cast<float>(at[i] - '0');
  }
  return out;
}

void blend() {
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glBlendEquation(GL_FUNC_ADD);
}

}  // namespace

OverlayPainter::OverlayPainter(const Model& model)
    : nodes_(model),
      line_(gpu::Program::graphics("mesh.vert", "overlay_line.frag")),
      strain_(gpu::Program::graphics("mesh.vert", "overlay_strain.frag")),
      arrow_(gpu::Program::graphics("mesh.vert", "tool.frag")),
      legend_(gpu::Program::graphics("legend.vert", "legend.frag")) {
  mesh_inputs_.describe(kPositionInput, kPositionInput, 3, GL_FLOAT, GL_FALSE, 0);
  mesh_inputs_.describe(kNormalInput, kNormalInput, 4, GL_INT_2_10_10_10_REV, GL_TRUE, 0);
  mesh_inputs_.describe(kColorInput, kColorInput, 4, GL_UNSIGNED_BYTE, GL_TRUE, 0);
  line_inputs_.describe(kPositionInput, 0, 3, GL_FLOAT, GL_FALSE, 0);
  std::vector<ToolVertex> vertices;
  std::vector<uint32_t> indices;
  for (const std::array<uint8_t, 4>& color : {std::array<uint8_t, 4>{255, 215, 50, 255}, {120, 200, 255, 255}}) {
    const ToolShape shape = unitArrow(color);
    const auto first = static_cast<uint32_t>(vertices.size());
    for (const uint32_t index : shape.indices) indices.push_back(first + index);
    vertices.insert(vertices.end(), shape.vertices.begin(), shape.vertices.end());
    indices_per_arrow_ = shape.indices.size();
  }
  arrow_vertices_ = gpu::Buffer<ToolVertex>(vertices);
  arrow_indices_ = gpu::Buffer<uint32_t>(indices);
  arrow_inputs_.describe(kPositionInput, 0, 3, GL_FLOAT, GL_FALSE, offsetof(ToolVertex, position_m));
  arrow_inputs_.describe(kNormalInput, 0, 3, GL_FLOAT, GL_FALSE, offsetof(ToolVertex, normal));
  arrow_inputs_.describe(kColorInput, 0, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(ToolVertex, color));
  glVertexArrayVertexBuffer(arrow_inputs_.id(), 0, arrow_vertices_.id(), 0, sizeof(ToolVertex));
  glVertexArrayElementBuffer(arrow_inputs_.id(), arrow_indices_.id());
}

void OverlayPainter::follow(const OverlayStyle& style) {
  if (style.capture != 0 && std::exchange(capture_, style.capture) == style.capture) return;
  nodes_.follow(style.state, *style.surface);
}

void OverlayPainter::drawStrain(const OverlayStyle& style, const MeshView& mesh, const Pose& optical_from_tissue,
                                const Eigen::Matrix4f& clip_from_optical) {
  nodes_.makeColors(*style.surface, style.strain_range);
  glMemoryBarrier(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_ELEMENT_ARRAY_BARRIER_BIT);
  glVertexArrayVertexBuffer(mesh_inputs_.id(), kPositionInput, mesh.positions, 0, 3 * sizeof(float));
  glVertexArrayVertexBuffer(mesh_inputs_.id(), kNormalInput, mesh.normals, 0, sizeof(uint32_t));
  glVertexArrayVertexBuffer(mesh_inputs_.id(), kColorInput, nodes_.colors().id(), 0, sizeof(uint32_t));
  glBindVertexArray(mesh_inputs_.id());
  strain_.use();
  setMeshMatrices(strain_, optical_from_tissue, clip_from_optical);
  drawParts(mesh, mesh_inputs_, [](const IndexRun&) {});
  glBindVertexArray(0);
}

void OverlayPainter::draw(const OverlayStyle& style, int supersampling, const Pose& optical_from_tissue,
                          const Eigen::Matrix4f& clip_from_optical) {
  if (style.shown.has(Overlay::kForces) || style.shown.has(Overlay::kWind))
    drawArrows(style, optical_from_tissue, clip_from_optical);
  blend();
  glDepthMask(GL_FALSE);
  std::array<float, 2> widths{};
  glGetFloatv(GL_ALIASED_LINE_WIDTH_RANGE, widths.data());
  glLineWidth(std::clamp(static_cast<float>(supersampling), widths[0], widths[1]));
  setMeshMatrices(line_, optical_from_tissue, clip_from_optical);
  if (style.shown.has(Overlay::kLattice) || style.shown.has(Overlay::kSprings)) drawSprings(style);
  if (style.shown.has(Overlay::kNormals)) {
    nodes_.makeNormals(style.state, *style.surface);
    drawSpikes(nodes_.normals(), kNormalColor);
  }
  if (style.shown.has(Overlay::kForces) && nodes_.anyForces()) {
    nodes_.makeForces(*style.surface);
    drawSpikes(nodes_.forces(), kForceColor);
  }
  glLineWidth(1);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  glBindVertexArray(0);
}

/// Draws what is in front of the tissue, then faintly what is behind it.
template <class DrawLines>
void OverlayPainter::drawThrough(const Color& color, DrawLines drawLines) {
  line_.use();
  glVertexAttrib3f(kNormalInput, 0, 0, 0);
  glVertexAttrib4f(kColorInput, color[0], color[1], color[2], color[3]);
  glDepthFunc(GL_LEQUAL);
  drawLines();
  glVertexAttrib4f(kColorInput, color[0], color[1], color[2], kThrough);
  glDepthFunc(GL_GREATER);
  drawLines();
  glDepthFunc(GL_LESS);
}

void OverlayPainter::drawSprings(const OverlayStyle& style) {
  const size_t count = nodes_.makeLines(style.state, style.shown.has(Overlay::kSprings));
  glMemoryBarrier(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_ELEMENT_ARRAY_BARRIER_BIT);
  glVertexArrayVertexBuffer(line_inputs_.id(), 0, nodes_.nodes().id(), 0, sizeof(layout::vec4));
  glVertexArrayElementBuffer(line_inputs_.id(), nodes_.lines().id());
  glBindVertexArray(line_inputs_.id());
  drawThrough(kSpringColor, [&] { glDrawElements(GL_LINES, static_cast<GLsizei>(count), GL_UNSIGNED_INT, nullptr); });
}

void OverlayPainter::drawSpikes(const gpu::Buffer<layout::vec4>& ends, const Color& color) {
  glMemoryBarrier(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
  glVertexArrayVertexBuffer(line_inputs_.id(), 0, ends.id(), 0, sizeof(layout::vec4));
  glBindVertexArray(line_inputs_.id());
  drawThrough(color, [&] { glDrawArrays(GL_LINES, 0, static_cast<GLsizei>(ends.size())); });
}

void OverlayPainter::drawArrows(const OverlayStyle& style, const Pose& optical_from_tissue,
                                const Eigen::Matrix4f& clip_from_optical) {
  glBindVertexArray(arrow_inputs_.id());
  arrow_.use();
  glDepthRange(0, kNearestDepths);
  for (const Arrow& arrow : *style.arrows) {
    const bool force = arrow.kind == Arrow::Kind::kForce;
    const double length = arrow.along_m.norm();
    if (!style.shown.has(force ? Overlay::kForces : Overlay::kWind) || !(length > 0)) continue;
    Eigen::Matrix4f placed =
        poseMatrix(optical_from_tissue * Pose{arrow.from_m, rotationBetween(Vector3d::UnitZ(), arrow.along_m)});
    placed.topLeftCorner<3, 3>() *= static_cast<float>(length);
    arrow_.setMatrix("optical_from_mesh", placed.data());
    arrow_.setMatrix("clip_from_optical", clip_from_optical.data());
    const size_t first = force ? 0 : indices_per_arrow_;
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(indices_per_arrow_), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(first * sizeof(uint32_t)));
  }
  glDepthRange(0, 1);
  glBindVertexArray(0);
}

void OverlayPainter::drawLegend(double strain_range) {
  blend();
  glDisable(GL_DEPTH_TEST);
  glBindVertexArray(no_inputs_.id());
  legend_.use();
  legend_.setVectors("position", kLegend.data(), 4, 1);
  legend_.setVectors("digits", digitsOf(strain_range).data(), 4, 1);
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  glEnable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glBindVertexArray(0);
}

}  // namespace viscera
