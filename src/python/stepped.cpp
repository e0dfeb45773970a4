// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "python/stepped.h"

#include <stdlib.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>

namespace viscera::python {

namespace py = pybind11;
namespace fs = std::filesystem;

namespace {

constexpr auto kSignalsEvery = std::chrono::milliseconds(50);  // as fast as a person sees an answer to Ctrl-C

/// A folder of its own for one state, in memory where the machine has such a place: states are read and written as
/// files, which wait for the disk.
class StateFolder {
 public:
  StateFolder() {
    const fs::path top = access("/dev/shm", W_OK) == 0 ? fs::path("/dev/shm") : fs::temp_directory_path();
    std::string name = (top / "viscera-XXXXXX").string();
    if (!mkdtemp(name.data())) throw Error(top.string() + ": no folder for the state can be made here");
    folder_ = name;
  }
  ~StateFolder() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  StateFolder(const StateFolder&) = delete;
  StateFolder& operator=(const StateFolder&) = delete;
  std::string file() const { return (folder_ / "state").string(); }

 private:
  fs::path folder_;
};

void forget(Stepped::Core& core) {
  core.last = Frame();
  core.nodes.reset();
}

}  // namespace

Stepped::Stepped(const SceneSource& source, const std::optional<std::string>& backend, int threads, bool pictures) {
  Overrides more;
  if (backend) more.push_back("solver.backend=" + *backend);
  if (threads > 0) more.push_back("solver.threads=" + std::to_string(threads));
  const Scene scene = more.empty() ? source.scene : source.with(more).scene;
  const py::gil_scoped_release released;
  const auto core = std::make_shared<Core>();
  core->maker = std::this_thread::get_id();
  if (pictures || scene.solver.backend == Backend::kGpu) {
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

void Stepped::step(const StylusSamples& hands, int64_t ticks) const {
  with([&](Core& core) {
    auto heard = std::chrono::steady_clock::now();
    const Wants nothing;
    core.nodes.reset();
    for (int64_t t = 0; t < ticks; ++t) {
      core.last = core.session->step(hands, nothing);
      const auto now = std::chrono::steady_clock::now();
      if (now - heard < kSignalsEvery || t + 1 == ticks) continue;
      heard = now;
      const py::gil_scoped_acquire held;
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
  });
}

void Stepped::resetCore(Core& core) {
  forget(core);
  core.session->reset();
}

void Stepped::reset() const {
  with(resetCore);
}

std::string Stepped::state() const {
  return with([](Core& core) {
    const StateFolder folder;
    core.session->save(folder.file());
    std::ifstream file(folder.file(), std::ios::binary);
    std::string out(fs::file_size(folder.file()), '\0');
    if (!file.read(out.data(), static_cast<std::streamsize>(out.size()))) throw Error("the state cannot be read");
    return out;
  });
}

void Stepped::restoreCore(Core& core, const std::string& state) {
  const StateFolder folder;
  std::ofstream file(folder.file(), std::ios::binary);
  file.write(state.data(), static_cast<std::streamsize>(state.size()));
  file.close();
  if (!file) throw Error("no room for the state in " + folder.file());
  forget(core);
  try {
    core.session->restore(folder.file());
  } catch (const Error& error) {  // the file is ours: nothing to the caller
    std::string text = error.what();
    const std::string name = folder.file();
    if (text.rfind(name, 0) == 0) text = "restore" + text.substr(name.size());
    throw Error(text);
  }
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
    Wants wants;
    wants.surface = true;
    Pictures pictures = core.session->show(wants);
    if (!pictures.surface) throw Error("the skin of tick " + std::to_string(core.session->tick()) + " did not come");
    return std::shared_ptr<const SurfaceFrame>(std::move(pictures.surface));
  });
}

ImageFrame Stepped::picture(size_t camera, PictureKind kind) const {
  return with([&](Core& core) {
    const size_t cameras = core.session->scene().cameras.size();
    if (!core.context) throw Error("picture: the session was made without pictures: Session(scene, pictures=True)");
    if (camera >= cameras) throw Error("picture: camera " + std::to_string(camera) + " of " + std::to_string(cameras));
    Wants wants;
    wants.every_image = true;
    wants.of(kind).resize(cameras);
    wants.of(kind)[camera] = true;
    Pictures pictures = core.session->show(wants);
    for (ImageFrame& image : pictures.images) {
      if (image.camera == camera && image.kind == kind) return std::move(image);
    }
    throw Error("picture: camera '" + core.session->scene().cameras[camera].name + "' has none of this kind");
  });
}

}  // namespace viscera::python
