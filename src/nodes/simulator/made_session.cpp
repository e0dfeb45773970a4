// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulator/made_session.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <future>

#include "viscera/calibration/auto_spacing.h"
#include "viscera/math/error.h"

namespace viscera::nodes {
namespace {

/// The calling thread, and those that it starts, give way to all others of the process. It cannot be taken back.
void giveWay() {
  constexpr int kNice = 5;  // a third of the processor beside a thread that wants all of it
  setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNice);
}

}  // namespace

MadeSession::~MadeSession() {
  if (session && !session->solver().onHost()) (void)context->makeCurrent();  // its buffers end in it
}

void MadeSession::makeModel(const Progress& progress) {
  context = std::make_unique<gpu::Context>(scene.solver.device);
  scene = withChosenSpacing(scene, context.get(), progress);
  model = std::async(std::launch::async, [&] {
            giveWay();
            return std::make_shared<const Model>(buildModel(scene, progress));
          }).get();
}

void MadeSession::makeRest(const Progress& progress) {
  if (!context) context = std::make_unique<gpu::Context>(scene.solver.device);
  if (session) return;
  SessionOptions options;
  options.model = model;
  session = std::make_unique<Session>(scene, *context, progress, options);
}

void MadeSession::give() const {
  // With its state on the host, the session's own thread has the context.
  if (context && (!session || !session->solver().onHost())) context->release();
}

void MadeSession::take() const {
  if (!context || (session && session->solver().onHost())) return;
  if (!context->makeCurrent()) throw GpuError("eglMakeCurrent refuses the context to the thread of the simulation");
}

}  // namespace viscera::nodes
