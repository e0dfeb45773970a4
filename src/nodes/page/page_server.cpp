// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/page/page_server.h"

#include <ros/console.h>
#include <std_srvs/Trigger.h>
#include <viscera/LoadScene.h>
#include <viscera/StartTask.h>

#include <algorithm>
#include <utility>

#include "export/page/viewer_text.h"
#include "math/one_line.h"
#include "math/shipped_files.h"
#include "nodes/received/simulator_space.h"
#include "nodes/ros/frame_lookup.h"
#include "nodes/ros/master_watch.h"
#include "tasks/task.h"

namespace viscera::nodes {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::chrono::milliseconds kIdlePoll{50};     // time until a new page is noticed
constexpr double kPoll_s = 0.004;                      // time until a frame of tf is noticed
constexpr std::chrono::milliseconds kStateEvery{500};  // diagnostics come once a second
constexpr std::chrono::seconds kStayFor{2};            // subscriptions outlive the last page, which may be loaded again
constexpr std::chrono::seconds kWarnEvery{10};
constexpr double kMaxTransformAge_s = 0.5;  // as the simulator's default
constexpr uint32_t kDiagnosticsQueue = 100, kMarkersQueue = 10;
constexpr const char* kCameraFrame = "_optical_frame";

// Lens of all cameras of the page: topics of images, which have the real ones, are not subscribed to.
constexpr double kFocal_px = 480, kWidth_px = 640, kHeight_px = 480;

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

Json cameraOf(const std::string& name, const Pose& optical, double distance_m) {
  const Quaterniond& q = optical.orientation;
  return {{"name", name},
          {"position", jsonOf(optical.position_m)},
          {"orientation", {q.x(), q.y(), q.z(), q.w()}},
          {"target", jsonOf(optical * Vector3d(0, 0, distance_m))},
          {"focal_px", kFocal_px},
          {"width", kWidth_px},
          {"height", kHeight_px}};
}

Eigen::AlignedBox3d boxOf(const received::SentSurface& surface) {
  Eigen::AlignedBox3d box;
  if (!surface.vertices()) return box;
  const std::vector<float>& x = surface.vertices()->positions_m;
  for (const uint32_t v : surface.topology()->triangles)
    box.extend(Eigen::Map<const Vector3f>(&x[3 * static_cast<size_t>(v)]).cast<double>());
  return box;
}

/// Returns the pose of a camera in front of a box that it fills, and its distance from the centre.
std::pair<Pose, double> wholeView(const Eigen::AlignedBox3d& box) {
  constexpr double kMargin = 1.2;
  const double distance_m = kMargin * box.diagonal().norm() / 2 * 2 * kFocal_px / kHeight_px + box.sizes().y() / 2;
  const Quaterniond forward(Eigen::AngleAxisd(-M_PI / 2, Vector3d::UnitX()));  // z of the optical frame along y
  return {{box.center() - Vector3d(0, distance_m, 0), forward}, distance_m};
}

Json bodiesOf(const received::SentTopology* topology) {
  Json out = Json::array();
  for (size_t b = 0; topology && b < topology->bodies.size(); ++b) {
    const uint32_t color = b < topology->body_colors.size() ? topology->body_colors[b] : 0;
    out.push_back({{"name", topology->bodies[b]},
                   {"color", {(color & 255) / 255.0, (color >> 8 & 255) / 255.0, (color >> 16 & 255) / 255.0}}});
  }
  return out;
}

Json taskOf(const TaskState& task) {
  if (task.state == TaskState::NONE) return nullptr;
  return {{"title", task.title.empty() ? task.task : task.title}, {"step", task.step}, {"score", task.score}};
}

}  // namespace

PageServerOptions pageServerOptions(Parameters& parameters) {
  constexpr double kMostPort = 65535;
  PageServerOptions options;
  WebOptions& web = options.web;
  web.address = parameters.text("address", web.address);
  web.port = static_cast<uint16_t>(parameters.number("port", web.port, 0, kMostPort));
  web.most_clients =
      static_cast<size_t>(parameters.number("max_clients", static_cast<double>(web.most_clients), 1, 16));
  web.control = parameters.flag("control", web.control);
  options.rate_hz = parameters.number("rate_hz", options.rate_hz, 1, 60);
  options.force_arrow_m_per_n = parameters.number("force_arrow_m_per_n", options.force_arrow_m_per_n, 1e-6, 10);
  parameters.refuseOthers();
  return options;
}

PageServer::PageServer(const PageServerOptions& options)
    : options_(options),
      space_(received::simulatorSpace("")),
      tasks_(shippedNames("tasks")),
      scene_(options.force_arrow_m_per_n) {
  node_.setCallbackQueue(&queue_);
  worker_ = std::make_unique<received::RosWorker>([this](const std::string& text) {
    server_->tell(Json{{"answer", text}}.dump(-1, ' ', true, Json::error_handler_t::replace));
  });
  server_ = std::make_unique<WebServer>(
      options_.web, viewerHead(ViewerData::kLive) + viewerTail(ViewerData::kLive, Json::object()),
      WebServer::Callbacks{[this](const std::string& service, const std::string& task) { call(service, task); },
                           [this](const std::string& why) { refused(why); }});
  server_->setState(stateText());
}

PageServer::~PageServer() {
  worker_.reset();  // before the server, which sends its answers
  server_.reset();
}

void PageServer::run(EndWatch& end) {
  MasterWatch master;
  const std::string host = options_.web.address == "0.0.0.0" ? "this machine" : options_.web.address;
  ROS_INFO("the simulator of %s is shown at http://%s:%u/%s", space_.c_str(), host.c_str(), server_->port(),
           options_.web.control ? ", with buttons" : "");
  while (!end.waitFor(std::chrono::milliseconds(0))) {
    master.require();
    server_->require();
    warn();
    const Clock::time_point now = Clock::now();
    if (server_->clients() > 0) left_ = now;
    const bool wanted = now - left_ < kStayFor;
    follow(wanted);
    if (!wanted) {
      end.waitFor(kIdlePoll);
      continue;
    }
    queue_.callAvailable(ros::WallDuration(kPoll_s));
    update();
  }
}

/// Subscribes, or ends all subscriptions: with one the simulator computes every surface.
void PageServer::follow(bool wanted) {
  if (wanted == static_cast<bool>(topics_)) return;
  if (!wanted) {
    topics_.reset();
    feed_.unsubscribe();
    feed_.clear();
    scene_.clear();
    frames_.clear();
    task_ = {};
    server_->show(nullptr);
    queue_.clear();
    return;
  }
  followed_ = Clock::now();
  topics_ = std::make_unique<Topics>();
  topics_->frames = std::make_unique<FrameListener>(frames_, false);
  topics_->diagnostics = node_.subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", kDiagnosticsQueue,
      [this](const diagnostic_msgs::DiagnosticArrayConstPtr& message) { simulators_.take(*message, Clock::now()); });
  topics_->task =
      node_.subscribe<TaskState>("task_state", 1, [this](const TaskStateConstPtr& message) { task_ = *message; });
  topics_->markers = node_.subscribe<visualization_msgs::MarkerArray>(
      "scene_markers", kMarkersQueue,
      [this](const visualization_msgs::MarkerArrayConstPtr& message) {
        if (scene_.markers().take(*message)) scene_.repeat();
      },
      {}, ros::TransportHints().tcpNoDelay());
  feed_.subscribe(node_, "surface");
}

/// Sends what is due.
void PageServer::update() {
  const Clock::time_point now = Clock::now();
  if (now >= state_due_) {
    state_due_ = now + kStateEvery;
    if (feed_.renew()) scene_.clear();
    std::string text = stateText();
    if (text != state_) server_->setState(text);
    state_ = std::move(text);
  }
  if (now < due_) return;
  if (server_->clientsSoFar() != welcomed_) scene_.repeat();
  welcomed_ = server_->clientsSoFar();
  const std::shared_ptr<const LiveFrame> frame =
      scene_.next(feed_.surface(), [this](const std::string& name) { return poseOf(name); });
  if (!frame) return;
  server_->show(frame);
  const auto period = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / options_.rate_hz));
  due_ = std::max(due_ + period, now);
}

std::string PageServer::tissueFrame() const {
  const auto& vertices = feed_.surface().vertices();
  return vertices ? vertices->header.frame_id : std::string();
}

std::optional<Pose> PageServer::poseOf(const std::string& frame) const try {
  const std::string tissue = tissueFrame();
  if (frame == tissue) return Pose{};
  return newestPose(frames_, tissue, frame, kMaxTransformAge_s);
} catch (const tf2::TransformException&) {
  return std::nullopt;
}

/// Returns the cameras with a frame in tf, and a view of the whole.
Json PageServer::cameras() const {
  Json out = Json::array();
  const Eigen::AlignedBox3d box = boxOf(feed_.surface());
  if (box.isEmpty()) return out;
  std::vector<std::string> names;
  frames_._getFrameStrings(names);
  std::sort(names.begin(), names.end());
  for (const std::string& name : names) {
    if (!endsWith(name, kCameraFrame)) continue;
    const std::optional<Pose> pose = poseOf(name);
    if (!pose) continue;
    const double distance_m = pose->inverse().orientation.operator*(box.center() - pose->position_m).z();
    const size_t slash = name.rfind('/') + 1;
    out.push_back(cameraOf(name.substr(slash, name.size() - slash - std::string(kCameraFrame).size()), *pose,
                           std::max(distance_m, 1e-3)));
  }
  const auto [pose, distance_m] = wholeView(box);
  out.push_back(cameraOf("front", pose, distance_m));
  return out;
}

/// Returns the state of the simulator as a message to browsers.
std::string PageServer::stateText() {
  received::DiscoveredSimulator now;
  for (const received::DiscoveredSimulator& one : simulators_.at(Clock::now()))
    if (one.space() == space_) now = one;
  const bool is_early = Clock::now() - followed_ < received::DiscoveredSimulators::kSilence;
  std::string text = (is_early ? "waiting for a simulator in " : "no simulator sends /diagnostics in ") + space_;
  if (!now.node.empty()) {
    text = now.paused ? "paused" : now.state;
    if (!now.paused && !now.real_time_factor.empty())
      text += ", " + now.real_time_factor.substr(0, 4) + " of real time";
    for (const std::string& warning : now.warnings) text += "; " + warning;
  }
  if (const std::string& preparing = scene_.markers().preparing(); !preparing.empty()) text = preparing;
  if (!feed_.wrong().empty()) text += "; " + feed_.wrong();
  Json names = Json::array();
  for (const received::DiscoveredStylus& stylus : now.styluses) names.push_back(stylus.name);
  const Json state = {{"name", now.scene},     {"text", text},
                      {"paused", now.paused},  {"control", options_.web.control},
                      {"styluses", names},     {"bodies", bodiesOf(feed_.surface().topology().get())},
                      {"cameras", cameras()},  {"newton_m", options_.force_arrow_m_per_n},
                      {"task", taskOf(task_)}, {"tasks", options_.web.control ? Json(tasks_) : Json::array()}};
  return Json{{"state", state}}.dump(-1, ' ', true, Json::error_handler_t::replace);
}

/// Calls a service of the simulator. On the server's thread; the worker waits for the answer.
void PageServer::call(const std::string& service, const std::string& task) {
  if (service == "start_task")
    worker_->add([this, task] { return startTask(task); });
  else
    worker_->call<std_srvs::Trigger>(space_ + service, {});
}

/// Starts a task, and loads its scene first if the simulator requires it. @returns a text for the user
std::string PageServer::startTask(const std::string& task) {
  StartTaskRequest request;
  request.task = task;
  received::RosWorker::Answer answer = worker_->ask<StartTask>(space_ + "start_task", request);
  if (answer.success || answer.text.find(StartTaskResponse::LOAD_SCENE_FIRST) == std::string::npos) return answer.text;
  LoadSceneRequest scene;
  try {
    const std::string file = shippedFile(task, "tasks");
    scene.scene = sceneOfTask(loadTask(file), file);
  } catch (const Error& error) {
    return oneLine(error.what());
  }
  answer = worker_->ask<LoadScene>(space_ + "load_scene", scene);
  return answer.success ? worker_->ask<StartTask>(space_ + "start_task", request).text : answer.text;
}

void PageServer::refused(const std::string& why) {
  const std::lock_guard<std::mutex> lock(refused_mutex_);
  ++refused_;
  last_refused_ = why;
}

/// Warns of refused requests and messages, once in a while.
void PageServer::warn() {
  if (Clock::now() < warn_due_) return;
  const std::lock_guard<std::mutex> lock(refused_mutex_);
  if (refused_ == warned_) return;
  ROS_WARN("refused %llu requests and messages so far; the last: %s", static_cast<unsigned long long>(refused_),
           last_refused_.c_str());
  warned_ = refused_;
  warn_due_ = Clock::now() + kWarnEvery;
}

}  // namespace viscera::nodes
