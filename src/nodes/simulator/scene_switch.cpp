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

/// The node ends, and the model that is being made is not wanted.
struct Ended {};

/// The request as the parameters of the same names, whose checks it goes through.
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

/// Of an error in a parameter, which was a field of the request.
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
    keep_up_.begin(next_ ? next_->scene : running_.scene, session.scene());
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
  CarriedTissue tissue = session.carried();  // the service waits, and asks for nothing else meanwhile
  const std::lock_guard<std::mutex> lock(mutex_);
  carried_ = std::move(tissue);
}

void SceneSwitch::noteReady() {
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

/// @throws Error  the scene cannot be simulated
SimulatorOptions SceneSwitch::check(const LoadScene::Request& request) const {
  if (request.scene.empty()) throw ParameterError("parameter ~scene: must be given");
  SimulatorOptions next = running_;
  Parameters parameters = parametersOf(request, running_.publish.frame_prefix);
  next.take(SceneChoice::read(parameters, "", package_folder_), package_folder_);
  for (const std::string& note : next.limit_notes) ROS_WARN("load_scene: %s", note.c_str());
  return next;
}

/// @throws Error  no model can be made of the scene
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
  } catch (const std::exception& error) {  // perhaps for want of memory, which the old one has
    ROS_WARN("%s: the rest waits for the end of the old scene: %s", service, oneLine(error.what()).c_str());
    made->session.reset();
  }
  made->give();
  return made;
}

std::unique_ptr<MadeSession> SceneSwitch::takeMade() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::move(made_);
}

void SceneSwitch::bury(std::unique_ptr<MadeSession> ended) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (made_ && made_->session) buried_ = std::move(ended);
}

void SceneSwitch::holdTopics() {
  auto topics = std::make_unique<HeldTopics>();
  const std::lock_guard<std::mutex> lock(mutex_);
  topics_ = std::move(topics);
}

/// What is left of the simulator that ran before, and takes its time to end.
void SceneSwitch::endOld() {
  std::unique_ptr<MadeSession> session;  // both outlive the lock
  std::unique_ptr<HeldTopics> topics;
  const std::lock_guard<std::mutex> lock(mutex_);
  session.swap(buried_);
  topics.swap(topics_);
}

/// @returns why the scene did not come to run, or nothing
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
  return error_.empty() ? "" : "the scene that ran before was started again, at rest: " + error_;
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
        next.scene = keep_up_.coarser(running_.scene);
        next.limit_notes.clear();
        return next;
      },
      true, response);
  return true;
}

}  // namespace viscera::nodes
