// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/session/session.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/float_bits.h"
#include "math/vec4.h"
#include "model/scene/tool_kinds.h"
#include "session/arrows.h"
#include "session/view.h"
#include "solver/contact/environment.h"
#include "solver/make_solver.h"
#include "solver/processes/process.h"
#include "surface/marks/mark_board.h"
#include "tools/shaft_meeting.h"
#include "viscera/calibration/auto_spacing.h"
#include "viscera/gpu/context.h"
#include "viscera/math/error.h"
#include "viscera/render/camera.h"
#include "viscera/session/session_log.h"
#include "viscera/session/tissue_processes.h"

namespace viscera {

namespace {

constexpr double kFarthestNode =
    0.867;  // share of a lattice's spacing: no inner point is farther from all nodes, sqrt(3) / 2
constexpr size_t kNotedTicks = 4096;  // images may be this late

gpu::Context& currentOne(gpu::Context& context) {
  context.requireCurrent();
  return context;
}

ToolLimits toolLimits(const Model& model, double tick_hz) {
  ToolLimits limits;
  limits.tick_s = 1 / tick_hz;
  limits.max_travel_m = waveSpeed(model) / tick_hz;
  // Sheets have no inside: where there is nothing else, the radius of the tip is enough.
  limits.feel_radius_m = std::numeric_limits<double>::min();
  for (const Body& body : model.bodies)
    limits.feel_radius_m = std::max(limits.feel_radius_m, kFarthestNode * body.lattice.spacing_m);
  return limits;
}

}  // namespace

Session::Session(const Scene& scene, gpu::Context& context, const Progress& progress, const SessionOptions& options)
    : Session(scene, &currentOne(context), progress, options) {}

Session::Session(const Scene& scene, const Progress& progress, const SessionOptions& options)
    : Session(scene, nullptr, progress, options) {}

/// @param context  null: no OpenGL
Session::Session(const Scene& scene, gpu::Context* context, const Progress& progress, const SessionOptions& options)
    : scene_(options.model ? scene : withChosenSpacing(scene, context, progress)),
      model_(options.model ? options.model : std::make_shared<const Model>(buildModel(scene_, progress))),
      context_(context),
      tools_(scene.styluses, toolLimits(*model_, scene.solver.tick_hz)),
      obstacles_(scene.obstacles, waveSpeed(*model_) / scene.solver.tick_hz),
      pose_times_(kNotedTicks) {
  std::string note;
  if (progress) progress("start the solver", 0);
  solver_ = makeSolver(*model_, scene_, context, options.threads, &note);
  backend_note_ = viscera::backendNote(scene_, context, *solver_, note);
  if (progress) progress("prepare pictures", 0);
  view_ = makeView(*solver_, *model_, scene_, context);
  updateObstacles();
  for (const CameraConfig& camera : scene_.cameras) {
    request_.overlays.push_back(camera.overlays);
    request_.cameras.push_back(opticalPose(camera));
  }
  mark_board_ = std::make_unique<MarkBoard>(*model_);
  showMarks({});
  for (size_t i = 0; i < scene_.marks.size(); ++i) {
    const std::string fault = mark_board_->faultOf(i);
    if (!fault.empty())
      throw SceneError((scene_.file.empty() ? scene_.name : scene_.file) + ": marks[" + std::to_string(i) +
                       "]: " + fault);
  }
  for (const StylusConfig& stylus : scene_.styluses) limiters_.emplace_back(ForceLimits::of(stylus));
  shafts_ = std::make_unique<ShaftMeeting>(scene_.styluses);
  obstacle_forces_.resize(scene_.obstacles.size());
}

/// Deletes OpenGL objects in the context that they were made in, whichever is current. If another thread has that
/// context, they remain until the context ends.
Session::~Session() {
  if (!context_ || !solver_ || solver_->onHost()) return;
  const gpu::ContextScope former;
  const bool current = context_->makeCurrent();
  current ? view_.reset() : void(view_.release());
  current ? solver_.reset() : void(solver_.release());
}

/// Checks that the context is current. @throws GpuError  it is not
void Session::requireContext() const {
  if (context_ && !solver_->onHost()) context_->requireCurrent();
}

Frame Session::step(const StylusSamples& samples, const FrameRequest& outputs) {
  requireContext();
  moveObstacles();
  request_.motions = tools_.advance(samples, [this](size_t s, const StylusMotion& motion, double mouth_rad) {
    return between(s, motion, mouth_rad);
  });                                                                    // VR05 2.7: probe, grab, cut
  solver_->step(tools_.ofHeld(request_.motions), obstacles_.motions());  // VR05 2.4: n substeps
  updateProcesses();
  placeEndoscopes(scene_.cameras, scene_.styluses, request_.motions, request_.cameras);
  request_.tick = ++tick_;
  request_.outputs = outputs;
  updateArrows();
  ++ticks_;
  recordPoses(samples);
  Frame frame;
  view_->capture(*solver_, request_, frame);  // EGVE 3.3: nodes -> vertices, only what is requested
  const bool feeling = feels(request_.motions), gripping = tools_.grips(request_.motions);
  collect(frame, false);
  if (feeling || gripping) collectStats(frame, true);
  if (feeling) detectInside(frame);
  if (gripping) applyGripSlip(frame);
  releaseUntracked(request_.motions, frame);
  for (SessionLog* log : logs_) log->stepped(*this, samples);
  return frame;
}

void Session::removeLog(SessionLog& log) {
  logs_.erase(std::remove(logs_.begin(), logs_.end(), &log), logs_.end());
}

void Session::recordTask(const std::string& name, const std::string& yaml) {
  Frame measured;
  collectStats(measured, true);
  for (SessionLog* log : logs_) log->taskRecorded(*this, name, yaml);
}

bool Session::feels(const ToolMotions& motions) {
  return std::any_of(motions.begin(), motions.end(), [](const StylusMotion& motion) { return motion.feels_m > 0; });
}

Pictures Session::show(const FrameRequest& outputs) {
  requireContext();
  request_.tick = tick_;
  request_.outputs = outputs;
  updateProcesses();  // a saved state may have been restored in between
  updateArrows();
  Pictures out;
  view_->capture(*solver_, request_, out);
  view_->collect(out, true);
  return out;
}

void Session::resetInput() {
  tools_.clear();
  for (ForceLimiter& limiter : limiters_) limiter.reset();
  reactions_ = {};
  contacts_ = {};
  for (PoseTimes& times : pose_times_) times.motions = {};
  for (SessionLog* log : logs_) log->inputCleared();
}

void Session::setToolMode(size_t stylus, ToolSwitch when, ToolMode mode) {
  // model and solver keep no record of cuts if no stylus could cut initially
  if (kindOf(mode).severs() && !maySever(scene_.styluses)) {
    throw SceneError(std::string("mode ") + kindOf(mode).name +
                     ": the scene was loaded without a tool that cuts; give one of its styluses cut or cut_particles "
                     "when it is loaded, as in styluses[0].button2=cut");
  }
  if (kindOf(mode).clips && !mayClip(scene_.styluses)) {
    throw SceneError(
        "mode clip: the scene was loaded without a tool that sets clips; give one of its styluses clip when it is "
        "loaded, as in styluses[0].button1=clip");
  }
  if (kindOf(mode).burns && !mayBurn(scene_.styluses)) {
    throw SceneError(
        "mode cautery: the scene was loaded without a tool that burns; give one of its styluses cautery when it is "
        "loaded, as in styluses[0].button1=cautery");
  }
  tools_.setMode(stylus, when, mode);
  for (SessionLog* log : logs_) log->toolModeSet(stylus, when, mode);
}

void Session::setForceLimits(size_t stylus, const ForceLimits& limits) {
  limiters_[stylus].setLimits(limits);
  for (SessionLog* log : logs_) log->forceLimitsSet(stylus, limits);
}

void Session::setOverlays(size_t camera, const Overlays& overlays) {
  request_.overlays[camera] = overlays;
  for (SessionLog* log : logs_) log->overlaysSet(camera, overlays);
}

void Session::showMarks(const std::vector<MarkConfig>& marks) {
  std::vector<MarkConfig> all = scene_.marks;
  all.insert(all.end(), marks.begin(), marks.end());
  request_.marks = mark_board_->show(all);
}

void Session::setObstacleFrame(size_t obstacle, const Pose& pose) {
  obstacles_.setFrame(obstacle, pose);
  for (SessionLog* log : logs_) log->obstacleFrameSet(obstacle, pose);
}

void Session::setCameraFrame(size_t camera, const Pose& pose) {
  request_.cameras[camera] =
      carriedOpticalPose(scene_.cameras[camera], {pose.position_m, pose.orientation.normalized()});
  for (SessionLog* log : logs_) log->cameraFrameSet(camera, pose);
}

void Session::moveObstacles() {
  obstacles_.advance(time_s_, tick_s());
  time_s_ += tick_s();
  updateObstacles();
}

void Session::updateObstacles() {
  request_.obstacles.clear();
  for (size_t i = 0; i < obstacles_.count(); ++i) {
    request_.obstacles.push_back(obstacles_.pose(i));
    extremes_.obstacles_speed_limited += obstacles_.speedLimited(i);
  }
}

void Session::updateProcesses() {
  request_.processes = {};
  for (const auto& process : solver_->processes()) process->draw(request_.processes);
  auto& paints = request_.processes.paints;
  std::stable_sort(paints.begin(), paints.end(), [](const auto& a, const auto& b) { return a->kind < b->kind; });
}

/// Sets the arrows: forces of the last measured tick, and the present wind.
void Session::updateArrows() {
  request_.arrows.clear();
  bool forces = false, wind = false;
  for (size_t c = 0; c < request_.overlays.size(); ++c) {
    const bool drawn = request_.outputs.image(c) || request_.outputs.image(c, PictureKind::kRight);
    forces |= drawn && request_.overlays[c].has(Overlay::kForces);
    wind |= drawn && request_.overlays[c].has(Overlay::kWind);
  }
  if (forces) addForceArrows(request_.motions, reactions_, request_.arrows);
  if (wind) addWindArrows(windAt(scene_.environment.wind, time_s_), *model_, request_.arrows);
}

/// Sets forces to zero at once for a stylus without a pose, and for tissue in recovery.
void Session::releaseUntracked(const ToolMotions& motions, Frame& frame) {
  for (size_t s = 0; s < limiters_.size(); ++s) {
    frame.speed_limited[s] = motions[s].speed_limited;
    extremes_.speed_limited += motions[s].speed_limited;
    if (motions[s].present && !frame.health.recovering) continue;
    limiters_[s].reset();
    frame.reactions[s] = Reaction{};
    frame.jaw_moments_nm[s] = 0;
    frame.contacts[s] = TickContact{};
    frame.contacts[s].anew = true;
  }
}

SteadyTime Session::PoseTimes::newest() const {
  return *std::max_element(received.begin(), received.end());
}

void Session::recordPoses(const StylusSamples& samples) {
  PoseTimes& times = pose_times_[tick_ % kNotedTicks];
  times.tick = tick_;
  times.motions = request_.motions;
  for (size_t s = 0; s < samples.size(); ++s) times.received[s] = samples[s].valid ? samples[s].received : SteadyTime{};
}

Session::PoseTimes Session::posesOf(uint64_t tick) const {
  const PoseTimes& times = pose_times_[tick % kNotedTicks];
  return times.tick == tick ? times : PoseTimes{};
}

void Session::collect(Frame& frame, bool wait) {
  frame.tick = tick_;
  frame.tools = request_.motions;
  frame.obstacles = request_.obstacles;
  frame.cameras = request_.cameras;
  frame.sutures.clear();
  frame.strands.clear();
  for (const VisibleTube& one : request_.processes.sutures) {
    if (one.part == TubeKind::kStrand) {
      frame.strands.push_back(one);
    } else if (one.part != TubeKind::kNeedle) {
      frame.sutures.push_back(one);
    }
  }
  frame.needles = needleStates(*this);
  frame.marks = request_.marks;
  collectStats(frame, wait);
  view_->collect(frame, wait);
  if (frame.surface) frame.surface->pose_received = posesOf(frame.surface->tick).newest();
  for (ImageFrame& image : frame.images) image.pose_received = posesOf(image.tick).newest();
}

void Session::collectStats(Frame& frame, bool wait) {
  requireContext();
  while (solver_->pollStats(stats_, wait)) {
    has_stats_ = true;
    ++judged_;
    for (SessionLog* log : logs_) log->measured(*this, judged_, stats_);
    shafts_->advance(posesOf(judged_).motions);
    for (size_t s = 0; s < limiters_.size(); ++s) {
      // Force on a tool: minus the momentum it gave the nodes, per tick (physics.md 5).
      Reaction raw{-xyz(stats_.impulse[s]) / tick_s(), -xyz(stats_.angular[s]) / tick_s(), false};
      if (tools_.fingers(s).holds()) raw.torque_nm += tools_.fingers(s).slid_m(request_.motions[s]).cross(raw.force_n);
      jaw_moments_nm_[s] = jawMoment_nm(s, raw);
      shafts_->addTo(s, raw);
      extremes_.peak_force_n = std::max(extremes_.peak_force_n, raw.force_n.norm());
      reactions_[s] = limiters_[s].limit(raw, tick_s());
      contacts_[s] = contactOf(s, raw);
    }
    for (size_t o = 0; o < obstacle_forces_.size(); ++o) {
      obstacle_forces_[o] = {-xyz(stats_.obstacle_impulse[o]) / tick_s(), -xyz(stats_.obstacle_angular[o]) / tick_s(),
                             false};
    }
    extremes_.max_stretch =
        std::max(extremes_.max_stretch, static_cast<double>(floatFromBits(stats_.max_stretch_bits)));
    extremes_.max_speed_m_per_s =
        std::max(extremes_.max_speed_m_per_s, static_cast<double>(floatFromBits(stats_.max_speed_bits)));
    extremes_.nonfinite = std::max<uint64_t>(extremes_.nonfinite, stats_.nonfinite);
    extremes_.crowded = std::max<uint64_t>(extremes_.crowded, stats_.crowded);
  }
  frame.health = solver_->health();
  extremes_.roll_backs = frame.health.trips;
  frame.stats = stats_;
  frame.has_stats = has_stats_;
  frame.reactions = reactions_;
  frame.contacts = contacts_;
  frame.shafts_touch = shafts_->touch();
  frame.jaw_moments_nm = jaw_moments_nm_;
  frame.obstacle_forces = obstacle_forces_;
  frame.poses_received = posesOf(judged_).received;
}

void Session::reset() {
  drain();
  solver_->reset();
  view_->reset();
  tools_.reset();
  obstacles_.reset();
  request_.motions = {};
  for (size_t c = 0; c < scene_.cameras.size(); ++c)
    if (!scene_.cameras[c].stylus.empty()) request_.cameras[c] = opticalPose(scene_.cameras[c]);
  updateObstacles();
  updateProcesses();
  for (ForceLimiter& limiter : limiters_) limiter.reset();
  reactions_ = {};
  contacts_ = {};
  shafts_->reset();
  jaw_moments_nm_ = {};
  obstacle_forces_.assign(obstacle_forces_.size(), Reaction{});
  stats_ = {};
  has_stats_ = false;
  extremes_ = {};
  tick_ = judged_ = 0;
  time_s_ = 0;
  std::fill(pose_times_.begin(), pose_times_.end(), PoseTimes{});
  for (SessionLog* log : logs_) log->wasReset();
}

Frame Session::drain() {
  Frame frame;
  collect(frame, true);
  return frame;
}

uint64_t Session::stateHash() const {
  requireContext();
  uint64_t hash = viscera::stateHash(*model_, solver_->readState());
  const TissueProcesses& processes = solver_->processes();
  // From the last one on, so that fingerprints match those of recordings older than this list.
  for (auto process = processes.rbegin(); process != processes.rend(); ++process) hash = hashWith(hash, **process);
  return hash;
}

std::shared_ptr<const VisibleTopology> Session::wholeSkin() const {
  return view_->wholeSkin();
}

Counters Session::counters() const {
  Counters out;
  static_cast<ViewCounters&>(out) = view_->counters();
  out.ticks = ticks_;
  out.substeps = solver_->substepsDone();
  return out;
}

bool Session::imageDue(size_t camera) const {
  const double per_tick = scene_.cameras[camera].rate_hz * tick_s();
  return std::floor(static_cast<double>(tick_ + 1) * per_tick) != std::floor(static_cast<double>(tick_) * per_tick);
}

}  // namespace viscera
