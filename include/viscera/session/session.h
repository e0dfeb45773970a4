// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "viscera/api.h"
#include "viscera/layout/limits.h"
#include "viscera/layout/tick_stats.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/scene.h"
#include "viscera/session/frame.h"
#include "viscera/solver/facts.h"
#include "viscera/solver/solver.h"
#include "viscera/solver/threads.h"
#include "viscera/tools/force_limiter.h"
#include "viscera/tools/obstacles.h"
#include "viscera/tools/tools.h"

namespace viscera {  // internal
class Archive;
class ShaftMeeting;
class View;
struct CarriedTissue;
}  // namespace viscera

namespace VISCERA_PUBLIC viscera {

class SessionLog;

/// Work since the start, for diagnostics. With a view on a thread of its own, the view's counters lag by what is not
/// ready yet.
struct Counters : ViewCounters {
  uint64_t ticks = 0, substeps = 0;
};

/// Extreme values since the start or the last reset.
struct Extremes {
  double peak_force_n = 0;  ///< largest force on any stylus, before saturation [N]
  double max_stretch = 0;   ///< largest |L - l0| / l0
  double max_speed_m_per_s = 0;
  uint64_t nonfinite = 0;  ///< largest number of non-finite nodes in a tick
  uint64_t crowded = 0;    ///< largest number of nodes without contact forces at the end of a tick (TickStats::crowded)
  uint64_t roll_backs = 0;     ///< number of ticks rolled back
  uint64_t speed_limited = 0;  ///< number of ticks in which a stylus was faster than tissue can follow
  /// number of ticks, summed over obstacles, in which the frame of one was too fast
  uint64_t obstacles_speed_limited = 0;
};

namespace gpu {
class Context;
}
class MarkBoard;

struct SessionOptions {
  /// CPU threads that step the tissue, shared between sessions (makeThreadPool); null: solver.threads of its own.
  std::shared_ptr<ThreadPool> threads = nullptr;
  /// Model of the scene, made before by buildModel(); the scene then has numbers as spacings (withChosenSpacing()).
  /// Null: built here.
  std::shared_ptr<const Model> model = nullptr;
};

/// Simulation loop that owns model, solver and view. All calls come from one thread; steps do not wait for the view.
class VISCERA_PUBLIC Session {
 public:
  /// Creates a session with OpenGL.
  /// @param context  current on this thread; the session uses it until its end, on whichever thread needs it. Where the
  ///   tissue is stepped on the GPU, it must be current at the end and at every call that steps, shows, saves or
  ///   restores (gpu::ContextScope). These calls throw GpuError where it is not
  /// @throws GpuError, MeshError, LatticeError, SceneError
  Session(const Scene& scene, gpu::Context& context, const Progress& progress = {}, const SessionOptions& options = {});
  /// Creates a session without OpenGL, which steps on the processor; solver.backend must not be gpu. It delivers
  /// surfaces but no images.
  /// @throws MeshError, LatticeError, SceneError; GpuError  the scene asks for the GPU
  explicit Session(const Scene& scene, const Progress& progress = {}, const SessionOptions& options = {});
  ~Session();

  Frame step(const StylusSamples& samples, const FrameRequest& outputs);
  /// Sets the pose of the tf frame that carries an obstacle: the obstacle moves there over the next tick. The first
  /// pose causes no motion. @param obstacle  index in the scene   @param pose  of the frame, tissue frame
  void setObstacleFrame(size_t obstacle, const Pose& pose);
  /// Sets the pose of the tf frame that carries a camera. @param camera  < scene().cameras.size(), with a frame
  /// @param pose  of the frame, tissue frame
  void setCameraFrame(size_t camera, const Pose& pose);
  /// Sets the overlays of a camera's images; initially those of its CameraConfig::overlays.
  /// @param camera  < scene().cameras.size()
  void setOverlays(size_t camera, const Overlays& overlays);
  const Overlays& overlays(size_t camera) const { return request_.overlays[camera]; }
  /// Shows marks on the tissue in addition to those of the scene, from the next step or show() on, until the next call;
  /// a reset keeps them. They change no state. One that meets no surface is not shown.
  void showMarks(const std::vector<MarkConfig>& marks);
  /// Sets the mode of a stylus from the next step on, with no button pressed or while one is; a reset keeps it. The
  /// stylus releases what it holds. @param stylus  < scene().styluses.size()
  /// @throws SceneError  the mode cuts or erases, and the scene was made without: none of its styluses did
  void setToolMode(size_t stylus, ToolSwitch when, ToolMode mode);
  /// Sets the limits of the reactions on a stylus from the next step on. @param stylus  < scene().styluses.size()
  void setForceLimits(size_t stylus, const ForceLimits& limits);
  const ForceLimits& forceLimits(size_t stylus) const { return limiters_[stylus].limits(); }
  void reset();
  /// Discards device input from before a pause. At the next step styluses release what they hold and appear again;
  /// forces begin at zero.
  void resetInput();
  /// Returns the requested outputs of the last tick without a step; waits for them.
  Pictures show(const FrameRequest& outputs);
  /// Waits for all pending requests and returns images and surface of the last ticks.
  Frame drain();
  uint64_t stateHash() const;
  /// Writes everything that later steps depend on to a file. A failure leaves the old file intact. Waits for the last
  /// tick and changes nothing in the session. @throws Error  it cannot be written
  void save(const std::string& path);
  /// Continues where a session of the same scene was saved. On the same kind of processor the states agree to the bit;
  /// solver.threads and cameras do not affect them. Tools continue too if their poses are those of the saved tick.
  /// @throws Error  no such file, or it is damaged or of another version, scene or backend: nothing is changed, or all
  /// is reset
  void restore(const std::string& path);
  /// Saves to memory.
  void save(Archive& archive);
  /// Restores from memory. @param name  source of the state, for errors
  void restore(Archive& archive, const std::string& name);
  /// Continues with the state of other lattices of the same bodies, starting at rest (carriedState()): keeps what tools
  /// did to the tissue. Nothing is held; sutures, clips, burns and blood begin again. @throws Error  the bodies are
  /// others
  void carry(const CarriedTissue& tissue);
  /// Returns what another session continues from. Waits for the last tick.
  CarriedTissue carried() const;
  /// Adds a log of all changes to this session, until removeLog().
  void addLog(SessionLog& log) { logs_.push_back(&log); }
  void removeLog(SessionLog& log);
  /// Reports to the logs that what follows is judged as a task (docs/lessons/tasks.md). Changes nothing in the session,
  /// but waits for its measurements. @param name, yaml  of the task's file; both empty: the task is abandoned
  void recordTask(const std::string& name, const std::string& yaml);

  const Scene& scene() const { return scene_; }
  const Model& model() const { return *model_; }
  const std::vector<StylusConfig>& styluses() const { return tools_.configs(); }  ///< with their present modes
  /// Returns the triangles of the uncut surface mesh; a SurfaceFrame has those that are shown in its tick.
  std::shared_ptr<const VisibleTopology> wholeSkin() const;
  const Solver& solver() const { return *solver_; }
  /// Returns the facts of all processes in the tissue after the last step: one group per process of the scene.
  /// tissue_processes.h gives typed access to single processes.
  FactGroups facts() const;
  void tieSuture(size_t piece, const SutureTie& tie);
  const std::string& backendNote() const { return backend_note_; }  ///< the backend that steps the tissue, and why
  Counters counters() const;
  const Extremes& extremes() const { return extremes_; }
  /// Returns whether this camera, at its rate_hz, has an image after the coming step.
  bool imageDue(size_t camera) const;
  const ToolMotions& motions() const { return request_.motions; }  ///< motions of the last step
  double tick_s() const { return 1.0 / scene_.solver.tick_hz; }
  uint64_t tick() const { return tick_; }

 private:
  /// Times at which the poses of a recent tick were received, and the resulting motions of the tips.
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
  void updateObstacles();
  void updateProcesses();
  void updateArrows();
  static bool feels(const ToolMotions& motions);
  void detectInside(Frame& frame);
  void applyGripSlip(const Frame& frame);
  std::optional<Between> between(size_t stylus, const StylusMotion& motion, double mouth_rad) const;
  double jawMoment_nm(size_t stylus, const Reaction& raw) const;
  void recordPoses(const StylusSamples& samples);
  PoseTimes posesOf(uint64_t tick) const;
  void collect(Frame& frame, bool wait);
  void collectStats(Frame& frame, bool wait);
  TickContact contactOf(size_t stylus, const Reaction& raw) const;
  void releaseUntracked(const ToolMotions& motions, Frame& frame);

  Scene scene_;
  std::shared_ptr<const Model> model_;
  gpu::Context* context_;  ///< null: no OpenGL
  Tools tools_;
  Obstacles obstacles_;
  std::unique_ptr<Solver> solver_;
  std::string backend_note_;
  std::unique_ptr<View> view_;
  std::unique_ptr<MarkBoard> mark_board_;
  RenderRequest request_;  ///< what is shown of the last tick
  std::vector<ForceLimiter> limiters_;
  std::unique_ptr<ShaftMeeting> shafts_;
  layout::TickStats stats_{};
  std::array<Reaction, layout::kMaxStyluses> reactions_;
  std::array<TickContact, layout::kMaxStyluses> contacts_;
  std::array<double, layout::kMaxStyluses> jaw_moments_nm_{};
  std::vector<Reaction> obstacle_forces_;  ///< [obstacles]
  Extremes extremes_;
  bool has_stats_ = false;
  uint64_t tick_ = 0, ticks_ = 0;
  double time_s_ = 0;    ///< time since the start or the last reset [s]
  uint64_t judged_ = 0;  ///< number of ticks since the start or reset with measurements that have come back
  std::vector<PoseTimes> pose_times_;  ///< poses of the last ticks, at tick % size
  std::vector<SessionLog*> logs_;
};

}  // namespace viscera
