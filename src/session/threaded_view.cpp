// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "session/threaded_view.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

#include "gpu/background.h"
#include "session/inline_view.h"
#include "surface/follow/state_mirror.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

namespace {

constexpr std::chrono::milliseconds kPoll{1};  // polling interval for images that are being drawn

/// Scope in which this thread holds the context.
class Current {
 public:
  explicit Current(gpu::Context& context) : context_(context) {
    if (!context.makeCurrent()) throw GpuError("eglMakeCurrent refuses the context to the thread of the view");
  }
  ~Current() { context_.release(); }
  Current(const Current&) = delete;
  Current& operator=(const Current&) = delete;

 private:
  gpu::Context& context_;
};

/// Appends new results to earlier ones; an older surface is dropped.
void append(Pictures&& from, Pictures& to) {
  if (from.surface) to.surface = std::move(from.surface);
  if (to.images.empty()) {
    to.images.swap(from.images);
    return;
  }
  std::move(from.images.begin(), from.images.end(), std::back_inserter(to.images));
  from.images.clear();
}

/// Reserves memory, so that ticks allocate none.
void reserve(const Scene& scene, RenderRequest& request) {
  for (size_t kind = 0; kind < kPictureKinds; ++kind)
    request.outputs.of(static_cast<PictureKind>(kind)).reserve(scene.cameras.size());
  request.obstacles.reserve(scene.obstacles.size());
  request.cameras.reserve(scene.cameras.size());
}

/// Clears all requests; keeps the memory.
void clear(FrameRequest& outputs) {
  outputs.surface = outputs.strain = outputs.every_image = false;
  for (size_t kind = 0; kind < kPictureKinds; ++kind) outputs.of(static_cast<PictureKind>(kind)).clear();
}

/// Merges requests. @returns number of requests that were there already
size_t add(const FrameRequest& outputs, FrameRequest& to) {
  size_t twice = outputs.surface && to.surface;
  to.surface |= outputs.surface;
  to.strain |= outputs.strain;
  for (size_t kind = 0; kind < kPictureKinds; ++kind) {
    const std::vector<bool>& from = outputs.of(static_cast<PictureKind>(kind));
    std::vector<bool>& into = to.of(static_cast<PictureKind>(kind));
    into.resize(std::max(into.size(), from.size()));
    for (size_t c = 0; c < from.size(); ++c) {
      twice += from[c] && into[c];
      into[c] = into[c] || from[c];
    }
  }
  return twice;
}

}  // namespace

ThreadedView::ThreadedView(const Model& model, const Scene& scene, gpu::Context& context) : context_(context) {
  reserve(scene, request_);
  context_.release();
  try {
    thread_ = std::thread([&] { main(model, scene); });
  } catch (...) {
    (void)context_.makeCurrent();  // back to the caller's thread
    throw;
  }
  Lock lock(mutex_);
  changed_.wait(lock, [this] { return !busy_ || error_; });
  if (!error_) return;
  lock.unlock();
  thread_.join();
  (void)context_.makeCurrent();  // the fault of the view is more informative
  std::rethrow_exception(error_);
}

ThreadedView::~ThreadedView() {
  {
    Lock lock(mutex_);
    changed_.wait(lock, [this] { return order_ == Order::kNone || error_; });
    order_ = Order::kEnd;
  }
  changed_.notify_all();
  thread_.join();
  (void)context_.makeCurrent();  // where EGL refuses, the next user of the context fails and reports it
}

/// Waits on the stepping thread.
template <class Condition>
void ThreadedView::await(Lock& lock, Condition condition) {
  changed_.wait(lock, [&] { return condition() || error_; });
  if (error_) std::rethrow_exception(error_);
}

void ThreadedView::capture(Solver& solver, const RenderRequest& request, Pictures&) {
  if (request.outputs.count() == 0 || !claimSlot(request.outputs)) return;
  solver.snapshot(snapshot_);
  request_.tick = request.tick;
  request_.motions = request.motions;
  request_.obstacles = request.obstacles;
  request_.cameras = request.cameras;
  request_.processes = request.processes;
  request_.overlays = request.overlays;
  request_.arrows = request.arrows;
  request_.marks = request.marks;
  {
    Lock lock(mutex_);
    order_ = Order::kShow;
  }
  changed_.notify_all();
}

/// Claims the slot for the stepping thread, with the requests in it. False if the view is just taking it.
bool ThreadedView::claimSlot(const FrameRequest& outputs) {
  Lock lock(mutex_);
  await(lock, [&] { return order_ == Order::kNone || !(outputs.every_image || request_.outputs.every_image); });
  if (order_ == Order::kTaken) {
    skipped_ += outputs.count();
    return false;
  }
  if (order_ == Order::kShow) {
    skipped_ += add(outputs, request_.outputs);
  } else {
    request_.outputs = outputs;
  }
  order_ = Order::kNone;
  return true;
}

void ThreadedView::collect(Pictures& out, bool wait) {
  Lock lock(mutex_);
  await(lock, [&] { return !wait || (order_ == Order::kNone && !busy_); });
  append(std::move(done_), out);
}

void ThreadedView::reset() {
  Lock lock(mutex_);
  await(lock, [this] { return order_ == Order::kNone && !busy_; });
  order_ = Order::kReset;
  changed_.notify_all();
  await(lock, [this] { return order_ == Order::kNone && !busy_; });
}

ViewCounters ThreadedView::counters() const {
  const Lock lock(mutex_);
  ViewCounters out = counters_;
  out.skipped += skipped_;
  return out;
}

void ThreadedView::main(const Model& model, const Scene& scene) {
  try {
    run(model, scene);
  } catch (...) {
    const Lock lock(mutex_);
    error_ = std::current_exception();
  }
  changed_.notify_all();
}

void ThreadedView::run(const Model& model, const Scene& scene) {
  const Current current(context_);
  gpu::drawInBackground();
  InlineView view(model, scene);
  StateMirror mirror(model);
  RenderRequest request;
  reserve(scene, request);
  RenderRequest between;
  reserve(scene, between);
  view.setPause([&] { pause(view, mirror, between); });
  announce(view, mirror);
  while (true) {
    switch (awaitOrder(request)) {
      case Order::kShow:
        show(view, mirror, request);
        break;
      case Order::kNone:
        handOver(view, mirror, {});
        break;
      case Order::kReset:
        view.reset();
        finish({}, counters_, false);
        break;
      default:
        return;
    }
  }
}

/// Announces that the view is ready for its first order.
void ThreadedView::announce(const InlineView& view, const StateMirror& mirror) {
  {
    const Lock lock(mutex_);
    whole_skin_ = view.wholeSkin();
    snapshot_.bricks = mirror.shownBricks();
    snapshot_.displacement_m.reserve(kBrickFloats * snapshot_.bricks.size());
    busy_ = false;
  }
  changed_.notify_all();
}

bool ThreadedView::canTake() const {
  return order_ == Order::kShow ? !drawing_ || request_.outputs.surface
                                : order_ == Order::kReset || order_ == Order::kEnd;
}

/// @param request  becomes what is to be shown   @returns kNone: nothing, but images are being drawn
ThreadedView::Order ThreadedView::awaitOrder(RenderRequest& request) {
  Lock lock(mutex_);
  if (drawing_) {
    changed_.wait_for(lock, kPoll, [this] { return canTake(); });
  } else {
    changed_.wait(lock, [this] { return canTake(); });
  }
  if (!canTake()) return Order::kNone;
  if (order_ == Order::kShow) take(request);
  return order_ == Order::kTaken ? Order::kShow : order_;
}

/// Takes all requests, or only the surface.
void ThreadedView::take(RenderRequest& request) {
  if (drawing_) {
    request = request_;
    clear(request.outputs);
    request.outputs.surface = std::exchange(request_.outputs.surface, false);
    request.outputs.strain = std::exchange(request_.outputs.strain, false);
  } else {
    std::swap(request, request_);
    clear(request_.outputs);
  }
  order_ = Order::kTaken;
}

void ThreadedView::show(InlineView& view, StateMirror& mirror, const RenderRequest& request) {
  upload(view, mirror);
  Pictures made;
  RenderRequest images = request;
  if (request.outputs.surface && request.outputs.count() > 1) {  // images take longer
    view.showSurface(mirror.view(), request, made);
    finish(std::move(made), view.counters(), true);
    made = {};
    images.outputs.surface = false;
  }
  view.capture(mirror.view(), images, made, mirror.displacements());
  handOver(view, mirror, std::move(made));
}

/// Uploads the state in the slot to the GPU and frees the slot: the next state may come while this one is drawn. Until
/// then remaining requests can be taken.
void ThreadedView::upload(InlineView& view, StateMirror& mirror) {
  mirror.upload(snapshot_);
  view.wound(snapshot_, snapshot_.cut_revision);
  {
    const Lock lock(mutex_);
    order_ = request_.outputs.count() > 0 ? Order::kShow : Order::kNone;
    busy_ = drawing_ = true;
  }
  changed_.notify_all();
}

/// Handles a pause while an image is being drawn; a surface does not wait for it.
void ThreadedView::pause(InlineView& view, StateMirror& mirror, RenderRequest& request) {
  {
    const Lock lock(mutex_);
    if (order_ != Order::kShow || !request_.outputs.surface) return;
    take(request);
  }
  upload(view, mirror);
  Pictures made;
  view.showSurface(mirror.view(), request, made);
  finish(std::move(made), view.counters(), true);
}

/// Delivers what is ready.
void ThreadedView::handOver(InlineView& view, const StateMirror& mirror, Pictures&& made) {
  view.collect(made, false);
  gpu::checkErrors("view");
  ViewCounters counters = view.counters();
  counters.moved_bricks = mirror.movedBricks();
  finish(std::move(made), counters, view.anyInFlight());
}

/// @param drawing  more results will follow
void ThreadedView::finish(Pictures&& made, const ViewCounters& counters, bool drawing) {
  {
    const Lock lock(mutex_);
    append(std::move(made), done_);
    counters_ = counters;
    if (order_ == Order::kReset) order_ = Order::kNone;
    busy_ = drawing_ = drawing;
  }
  changed_.notify_all();
}

}  // namespace viscera
