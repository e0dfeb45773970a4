// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "viscera/layout/limits.h"
#include "viscera/layout/tick_stats.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/scene.h"
#include "viscera/session/frame.h"
#include "viscera/solver/facts.h"
#include "viscera/solver/solver.h"
#include "viscera/solver/threads.h"
#include "viscera/tools/force_limiter.h"
#include "viscera/tools/hands.h"
#include "viscera/tools/obstacles.h"

namespace viscera {

class Archive;
class SessionLog;

/// Work done since the start, for diagnostics. With a view on a thread of its own, its part is that of what was ready.
struct Counters : ViewCounters {
  uint64_t ticks = 0, substeps = 0;
};

/// The worst since the start or the last reset.
struct Extremes {
  double peak_force_n = 0;  ///< largest force on any stylus, before saturation
  double max_stretch = 0;   ///< largest |L - l0| / l0
  double max_speed_m_per_s = 0;
  uint64_t nonfinite = 0;            ///< largest number of non-finite nodes in a tick
  uint64_t crowded = 0;              ///< most nodes that no contact acted on at the end of a tick (TickStats::crowded)
  uint64_t governor_trips = 0;       ///< ticks rolled back
  uint64_t held_back = 0;            ///< ticks in which a stylus was faster than tissue can follow
  uint64_t obstacles_held_back = 0;  ///< ticks, of all obstacles, in which the frame of one was
};

namespace gpu {
class Context;
}
class View;
struct CarriedTissue;

struct SessionOptions {
  /// Where the processor steps: threads that sessions share (makeThreadPool); null: solver.threads of its own.
  std::shared_ptr<ThreadPool> threads = nullptr;
  /// Of the scene, whose spacings are numbers then (withChosenSpacing()), made before by buildModel(); null: made here.
  std::shared_ptr<const Model> model = nullptr;
};

/// ONE loop: owns model, solver and view. All calls come from one thread; steps do not wait for the view.
class Session {
 public:
  /// @param context  current on this thread; the session's until its end, on whichever thread it needs it. Where the
  ///   tissue is stepped on the GPU, it is to be current at every call that steps, shows, saves or restores, and at the
  ///   end (gpu::ContextScope): these throw GpuError where it is not
  /// @throws GpuError, MeshError, LatticeError, SceneError
  Session(const Scene& scene, gpu::Context& context, const Progress& progress = {}, const SessionOptions& options = {});
  /// Without OpenGL: steps on the processor, whatever solver.backend is but gpu. There is the surface to be wanted, and
  /// no image.
  /// @throws MeshError, LatticeError, SceneError; GpuError  the scene asks for the GPU
  explicit Session(const Scene& scene, const Progress& progress = {}, const SessionOptions& options = {});
  ~Session();

  Frame step(const StylusSamples& samples, const Wants& wants);
  /// Where the tf frame that carries an obstacle is from now on: the obstacle goes there over the next tick; the first
  /// pose is no motion. @param obstacle  index in the scene   @param pose  of the frame, tissue frame
  void setObstacleFrame(size_t obstacle, const Pose& pose);
  /// Where the tf frame that carries a camera is from now on. @param camera  < scene().cameras.size(), with a frame
  /// @param pose  of the frame, tissue frame
  void setCameraFrame(size_t camera, const Pose& pose);
  /// What a camera's pictures show beside the tissue from now on; at first, its CameraConfig::overlays.
  /// @param camera  < scene().cameras.size()
  void setOverlays(size_t camera, const Overlays& overlays);
  const Overlays& overlays(size_t camera) const { return look_.overlays[camera]; }
  /// What a stylus does from the next step on with no button pressed, or while one is; stays so over a reset. What it
  /// holds is let go. @param stylus  < scene().styluses.size()
  /// @throws SceneError  the mode cuts or erases, and the scene was made without: no stylus of it did
  void setToolMode(size_t stylus, ToolSwitch when, ToolMode mode);
  /// What the reactions on a stylus are limited to from the next step on. @param stylus  < scene().styluses.size()
  void setForceLimits(size_t stylus, const ForceLimits& limits);
  const ForceLimits& forceLimits(size_t stylus) const { return limiters_[stylus].limits(); }
  void reset();
  /// The hands were not followed for a while, as in a pause: what they hold is let go at the next step, where they
  /// appear again; forces begin at zero.
  void forgetHands();
  /// What there is to see of the last tick, without a step; waits for it.
  Pictures show(const Wants& wants);
  /// Waits for everything asked for so far; images and surface of the last ticks.
  Frame drain();
  uint64_t stateHash() const;
  /// Writes all that the steps to come depend on into a file, which is the old one or the new one whatever happens on
  /// the way. Waits for the last tick, and changes nothing. @throws Error  it cannot be written
  void save(const std::string& path);
  /// Goes on where a session of the same scene was when it was saved: to the same states to the bit, on the same kind
  /// of processor, which solver.threads and cameras do not change. Hands that are where they were then go on too.
  /// @throws Error  no such file, damaged, of another version, scene or backend: nothing is changed, or all is reset
  void restore(const std::string& path);
  /// The same into memory and out of it. @param name  of where the state comes from, for errors
  void save(Archive& archive);
  void restore(Archive& archive, const std::string& name);
  /// Goes on with the state of other lattices of the same bodies, from rest on (carriedState()): what tools did to the
  /// tissue. Nothing is held; threads, clips, burns, blood begin again. @throws Error  the bodies are others
  void carry(const CarriedTissue& tissue);
  /// What another session carries on. Waits for the last tick.
  CarriedTissue carried() const;
  /// Told of all that changes this session from now on, until removeLog().
  void addLog(SessionLog& log) { logs_.push_back(&log); }
  void removeLog(SessionLog& log);
  /// Tells the logs that what follows is judged as a task (docs/lessons/tasks.md); changes nothing of the session
  /// itself, whose measurements it waits for. @param name, yaml  of its file; both empty: it is given up
  void noteTask(const std::string& name, const std::string& yaml);

  const Scene& scene() const { return scene_; }
  const Model& model() const { return *model_; }
  const std::vector<StylusConfig>& styluses() const { return tools_.configs(); }  ///< with the modes that they have now
  /// Triangles of the skin as long as nothing is cut; of a SurfaceFrame, those that are shown in its tick.
  std::shared_ptr<const ShownTopology> wholeSkin() const;
  const Solver& solver() const { return *solver_; }
  /// Reports all that lives in the tissue, after the last step: one group per process of the scene. Typed access to
  /// single processes is in tissue_processes.h.
  FactGroups facts() const;
  void tieThread(size_t piece, const ThreadTie& tie);
  const std::string& backendNote() const { return backend_note_; }  ///< what steps the tissue, and why
  Counters counters() const;
  const Extremes& extremes() const { return extremes_; }
  /// Is the coming step one of those after which this camera, at its rate_hz, has a picture?
  bool imageDue(size_t camera) const;
  const ToolMotions& motions() const { return look_.motions; }  ///< of the last step
  double tick_s() const { return 1.0 / scene_.solver.tick_hz; }
  uint64_t tick() const { return tick_; }

 private:
  /// When the poses of a recent tick came, and where they led the tips.
  struct PoseTimes {
    uint64_t tick = 0;
    std::array<SteadyTime, layout::kMaxStyluses> received{};
    ToolMotions motions;
    SteadyTime newest() const;
  };
  Session(const Scene& scene, gpu::Context* context, const Progress& progress, const SessionOptions& options);
  void persist(Archive& archive);
  void requireContext() const;
  void moveObstacles();
  void lookAtObstacles();
  void lookAtProcesses();
  void lookAtArrows();
  static bool feels(const ToolMotions& motions);
  void heedFeeling(Frame& frame);
  void heedPulls(const Frame& frame);
  std::optional<Between> between(size_t stylus, const StylusMotion& motion, double mouth_rad) const;
  double jawMoment_nm(size_t stylus, const Reaction& raw) const;
  void notePoses(const StylusSamples& samples);
  PoseTimes posesOf(uint64_t tick) const;
  void collect(Frame& frame, bool wait);
  void collectStats(Frame& frame, bool wait);
  TickContact contactOf(size_t stylus, const Reaction& raw) const;
  void releaseUntracked(const ToolMotions& motions, Frame& frame);

  Scene scene_;
  std::shared_ptr<const Model> model_;
  gpu::Context* context_;  ///< null: there is none
  Tools tools_;
  Obstacles obstacles_;
  std::unique_ptr<Solver> solver_;
  std::string backend_note_;
  std::unique_ptr<View> view_;
  Look look_;  ///< of the last tick
  std::vector<ForceLimiter> limiters_;
  layout::TickStats stats_{};
  std::array<Reaction, layout::kMaxStyluses> reactions_;
  std::array<TickContact, layout::kMaxStyluses> contacts_;
  std::array<double, layout::kMaxStyluses> jaw_moments_nm_{};
  std::vector<Reaction> obstacle_forces_;  ///< [obstacles]
  Extremes extremes_;
  bool has_stats_ = false;
  uint64_t tick_ = 0, ticks_ = 0;
  double time_s_ = 0;                  ///< since the start or the last reset
  uint64_t judged_ = 0;                ///< ticks since the start or reset whose measurements have come back
  std::vector<PoseTimes> pose_times_;  ///< of the last ticks, at tick % size
  std::vector<SessionLog*> logs_;
};

}  // namespace viscera
