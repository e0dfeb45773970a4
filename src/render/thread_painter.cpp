// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/thread_painter.h"

#include <algorithm>
#include <utility>

#include "render/mesh_uniforms.h"
#include "render/shapes/tube.h"
#include "viscera/layout/picture_labels.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

namespace {

constexpr double kLeastRadius_px = 0.75;  // of 1.5 pixels some centre lies in every row or column that it crosses

size_t allVertices(const std::vector<ThreadLook>& threads) {
  size_t out = 0;
  for (const ThreadLook& thread : threads) out += thread.most * tubeVertices(thread.nodes);
  return out + kMostParted * tubeVertices(2);  // both pieces have the node at which a thread is parted
}

/// Triangles of a tube depend on nothing but how many nodes it has, and those of a shorter one come first.
std::vector<uint32_t> longestTube(const std::vector<ThreadLook>& threads) {
  size_t nodes = 0;
  for (const ThreadLook& thread : threads) nodes = std::max(nodes, thread.nodes);
  ToolShape tube;
  addTube(std::vector<Vector3f>(nodes, Vector3f::Zero()), std::vector<float>(nodes), {}, tube);
  return tube.indices;
}

}  // namespace

ThreadPainter::ThreadPainter(std::vector<ThreadLook> threads, const std::vector<std::string>& features)
    : threads_(std::move(threads)),
      program_(gpu::Program::graphics("mesh.vert", "tool.frag", features)),
      vertices_(allVertices(threads_), "threads"),
      indices_(longestTube(threads_), "threads") {
  inputs_.readTools(vertices_.id(), indices_.id());
}

/// The tube of a thread as a camera sees it.
void ThreadPainter::shape(const ThreadLook& thread, const std::vector<Vector3d>& places_m,
                          const Pose& optical_from_tissue, double pixel) {
  points_m_.clear();
  radii_m_.clear();
  tube_.vertices.clear();
  tube_.indices.clear();
  for (const Vector3d& place_m : places_m) {
    const Vector3d at_m = optical_from_tissue * place_m;
    points_m_.push_back(at_m.cast<float>());
    radii_m_.push_back(static_cast<float>(std::max(thread.radius_m, kLeastRadius_px * pixel * at_m.z())));
  }
  addTube(points_m_, radii_m_, thread.color, tube_);
}

/// @param before  (thread) is called first
template <class Before>
void ThreadPainter::drawWith(const gpu::Program& program, const ShownThreads& shown, const Pose& optical_from_tissue,
                             const Eigen::Matrix4f& clip_from_optical, double pixel, Before before) {
  glBindVertexArray(inputs_.id());
  program.use();
  setMeshMatrices(program, Pose{}, clip_from_optical);
  size_t first_vertex = 0;
  for (const ShownThread& piece : shown) {
    const auto look = std::find_if(threads_.begin(), threads_.end(), [&](const ThreadLook& thread) {
      return thread.thread == piece.thread && thread.part == piece.part;
    });
    if (look == threads_.end() || piece.places_m.size() < 2 || piece.places_m.size() > look->nodes) continue;
    shape(*look, piece.places_m, optical_from_tissue, pixel);
    const size_t first = first_vertex;
    first_vertex += tube_.vertices.size();
    vertices_.write(tube_.vertices, first);
    before(*look);
    glDrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(tube_.indices.size()), GL_UNSIGNED_INT, nullptr,
                             static_cast<GLint>(first));
  }
  glBindVertexArray(0);
}

void ThreadPainter::draw(const ShownThreads& shown, const Pose& optical_from_tissue,
                         const Eigen::Matrix4f& clip_from_optical, double pixel) {
  drawWith(program_, shown, optical_from_tissue, clip_from_optical, pixel, [](const ThreadLook&) {});
}

void ThreadPainter::drawGeometry(const gpu::Program& program, const ShownThreads& shown,
                                 const Pose& optical_from_tissue, const Eigen::Matrix4f& clip_from_optical,
                                 double pixel) {
  drawWith(program, shown, optical_from_tissue, clip_from_optical, pixel, [&](const ThreadLook& look) {
    const auto of_thread = static_cast<uint32_t>(layout::kFirstThreadLabel + look.thread);
    program.set("label", look.part == ThreadPart::kClip ? layout::kClipLabel : of_thread);
  });
}

}  // namespace viscera
