// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulator/simulator_services.h"

#include <cmath>
#include <functional>
#include <utility>

#include "export/writers.h"
#include "math/nearest_names.h"
#include "math/number_text.h"
#include "model/scene/tool_kinds.h"
#include "nodes/input/stylus_mailbox.h"
#include "nodes/ros/conversions.h"
#include "tasks/attempt.h"
#include "viscera/math/error.h"
#include "viscera/session/session.h"
#include "viscera/session/tissue_processes.h"

namespace viscera::nodes {
namespace {

constexpr std::chrono::seconds kTriggerLimit{10};  ///< enough for a slow tick and a reset
constexpr std::chrono::seconds kStepLimit{60};
constexpr uint32_t kServices = 14;  ///< number of services, with one thread each

/// Waits for the result of a command.
template <class Response>
void answer(CommandQueue& commands, Command&& command, Response& response) {
  const CommandAnswer answer = commands.call(std::move(command), kTriggerLimit);
  response.success = answer.success;
  response.message = answer.message;
}

size_t indexOf(const std::string& stylus, const std::vector<StylusConfig>& styluses) {
  size_t s = 0;
  while (s < styluses.size() && styluses[s].name != stylus) ++s;
  return s;
}

/// Returns the index of a stylus. @throws Error  the scene has no such stylus
size_t stylusNamed(const std::string& name, const std::vector<StylusConfig>& styluses) {
  const size_t s = indexOf(name, styluses);
  if (s < styluses.size()) return s;
  std::vector<std::string> known;
  for (const StylusConfig& stylus : styluses) known.push_back(stylus.name);
  throw Error("stylus: the scene has no stylus '" + name + "'; it has " +
              (known.empty() ? "none" : nearestFirstText(name, known)));
}

/// Returns a switch by name. @throws Error  another word than idle, button1, button2
ToolSwitch switchNamed(const std::string& name) {
  if (name == "idle") return ToolSwitch::kIdle;
  if (name == "button1") return ToolSwitch::kButton1;
  if (name == "button2") return ToolSwitch::kButton2;
  throw Error("which: '" + name + "' is not one of idle, button1, button2");
}

/// Returns a mode by name. @throws Error  no kind of tool has this mode
ToolMode modeNamed(const std::string& name) {
  std::vector<std::string> known;
  for (const ToolKind& kind : kToolKinds) {
    if (name == kind.name) return kind.mode;
    known.emplace_back(kind.name);
  }
  throw Error("mode: '" + name + "' is not one of " + nearestFirstText(name, known));
}

/// Returns the index of a piece. @throws Error  there is no such suture or piece
size_t pieceNamed(const Session& session, const std::string& name, uint32_t which) {
  const std::vector<SutureConfig>& sutures = session.scene().sutures;
  uint32_t pieces = 0;
  for (size_t p = 0; p < suturePieces(session); ++p) {
    if (sutures[sutureOf(session, p)].name == name && pieces++ == which) return p;
  }
  if (pieces > 0)
    throw Error("piece: suture '" + name + "' has " + std::to_string(pieces) + (pieces == 1 ? " piece" : " pieces") +
                ", but no piece " + std::to_string(which));
  std::string known;
  for (const SutureConfig& suture : sutures) known += (known.empty() ? "" : ", ") + suture.name;
  throw Error("suture: the scene has no suture '" + name + "'; it has " + (known.empty() ? "none" : known));
}

/// Returns a value within a range. @throws Error  it is out of range
double within(const char* key, double value, double low, double high) {
  if (value >= low && value <= high) return value;
  throw Error(std::string(key) + ": " + numberText(value) + " must be " + numberText(low) + " .. " + numberText(high));
}

/// Returns the samples that a step moves to. @throws Error  an unknown name, a repeated name, an invalid pose
StylusSamples samplesOf(const std::vector<StylusState>& states, const std::vector<StylusConfig>& styluses) {
  StylusSamples samples;
  for (const StylusState& state : states) {
    const size_t s = indexOf(state.stylus, styluses);
    if (s == styluses.size()) throw Error("styluses: the scene has no stylus '" + state.stylus + "'");
    if (samples[s].valid) throw Error("styluses: '" + state.stylus + "' is given twice");
    Pose pose = fromMessage(state.pose);
    if (!isFinite(pose) || !isUnit(pose.orientation))
      throw Error("styluses: the pose of '" + state.stylus + "' must be finite, with a quaternion of length 1");
    pose.orientation.normalize();
    if (!(pose.position_m.norm() <= styluses[s].workspace_m))
      throw Error("styluses: '" + state.stylus + "' is farther than workspace_m from the tissue frame");
    if (state.has_jaw && !(state.jaw_rad >= 0 && state.jaw_rad <= kWidestJaw_rad))
      throw Error("styluses: jaw_rad of '" + state.stylus + "' must be 0 .. 3.1416 rad");
    samples[s] = {true, pose, static_cast<bool>(state.button1), static_cast<bool>(state.button2),
                  state.has_jaw ? state.jaw_rad : kNoJaw};
  }
  return samples;
}

std::string saveSurface(Session& session, const std::string& path) {
  FrameRequest outputs;
  outputs.surface = true;
  const std::unique_ptr<SurfaceFrame> skin = session.show(outputs).surface;
  if (!skin) throw Error("the skin of tick " + std::to_string(session.tick()) + " is missing");
  writeSkin(session, *skin, path);
  return path;
}

}  // namespace

SimulatorServices::SimulatorServices(ros::NodeHandle node, const std::vector<StylusConfig>& styluses,
                                     const SavedFolder& saved_folder, CommandQueue& commands, const Switches& switches,
                                     ModeSet mode_set)
    : styluses_(styluses),
      saved_folder_(saved_folder),
      commands_(commands),
      switches_(switches),
      mode_set_(std::move(mode_set)),
      spinner_(kServices, &queue_) {
  node.setCallbackQueue(&queue_);
  advertiseTrigger(node, "reset", Command::Kind::kReset);
  advertiseTrigger(node, "pause", Command::Kind::kPause);
  advertiseTrigger(node, "resume", Command::Kind::kResume);
  servers_.push_back(node.advertiseService("step", &SimulatorServices::onStep, this));
  servers_.push_back(node.advertiseService("set_overlays", &SimulatorServices::onSetOverlays, this));
  servers_.push_back(node.advertiseService("set_tool_mode", &SimulatorServices::onSetToolMode, this));
  servers_.push_back(node.advertiseService("tie_suture", &SimulatorServices::onTieSuture, this));
  advertiseFile(node, "save_state", false, [this](Session& session, const std::string& path) {
    saved_folder_.room();
    session.save(path);
    return path;
  });
  advertiseFile(node, "load_state", true,
                [this](Session& session, const std::string& path) { return loadState(session, path); });
  advertiseFile(node, "save_surface", false, [this](Session& session, const std::string& path) {
    saved_folder_.room();
    return saveSurface(session, path);
  });
  advertiseFile(node, "start_recording", false, [this](Session& session, const std::string& path) {
    return switches_.recordings.start(session, path, saved_folder_.room());
  });
  advertiseAct(node, "stop_recording", [this](Session&) { return switches_.recordings.stop(); });
  servers_.push_back(node.advertiseService("start_task", &SimulatorServices::onStartTask, this));
  advertiseAct(node, "end_task", [this](Session& session) { return switches_.tasks.end(session); });
  spinner_.start();
}

void SimulatorServices::advertiseAct(ros::NodeHandle& node, const std::string& name,
                                     const std::function<std::string(Session&)>& act) {
  using Request = std_srvs::Trigger::Request;
  using Response = std_srvs::Trigger::Response;
  const boost::function<bool(Request&, Response&)> serve = [this, act](Request&, Response& response) {
    Command command;
    command.kind = Command::Kind::kChange;
    command.change = act;
    answer(commands_, std::move(command), response);
    return true;
  };
  servers_.push_back(node.advertiseService<Request, Response>(name, serve));
}

void SimulatorServices::advertiseFile(ros::NodeHandle& node, const std::string& name, bool leaps, const FileAct& act) {
  using Request = FileCommand::Request;
  using Response = FileCommand::Response;
  const boost::function<bool(Request&, Response&)> serve = [this, leaps, act](Request& request, Response& response) {
    try {
      Command command;
      command.kind = Command::Kind::kChange;
      command.leaps = leaps;
      command.change = [act, path = saved_folder_.pathOf(request.file)](Session& session) {
        return act(session, path);
      };
      answer(commands_, std::move(command), response);
    } catch (const Error& error) {
      response.message = error.what();
    }
    return true;
  };
  servers_.push_back(node.advertiseService<Request, Response>(name, serve));
}

void SimulatorServices::advertiseTrigger(ros::NodeHandle& node, const std::string& name, Command::Kind kind) {
  using Request = std_srvs::Trigger::Request;
  using Response = std_srvs::Trigger::Response;
  const boost::function<bool(Request&, Response&)> serve = [this, kind](Request&, Response& response) {
    Command command;
    command.kind = kind;
    answer(commands_, std::move(command), response);
    return true;
  };
  servers_.push_back(node.advertiseService<Request, Response>(name, serve));
}

/// Loads a state. Tool modes come with the state, and the settings are updated. Force limits stay as they are, since
/// they depend on the devices.
std::string SimulatorServices::loadState(Session& session, const std::string& path) const {
  std::vector<ForceLimits> limits;
  for (size_t s = 0; s < styluses_.size(); ++s) limits.push_back(session.forceLimits(s));
  const auto settle = [&] {
    for (size_t s = 0; s < styluses_.size(); ++s) {
      session.setForceLimits(s, limits[s]);
      if (!mode_set_) continue;
      const StylusConfig& now = session.styluses()[s];
      mode_set_(s, ToolSwitch::kIdle, now.idle);
      mode_set_(s, ToolSwitch::kButton1, now.button1);
      mode_set_(s, ToolSwitch::kButton2, now.button2);
    }
  };
  try {
    session.restore(path);
  } catch (const Error&) {
    settle();
    throw;
  }
  settle();
  return path;
}

bool SimulatorServices::onSetOverlays(SetOverlays::Request& request, SetOverlays::Response& response) {
  Command command;
  command.kind = Command::Kind::kOverlays;
  command.camera = request.camera;
  try {
    command.overlays = overlaysOf(request.overlays);
  } catch (const SceneError& error) {
    response.message = std::string("overlays: ") + error.what();
    return true;
  }
  answer(commands_, std::move(command), response);
  return true;
}

bool SimulatorServices::onSetToolMode(SetToolMode::Request& request, SetToolMode::Response& response) {
  Command command;
  command.kind = Command::Kind::kChange;
  try {
    const size_t stylus = stylusNamed(request.stylus, styluses_);
    const ToolSwitch when = switchNamed(request.which);
    const ToolMode mode = modeNamed(request.mode);
    command.change = [=](Session& session) {
      session.setToolMode(stylus, when, mode);
      if (mode_set_) mode_set_(stylus, when, mode);
      return "applies from the next tick on";
    };
    answer(commands_, std::move(command), response);
  } catch (const Error& error) {
    response.message = error.what();
  }
  return true;
}

bool SimulatorServices::onTieSuture(TieSuture::Request& request, TieSuture::Response& response) {
  try {
    SutureTie tie;
    if (!request.knot.empty()) tie.knot = knotNamed(request.knot);
    if (request.tension_n != 0) tie.tension_n = within("tension_n", request.tension_n, 1e-3, 100);
    tie.holds_n = within("holds_n", request.holds_n, 0, 1000);
    if (!request.strand_m.empty()) {
      if (request.strand_m.size() != 3)
        throw Error("strand_m: " + std::to_string(request.strand_m.size()) + " numbers; 3 or none are accepted");
      tie.to = TieTo::kStrand;
      for (int axis = 0; axis < 3; ++axis)
        tie.strand_m[axis] = within("strand_m", request.strand_m[static_cast<size_t>(axis)], -10, 10);
    }
    Command command;
    command.kind = Command::Kind::kChange;
    command.change = [=, name = request.suture, which = request.piece](Session& session) {
      session.tieSuture(pieceNamed(session, name, which), tie);
      return std::string(nameOf(tie.knot)) + ", drawn from the next tick on";
    };
    answer(commands_, std::move(command), response);
  } catch (const Error& error) {
    response.message = error.what();
  }
  return true;
}

bool SimulatorServices::onStartTask(StartTask::Request& request, StartTask::Response& response) {
  try {
    const std::string fault = request.trainee.empty() ? "" : traineeFault(request.trainee);
    if (!fault.empty()) throw Error("trainee: " + fault);
    Command command;
    command.kind = Command::Kind::kChange;
    command.leaps = true;
    command.change = [this, task = switches_.tasks.find(request.task), trainee = request.trainee](Session& session) {
      return switches_.tasks.start(session, task, trainee);
    };
    answer(commands_, std::move(command), response);
  } catch (const Error& error) {
    response.message = error.what();
  }
  return true;
}

bool SimulatorServices::onStep(Step::Request& request, Step::Response& response) {
  Command command;
  command.kind = Command::Kind::kStep;
  command.ticks = request.ticks;
  try {
    if (!request.styluses.empty()) command.samples = samplesOf(request.styluses, styluses_);
  } catch (const Error& error) {
    response.message = error.what();
    return true;
  }
  const CommandAnswer answer = commands_.call(std::move(command), kStepLimit);
  response.success = answer.success;
  response.message = answer.message;
  response.state_hash = answer.state_hash;
  response.tick = answer.tick;
  for (const Reaction& reaction : answer.reactions) response.reactions.push_back(toMessage(reaction));
  return true;
}

}  // namespace viscera::nodes
