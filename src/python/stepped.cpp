// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "python/stepped.h"

#include <chrono>

#include "math/archive.h"
#include "session/state_file.h"

namespace viscera::python {

namespace py = pybind11;

namespace {

constexpr auto kSignalsEvery = std::chrono::milliseconds(50);  // Ctrl-C appears immediate to a user

void clear(Stepped::Core& core) {
  core.last = Frame();
  core.nodes.reset();
}

}  // namespace

bool HomeProcess::isHere() const {
  return getpid() == id_;
}

void HomeProcess::require(const char* what) const {
  if (isHere()) return;
  throw Error(std::string(what) + " belongs to process " + std::to_string(id_) +
              ", from which this one was forked without its threads; create another one here, or start processes with "
              "multiprocessing.get_context(\"spawn\")");
}

Stepped::Core::~Core() {
  std::optional<gpu::ContextScope> former;
  if (context) former.emplace();
  session.reset();
  context.reset();
}

Stepped::Stepped(const SceneSource& source, const std::optional<std::string>& backend, int threads, bool pictures) {
  Overrides more;
  if (backend) more.push_back("solver.backend=" + *backend);
  if (threads > 0) more.push_back("solver.threads=" + std::to_string(threads));
  const Scene scene = more.empty() ? source.scene : source.with(more).scene;
  const py::gil_scoped_release released;
  std::optional<gpu::ContextScope> former;
  const auto core = makeHere<Core>();
  if (pictures || scene.solver.backend == Backend::kGpu) {
    former.emplace();
    core->context = std::make_unique<gpu::Context>(scene.solver.device);
    core->session = std::make_unique<Session>(scene, *core->context);
  } else {
    core->session = std::make_unique<Session>(scene);
  }
  core_ = core;
}

void Stepped::close() {
  const std::shared_ptr<Core> last = std::move(core_);
  core_.reset();
}

void Stepped::step(const StylusSamples& samples, int64_t ticks) const {
  with([&](Core& core) {
    auto heard = std::chrono::steady_clock::now();
    const FrameRequest nothing;
    for (int64_t t = 0; t < ticks; ++t) {
      core.nodes.reset();
      core.last = core.session->step(samples, nothing);
      const auto now = std::chrono::steady_clock::now();
      if (now - heard < kSignalsEvery || t + 1 == ticks) continue;
      heard = now;
      hearSignals(core);
    }
  });
}

/// Runs Python's signal handlers between two ticks; they may use the session.
void Stepped::hearSignals(const Core& core) const {
  std::optional<gpu::ContextScope> ours;  // restores the context after they changed it
  if (core.context) ours.emplace();
  const py::gil_scoped_acquire held;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (core_.get() != &core) throw Error("the session was closed during its step");
}

void Stepped::resetCore(Core& core) {
  clear(core);
  core.session->reset();
}

void Stepped::reset() const {
  with(resetCore);
}

std::string Stepped::state() const {
  return with([](Core& core) {
    Archive archive;
    core.session->save(archive);
    return stateBytes(archive.sections());
  });
}

void Stepped::restoreCore(Core& core, const std::string& state) {
  Archive archive(readStateBytes(state, "restore"));
  clear(core);
  core.session->restore(archive, "restore");
}

void Stepped::restore(const std::string& state) const {
  with([&](Core& core) { restoreCore(core, state); });
}

std::shared_ptr<const HostState> Stepped::nodes() const {
  return with([](Core& core) {
    if (!core.nodes) core.nodes = std::make_shared<const HostState>(core.session->solver().readState());
    return core.nodes;
  });
}

std::shared_ptr<const SurfaceFrame> Stepped::skin() const {
  return with([](Core& core) {
    FrameRequest outputs;
    outputs.surface = true;
    Pictures pictures = core.session->show(outputs);
    if (!pictures.surface) throw Error("the skin of tick " + std::to_string(core.session->tick()) + " is missing");
    return std::shared_ptr<const SurfaceFrame>(std::move(pictures.surface));
  });
}

ImageFrame Stepped::picture(size_t camera, PictureKind kind) const {
  return with([&](Core& core) {
    const size_t cameras = core.session->scene().cameras.size();
    if (!core.context)
      throw Error("picture: the session was created without pictures; use Session(scene, pictures=True)");
    if (camera >= cameras)
      throw Error("picture: there is no camera " + std::to_string(camera) + "; the scene has " +
                  std::to_string(cameras));
    FrameRequest outputs;
    outputs.every_image = true;
    outputs.of(kind).resize(cameras);
    outputs.of(kind)[camera] = true;
    Pictures pictures = core.session->show(outputs);
    for (ImageFrame& image : pictures.images) {
      if (image.camera == camera && image.kind == kind) return std::move(image);
    }
    throw Error("picture: camera '" + core.session->scene().cameras[camera].name + "' has no picture of this kind");
  });
}

}  // namespace viscera::python
