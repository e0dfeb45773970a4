// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulator/made_session.h"

#include <ros/console.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <future>

#include "math/one_line.h"
#include "viscera/calibration/auto_spacing.h"
#include "viscera/math/error.h"

namespace viscera::nodes {
namespace {

/// Lowers the priority of the calling thread and of the threads that it starts. This cannot be undone.
void lowerPriority() {
  constexpr int kNice = 5;  // a third of the CPU share of a thread with normal priority
  setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNice);
}

}  // namespace

MadeSession::~MadeSession() {
  if (session && !session->solver().onHost()) (void)context->makeCurrent();  // its buffers are freed in the context
}

/// Creates the context. A scene that does not require the GPU runs without one: on the CPU, and without images.
/// @throws GpuError  the scene requires the GPU
void MadeSession::makeContext() {
  if (context || !no_context.empty()) return;
  try {
    context = std::make_unique<gpu::Context>(scene.solver.device);
  } catch (const GpuError& error) {
    if (scene.solver.backend == Backend::kGpu || scene.solver.device >= 0)
      throw GpuError(error.what() +
                     std::string("; solver.backend: auto without solver.device works without OpenGL, on the "
                                 "CPU and without pictures"));
    no_context = oneLine(error.what());
    ROS_WARN_ONCE("no pictures, and the tissue is stepped on the CPU: %s", no_context.c_str());
  }
}

void MadeSession::makeModel(const Progress& progress) {
  makeContext();
  scene = withChosenSpacing(scene, context.get(), progress);
  model = std::async(std::launch::async, [&] {
            lowerPriority();
            return std::make_shared<const Model>(buildModel(scene, progress));
          }).get();
}

void MadeSession::makeRest(const Progress& progress) {
  makeContext();
  if (session) return;
  SessionOptions options;
  options.model = model;
  session = context ? std::make_unique<Session>(scene, *context, progress, options)
                    : std::make_unique<Session>(scene, progress, options);
}

void MadeSession::give() const {
  // With its state on the host, the session has a thread of its own with the context.
  if (context && (!session || !session->solver().onHost())) context->release();
}

void MadeSession::take() const {
  if (!context || (session && session->solver().onHost())) return;
  if (!context->makeCurrent()) throw GpuError("eglMakeCurrent refuses the context to the thread of the simulation");
}

}  // namespace viscera::nodes
