// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <GL/glew.h>

#include "bench/harness/mapped_body.h"
#include "bench/harness/specimens/specimen.h"
#include "bench/suites/gpu/gpu_parts.h"
#include "gpu/buffer.h"
#include "solver/gpu/gpu_solver.h"
#include "viscera/gpu/context.h"

namespace viscera::bench {

namespace {

/// Returns the free memory of the card [bytes]; 0 if the driver does not report it.
double freeBytes() {
  constexpr GLenum kFreeKilobytes = 0x9049;  // GPU_MEMORY_INFO_CURRENT_AVAILABLE_VIDMEM_NVX
  GLint count = 0, kilobytes = 0;
  glGetIntegerv(GL_NUM_EXTENSIONS, &count);
  for (GLint i = 0; i < count; ++i) {
    const auto* name = reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, static_cast<GLuint>(i)));
    if (std::string(name) == "GL_NVX_gpu_memory_info") glGetIntegerv(kFreeKilobytes, &kilobytes);
  }
  return 1024.0 * kilobytes;
}

/// Returns the buffer size of an object [bytes]. @param make  creates it and returns a pointer
template <class Make>
double bytesOf(const Make& make) {
  const size_t before = gpu::bufferBytes();
  const auto made = make();
  return static_cast<double>(gpu::bufferBytes() - before);
}

}  // namespace

void measureBytes(Report& report) {
  const int edge = report.isShort() ? 22 : 60;
  const double free = freeBytes();
  Table table("OpenGL buffers of the GPU backend",
              {{"of"}, {"count", "", 8}, {"each", "bytes", 4}, {"that fit into what is free", "M", 3}});
  const auto add = [&](const std::string& of, double count, double bytes) {
    table.add({of, count, bytes / count, free > 0 ? Cell(1e-6 * free * count / bytes) : Cell("")});
  };
  const auto solverOf = [](const Model& model, const Scene& scene) {
    return bytesOf([&] { return std::make_unique<GpuSolver>(model, scene); });
  };
  const auto addCube = [&](double poisson_ratio) {
    const MaterialConfig material = withPoisson(specimenMaterial(0.2), poisson_ratio);
    const std::string name = nameOf(material.law);
    report.stage("memory of " + name);
    const Specimen cube = cubeOf(edge, material);
    add("node of a cube, " + name, static_cast<double>(cube.nodes()), solverOf(cube.model, cube.scene));
  };
  addCube(0.25);
  addCube(0.45);
  report.stage("memory of a heart");
  const Scene scene = pigHeartScene(report.isShort() ? 1500 : 42745, 0.2);
  const Model heart = buildModel(scene);
  add("node of a heart of springs with two styluses and the stability monitor",
      static_cast<double>(heart.activeNodes()), solverOf(heart, scene));
  add("face of its skin", static_cast<double>(heart.skinTriangles()),
      bytesOf([&] { return std::make_unique<Surface>(heart); }));
  if (free == 0) report.note("This driver does not report how much memory is free.\n");
  report.add(table, "bytes");
}

}  // namespace viscera::bench
