// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "python/stepped_vector.h"

#include <algorithm>
#include <chrono>
#include <numeric>

#include "math/processors.h"

namespace viscera::python {

namespace py = pybind11;

namespace {

using SteadyClock = std::chrono::steady_clock;
constexpr std::chrono::nanoseconds kVectorSignalsEvery{50'000'000};  // Ctrl-C appears immediate to a user

std::shared_ptr<Stepped::Core> coreOf(const Scene& scene, const SessionOptions& options) {
  auto core = makeHere<Stepped::Core>();
  core->session = std::make_unique<Session>(scene, Progress{}, options);
  return core;
}

/// Runs work; errors name the session.
template <class Work>
void numbered(size_t session, const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    throw Error("session " + std::to_string(session) + ": " + error.what());
  }
}

}  // namespace

SteppedVector::SteppedVector(const SceneSource& source, size_t sessions, int threads) {
  const py::gil_scoped_release released;
  const auto group = makeHere<Group>();
  SessionOptions options;
  options.threads = makeThreadPool(1);  // no thread except the caller
  group->cores.push_back(coreOf(source.scene, options));
  const std::shared_ptr<Stepped::Core> first = group->cores[0];
  options.model = {first, &first->session->model()};
  while (group->cores.size() < sessions) group->cores.push_back(coreOf(first->session->scene(), options));
  const int there = threads > 0 ? threads : usableProcessors();
  group->threads = makeThreadPool(std::clamp(there, 1, static_cast<int>(sessions)));
  group->styluses = first->session->styluses().size();
  group_ = group;
}

std::shared_ptr<const SteppedVector::Group> SteppedVector::group() const {
  const std::shared_ptr<const Group> out = group_;
  if (!out) throw Error("the sessions are closed");
  out->cores[0]->home.require("the vector of sessions");
  return out;
}

void SteppedVector::step(const std::vector<StylusSamples>& samples, std::vector<int64_t> left) const {
  const std::shared_ptr<const Group> group = this->group();
  const py::gil_scoped_release released;
  const size_t sessions = group->cores.size();
  const auto share = kVectorSignalsEvery * group->threads->threads() / static_cast<int>(sessions);
  const FrameRequest nothing;
  std::vector<size_t> waiting(sessions);
  std::iota(waiting.begin(), waiting.end(), size_t{0});
  const auto done = [&](size_t s) { return left[s] <= 0; };
  waiting.erase(std::remove_if(waiting.begin(), waiting.end(), done), waiting.end());
  while (!waiting.empty()) {
    (*group->threads)(waiting.size(), [&](size_t w) {
      const size_t s = waiting[w];
      Stepped::Core& core = *group->cores[s];
      const std::lock_guard<std::recursive_mutex> lock(core.mutex);
      const auto until = SteadyClock::now() + share;
      core.nodes.reset();
      numbered(s, [&] {
        do core.last = core.session->step(samples[s], nothing);
        while (--left[s] > 0 && SteadyClock::now() < until);
      });
    });
    waiting.erase(std::remove_if(waiting.begin(), waiting.end(), done), waiting.end());
    if (waiting.empty()) return;
    const py::gil_scoped_acquire held;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (group_ != group) throw Error("the sessions were closed during their step");
  }
}

void SteppedVector::each(const std::vector<size_t>& which,
                         const std::function<void(Stepped::Core&, size_t)>& work) const {
  const std::shared_ptr<const Group> group = this->group();
  const py::gil_scoped_release released;
  (*group->threads)(which.size(), [&](size_t w) {
    Stepped::Core& core = *group->cores[which[w]];
    const std::lock_guard<std::recursive_mutex> lock(core.mutex);
    numbered(which[w], [&] { work(core, which[w]); });
  });
}

}  // namespace viscera::python
