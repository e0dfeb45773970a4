// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "session/view.h"
#include "viscera/gpu/context.h"

namespace viscera {

struct Scene;

class InlineView;
class StateMirror;

/// A view on a thread of its own, which has the OpenGL context as long as the view lives: for solvers whose state is on
/// the host, so that steps go on while a surface is mapped or an image drawn. The stepping thread copies what is shown
/// of the state, only where something is wanted, into one slot. What is still in the slot when more is wanted is
/// overtaken: the newer state shows what was wanted of either.
///
/// A surface does not wait for images: as long as some are being drawn, the thread takes from the slot what is wanted
/// of the surface, and leaves the rest for later, when it may be of a newer state.
///
/// What goes wrong on the view's thread ends it, and is thrown by every call after that.
class ThreadedView : public View {
 public:
  /// @param model  must outlive the view   @param context  current on this thread; given back at the end
  /// @throws GpuError, SceneError  as InlineView
  ThreadedView(const Model& model, const Scene& scene, gpu::Context& context);
  ~ThreadedView() override;
  ThreadedView(const ThreadedView&) = delete;
  ThreadedView& operator=(const ThreadedView&) = delete;

  void capture(Solver& solver, const Look& look, Pictures& out) override;
  void collect(Pictures& out, bool wait) override;
  void reset() override;
  ViewCounters counters() const override;
  std::shared_ptr<const ShownTopology> wholeSkin() const override { return whole_skin_; }

 private:
  using Lock = std::unique_lock<std::mutex>;
  enum class Order { kNone, kShow, kTaken, kReset, kEnd };

  void main(const Model& model, const Scene& scene);
  void run(const Model& model, const Scene& scene);
  void announce(const InlineView& view, const StateMirror& mirror);
  Order awaitOrder(Look& look);
  void pause(InlineView& view, StateMirror& mirror, Look& look);
  void upload(InlineView& view, StateMirror& mirror);
  bool canTake() const;
  void take(Look& look);
  void show(InlineView& view, StateMirror& mirror, const Look& look);
  void handOver(InlineView& view, const StateMirror& mirror, Pictures&& made);
  void finish(Pictures&& made, const ViewCounters& counters, bool drawing);
  bool claimSlot(const Wants& wants);
  template <class Condition>
  void await(Lock& lock, Condition condition);

  gpu::Context& context_;
  std::shared_ptr<const ShownTopology> whole_skin_;

  // The slot: the stepping thread's while order_ is kNone, the view's from kTaken to kNone; in between it waits.
  StateSnapshot snapshot_;
  Look look_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Order order_ = Order::kNone;
  bool busy_ = true;      ///< the view works on what it has taken from the slot; at first on itself
  bool drawing_ = false;  ///< ... on images, while more may be taken
  Pictures done_;
  ViewCounters counters_;
  uint64_t skipped_ = 0;
  std::exception_ptr error_;
  std::thread thread_;
};

}  // namespace viscera
