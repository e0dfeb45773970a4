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

constexpr std::chrono::milliseconds kLook{1};  // how often images that are being drawn are asked for

/// The context is this thread's as long as this lives.
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

/// Moves what there is behind what there was; an older surface is overtaken.
void append(Pictures&& from, Pictures& to) {
  if (from.surface) to.surface = std::move(from.surface);
  if (to.images.empty()) {
    to.images.swap(from.images);
    return;
  }
  std::move(from.images.begin(), from.images.end(), std::back_inserter(to.images));
  from.images.clear();
}

/// So that ticks ask for no memory.
void reserve(const Scene& scene, Look& look) {
  for (size_t kind = 0; kind < kPictureKinds; ++kind)
    look.wants.of(static_cast<PictureKind>(kind)).reserve(scene.cameras.size());
  look.obstacles.reserve(scene.obstacles.size());
  look.cameras.reserve(scene.cameras.size());
}

/// Nothing is wanted; keeps its memory.
void clear(Wants& wants) {
  wants.surface = wants.strain = wants.every_image = false;
  for (size_t kind = 0; kind < kPictureKinds; ++kind) wants.of(static_cast<PictureKind>(kind)).clear();
}

/// @returns how much of it was wanted already
size_t add(const Wants& wants, Wants& to) {
  size_t twice = wants.surface && to.surface;
  to.surface |= wants.surface;
  to.strain |= wants.strain;
  for (size_t kind = 0; kind < kPictureKinds; ++kind) {
    const std::vector<bool>& from = wants.of(static_cast<PictureKind>(kind));
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
  reserve(scene, look_);
  context_.release();
  try {
    thread_ = std::thread([&] { main(model, scene); });
  } catch (...) {
    (void)context_.makeCurrent();  // the caller's again
    throw;
  }
  Lock lock(mutex_);
  changed_.wait(lock, [this] { return !busy_ || error_; });
  if (!error_) return;
  lock.unlock();
  thread_.join();
  (void)context_.makeCurrent();  // what stopped the view says more
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
  (void)context_.makeCurrent();  // where EGL refuses, what needs the context next fails and says so
}

/// Waits, on the stepping thread.
template <class Condition>
void ThreadedView::await(Lock& lock, Condition condition) {
  changed_.wait(lock, [&] { return condition() || error_; });
  if (error_) std::rethrow_exception(error_);
}

void ThreadedView::capture(Solver& solver, const Look& look, Pictures&) {
  if (look.wants.count() == 0 || !claimSlot(look.wants)) return;
  solver.snapshot(snapshot_);
  look_.tick = look.tick;
  look_.motions = look.motions;
  look_.obstacles = look.obstacles;
  look_.cameras = look.cameras;
  look_.processes = look.processes;
  look_.overlays = look.overlays;
  look_.arrows = look.arrows;
  {
    Lock lock(mutex_);
    order_ = Order::kShow;
  }
  changed_.notify_all();
}

/// Makes the slot the stepping thread's, with what is wanted in it. False if the view is just taking it.
bool ThreadedView::claimSlot(const Wants& wants) {
  Lock lock(mutex_);
  await(lock, [&] { return order_ == Order::kNone || !(wants.every_image || look_.wants.every_image); });
  if (order_ == Order::kTaken) {
    skipped_ += wants.count();
    return false;
  }
  if (order_ == Order::kShow) {
    skipped_ += add(wants, look_.wants);
  } else {
    look_.wants = wants;
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
  Look look;
  reserve(scene, look);
  Look between;
  reserve(scene, between);
  view.setPause([&] { pause(view, mirror, between); });
  announce(view, mirror);
  while (true) {
    switch (awaitOrder(look)) {
      case Order::kShow:
        show(view, mirror, look);
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

/// The view is ready for its first order.
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
  return order_ == Order::kShow ? !drawing_ || look_.wants.surface : order_ == Order::kReset || order_ == Order::kEnd;
}

/// @param look  becomes what is to be shown   @returns kNone: nothing, but images are being drawn
ThreadedView::Order ThreadedView::awaitOrder(Look& look) {
  Lock lock(mutex_);
  if (drawing_) {
    changed_.wait_for(lock, kLook, [this] { return canTake(); });
  } else {
    changed_.wait(lock, [this] { return canTake(); });
  }
  if (!canTake()) return Order::kNone;
  if (order_ == Order::kShow) take(look);
  return order_ == Order::kTaken ? Order::kShow : order_;
}

/// All of it, or the surface.
void ThreadedView::take(Look& look) {
  if (drawing_) {
    look = look_;
    clear(look.wants);
    look.wants.surface = std::exchange(look_.wants.surface, false);
    look.wants.strain = std::exchange(look_.wants.strain, false);
  } else {
    std::swap(look, look_);
    clear(look_.wants);
  }
  order_ = Order::kTaken;
}

void ThreadedView::show(InlineView& view, StateMirror& mirror, const Look& look) {
  upload(view, mirror);
  Pictures made;
  Look images = look;
  if (look.wants.surface && look.wants.count() > 1) {  // images take longer
    view.showSurface(mirror.view(), look, made);
    finish(std::move(made), view.counters(), true);
    made = {};
    images.wants.surface = false;
  }
  view.capture(mirror.view(), images, made, mirror.displacements());
  handOver(view, mirror, std::move(made));
}

/// Brings the state in the slot to the GPU and frees the slot: the next may come while this one is drawn. What was left
/// of its wants is there for the taking till then.
void ThreadedView::upload(InlineView& view, StateMirror& mirror) {
  mirror.upload(snapshot_);
  view.wound(snapshot_, snapshot_.cut_revision);
  {
    const Lock lock(mutex_);
    order_ = look_.wants.count() > 0 ? Order::kShow : Order::kNone;
    busy_ = drawing_ = true;
  }
  changed_.notify_all();
}

/// An image is being drawn; a surface does not wait for it.
void ThreadedView::pause(InlineView& view, StateMirror& mirror, Look& look) {
  {
    const Lock lock(mutex_);
    if (order_ != Order::kShow || !look_.wants.surface) return;
    take(look);
  }
  upload(view, mirror);
  Pictures made;
  view.showSurface(mirror.view(), look, made);
  finish(std::move(made), view.counters(), true);
}

/// What is ready.
void ThreadedView::handOver(InlineView& view, const StateMirror& mirror, Pictures&& made) {
  view.collect(made, false);
  gpu::checkErrors("view");
  ViewCounters counters = view.counters();
  counters.moved_bricks = mirror.movedBricks();
  finish(std::move(made), counters, view.anyUnderWay());
}

/// @param drawing  there is more to come
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
