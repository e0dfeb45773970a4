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

/// View on a thread of its own, which holds the OpenGL context for the lifetime of the view. It is for solvers with
/// their state on the host, so that steps continue while a surface is mapped or an image drawn. Where something is
/// requested, the stepping thread copies what is shown of the state into one slot. If more is requested while the slot
/// is still full, its state is dropped: the newer state serves both requests.
///
/// A surface does not wait for images: while images are being drawn, the thread takes the surface's requests from the
/// slot. The rest waits, and may then show a newer state.
///
/// An error on the view's thread ends it, and every later call throws it.
class ThreadedView : public View {
 public:
  /// @param model  must outlive the view   @param context  current on this thread; returned at the end
  /// @throws GpuError, SceneError  as InlineView
  ThreadedView(const Model& model, const Scene& scene, gpu::Context& context);
  ~ThreadedView() override;
  ThreadedView(const ThreadedView&) = delete;
  ThreadedView& operator=(const ThreadedView&) = delete;

  void capture(Solver& solver, const RenderRequest& request, Pictures& out) override;
  void collect(Pictures& out, bool wait) override;
  void reset() override;
  ViewCounters counters() const override;
  std::shared_ptr<const VisibleTopology> wholeSkin() const override { return whole_skin_; }

 private:
  using Lock = std::unique_lock<std::mutex>;
  enum class Order { kNone, kShow, kTaken, kReset, kEnd };

  void main(const Model& model, const Scene& scene);
  void run(const Model& model, const Scene& scene);
  void announce(const InlineView& view, const StateMirror& mirror);
  Order awaitOrder(RenderRequest& request);
  void pause(InlineView& view, StateMirror& mirror, RenderRequest& request);
  void upload(InlineView& view, StateMirror& mirror);
  bool canTake() const;
  void take(RenderRequest& request);
  void show(InlineView& view, StateMirror& mirror, const RenderRequest& request);
  void handOver(InlineView& view, const StateMirror& mirror, Pictures&& made);
  void finish(Pictures&& made, const ViewCounters& counters, bool drawing);
  bool claimSlot(const FrameRequest& outputs);
  template <class Condition>
  void await(Lock& lock, Condition condition);

  gpu::Context& context_;
  std::shared_ptr<const VisibleTopology> whole_skin_;

  // The slot: it belongs to the stepping thread while order_ is kNone, to the view from kTaken to kNone; in between it
  // waits.
  StateSnapshot snapshot_;
  RenderRequest request_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Order order_ = Order::kNone;
  bool busy_ = true;      ///< the view works on what it has taken from the slot; initially on its own construction
  bool drawing_ = false;  ///< it works on images, while more may be taken
  Pictures done_;
  ViewCounters counters_;
  uint64_t skipped_ = 0;
  std::exception_ptr error_;
  std::thread thread_;
};

}  // namespace viscera
