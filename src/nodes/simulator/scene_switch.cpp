// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulator/scene_switch.h"

#include <ros/console.h>

#include <utility>

#include "math/one_line.h"
#include "nodes/ros/scene_choice.h"
#include "nodes/simulator/preparation.h"
#include "viscera/model/model.h"

namespace viscera::nodes {
namespace {

/// Thrown when the node ends and the model that is being created is not needed.
struct Ended {};

/// Converts the request to parameters of the same names, so that their checks apply.
Parameters parametersOf(const LoadScene::Request& request, const std::string& frame_prefix) {
  XmlRpc::XmlRpcValue values;
  values["scene"] = request.scene;
  values["frame_prefix"] = frame_prefix;
  if (!request.mesh.empty()) values["mesh"] = request.mesh;
  if (request.mesh_unit_m != 0) values["mesh_unit_m"] = request.mesh_unit_m;
  values["overrides"].setSize(0);
  for (size_t i = 0; i < request.overrides.size(); ++i) values["overrides"][static_cast<int>(i)] = request.overrides[i];
  return Parameters(values);
}

/// Converts an error about a parameter to one about the request's field.
std::string asField(std::string text) {
  const std::string prefix = "parameter ~";
  if (text.compare(0, prefix.size(), prefix) == 0) text.erase(0, prefix.size());
  return oneLine(text);
}

}  // namespace

SceneSwitch::SceneSwitch(ros::NodeHandle node, const SimulatorOptions& running, const std::string& package_folder)
    : package_folder_(package_folder), running_(running), spinner_(1, &queue_) {
  node.setCallbackQueue(&queue_);
  load_scene_ = node.advertiseService("load_scene", &SceneSwitch::onLoadScene, this);
  coarsen_ = node.advertiseService("coarsen", &SceneSwitch::onCoarsen, this);
  spinner_.start();
}

SceneSwitch::~SceneSwitch() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    state_ = State::kEnd;
  }
  changed_.notify_all();
  load_scene_.shutdown();
  coarsen_.shutdown();
  spinner_.stop();
}

bool SceneSwitch::isRequested() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return state_ == State::kRequested;
}

void SceneSwitch::begin(Session& session) {
  std::optional<CarriedTissue> tissue;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    adaptive_resolution_.begin(next_ ? next_->scene : running_.scene, session.scene());
    if (state_ == State::kStarting) tissue.swap(carried_);
    carried_.reset();
  }
  if (tissue) session.carry(*tissue);
}

void SceneSwitch::leave(const Session& session) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (state_ != State::kRequested || !carries_) return;
  }
  CarriedTissue tissue = session.carried();  // the service waits and sends no other request meanwhile
  const std::lock_guard<std::mutex> lock(mutex_);
  carried_ = std::move(tissue);
}

void SceneSwitch::recordReady() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (state_ != State::kStarting && state_ != State::kReturning) return;
    state_ = State::kRunning;
    first_ = false;
    if (next_) running_ = *std::exchange(next_, std::nullopt);
  }
  changed_.notify_all();
}

std::optional<SimulatorOptions> SceneSwitch::takeNext() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (state_ == State::kReturning) return running_;
  if (state_ != State::kRequested) return std::nullopt;
  state_ = State::kStarting;
  return next_;
}

bool SceneSwitch::goBack(const std::string& error) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (state_ != State::kStarting || first_) return false;
  state_ = State::kReturning;
  next_.reset();
  error_ = error;
  return true;
}

/// Checks a request. @throws Error  the scene cannot be simulated
SimulatorOptions SceneSwitch::check(const LoadScene::Request& request) const {
  if (request.scene.empty()) throw ParameterError("parameter ~scene: must be given");
  SimulatorOptions next = running_;
  Parameters parameters = parametersOf(request, running_.publish.frame_prefix);
  next.take(SceneChoice::read(parameters, "", package_folder_), package_folder_);
  for (const std::string& note : next.limit_notes) ROS_WARN("load_scene: %s", note.c_str());
  return next;
}

/// Creates the session, or as much of it as possible. @throws Error  no model can be created
std::unique_ptr<MadeSession> SceneSwitch::make(const char* service, const Scene& scene) const {
  Preparation preparation(scene);
  made_percent_ = 0;
  const Progress progress = [&, service](const std::string& stage, double fraction) {
    made_percent_ = preparation.percentAt(stage, fraction);
    ROS_INFO_THROTTLE(1, "%s: %s %.0f %%", service, stage.c_str(), 100 * fraction);
    const std::lock_guard<std::mutex> lock(mutex_);
    if (state_ == State::kEnd) throw Ended{};
  };
  auto made = std::make_unique<MadeSession>(scene);
  made->makeModel(progress);
  try {
    made->makeRest(progress);
  } catch (const std::exception& error) {  // possibly for lack of memory, which the old session uses
    ROS_WARN("%s: the rest of the new scene is prepared after the old one has ended: %s", service,
             oneLine(error.what()).c_str());
    made->session.reset();
  }
  made->give();
  return made;
}

std::unique_ptr<MadeSession> SceneSwitch::takeMade() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::move(made_);
}

void SceneSwitch::retire(std::unique_ptr<MadeSession> ended) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (made_ && made_->session) retired_ = std::move(ended);
}

void SceneSwitch::holdTopics() {
  auto topics = std::make_unique<HeldTopics>();
  const std::lock_guard<std::mutex> lock(mutex_);
  topics_ = std::move(topics);
}

/// Destroys what is left of the previous simulator, which takes time.
void SceneSwitch::endOld() {
  std::unique_ptr<MadeSession> session;  // both are destroyed after the lock is released
  std::unique_ptr<HeldTopics> topics;
  const std::lock_guard<std::mutex> lock(mutex_);
  session.swap(retired_);
  topics.swap(topics_);
}

/// Replaces the simulator. @returns the reason if the scene did not run; empty otherwise
std::string SceneSwitch::change(const SimulatorOptions& next, std::unique_ptr<MadeSession> made, bool carries) {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return state_ == State::kRunning || state_ == State::kEnd; });
  if (state_ == State::kEnd) return "the simulation has ended";
  state_ = State::kRequested;
  next_ = next;
  made_ = std::move(made);
  carries_ = carries;
  carried_.reset();
  error_.clear();
  changed_.wait(lock, [this] { return state_ == State::kRunning || state_ == State::kEnd; });
  if (state_ == State::kEnd) return "the simulation has ended";
  return error_.empty() ? "" : "the previous scene was restarted, at rest: " + error_;
}

template <class Response>
void SceneSwitch::serve(const char* service, const std::function<SimulatorOptions()>& choose, bool carries,
                        Response& response) {
  try {
    const SimulatorOptions next = choose();
    response.message = change(next, make(service, next.scene), carries);
    endOld();
    response.success = response.message.empty();
    if (response.success) {
      response.message = "running " + next.scene.name;
      for (const std::string& note : next.limit_notes) response.message += "; " + note;
    }
  } catch (const Ended&) {
    response.message = "the simulation has ended";
  } catch (const std::exception& error) {
    response.message = asField(error.what());
  }
  made_percent_ = -1;
  if (!response.success) ROS_WARN("%s: %s", service, response.message.c_str());
}

bool SceneSwitch::onLoadScene(LoadScene::Request& request, LoadScene::Response& response) {
  serve(
      "load_scene", [&] { return check(request); }, false, response);
  return true;
}

bool SceneSwitch::onCoarsen(std_srvs::Trigger::Request& /*request*/, std_srvs::Trigger::Response& response) {
  serve(
      "coarsen",
      [&] {
        SimulatorOptions next = running_;
        next.scene = adaptive_resolution_.coarser(running_.scene);
        next.limit_notes.clear();
        return next;
      },
      true, response);
  return true;
}

}  // namespace viscera::nodes
