// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/views/frame_publisher.h"

#include <algorithm>
#include <utility>

#include "nodes/ros/conversions.h"
#include "nodes/ros/thread_name.h"
#include "nodes/views/surface_messages.h"
#include "render/renderer.h"

namespace viscera::nodes {

namespace {

/// Returns whether the marks of all pieces exist.
bool isOf(const std::vector<MarkPiece>& pieces, const VisibleMarks& marks) {
  return std::all_of(pieces.begin(), pieces.end(),
                     [&](const MarkPiece& piece) { return piece.mark < marks.styles.size(); });
}

}  // namespace

FramePublisher::FramePublisher(ros::NodeHandle node, const Scene& scene, const PublishOptions& options,
                               std::function<void(std::exception_ptr)> failed)
    : tissue_frame_(scene.environment.tissue_frame),
      surface_(node, scene.environment.tissue_frame),
      tick_hz_(scene.solver.tick_hz),
      surface_throttle_(options.surface_rate_hz, scene.solver.tick_hz),
      scene_markers_(node, scene, options),
      sutures_(node, scene),
      needles_(node, scene),
      cloud_(node, scene.environment.tissue_frame),
      failed_(std::move(failed)),
      has_marks_(!scene.marks.empty()),
      image_viewers_(kPictureKinds * scene.cameras.size(), 0) {
  for (const CameraConfig& camera : scene.cameras)
    cameras_.push_back(std::make_unique<CameraPublisher>(node, camera, options.frame_prefix, scene.solver.tick_hz));
  image_latency_.resize(cameras_.size());
  image_rates_.resize(cameras_.size());
  slots_ = emptySlots();
  broadcastStaticFrames(scene, options.frame_prefix);
  thread_ = std::thread([this] { main(); });
}

FramePublisher::~FramePublisher() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  filled_.notify_one();
  thread_.join();
}

void FramePublisher::broadcastStaticFrames(const Scene& scene, const std::string& frame_prefix) {
  const EnvironmentConfig& world = scene.environment;
  const ros::Time now = ros::Time::now();
  std::vector<geometry_msgs::TransformStamped> frames;
  if (world.world_frame != world.tissue_frame) {
    const Pose tissue{world.tissue_position_m, rotationFromDegrees(world.tissue_rotation_deg)};
    frames.push_back(toTransform(tissue, world.world_frame, world.tissue_frame, now));
  }
  for (size_t c = 0; c < scene.cameras.size(); ++c) {
    const CameraConfig& camera = scene.cameras[c];
    const std::string optical_frame = opticalFrame(camera, frame_prefix);
    if (camera.frame.empty() && camera.stylus.empty()) {
      frames.push_back(toTransform(opticalPose(camera), world.tissue_frame, optical_frame, now));
    } else if (!isCarriedByOpticalFrame(camera)) {
      carried_.push_back({c, optical_frame});
    }
  }
  static_frames_.sendTransform(frames);
}

void FramePublisher::start(const std::shared_ptr<const VisibleTopology>& skin) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    slots_.skin = {ros::Time::now(), skin};
    any_ = true;
  }
  filled_.notify_one();
}

FrameRequest FramePublisher::beginTick() {
  tick_stamp_ = ros::Time::now();
  FrameRequest outputs;
  outputs.surface = (surface_.isWanted() || areMarksViewed()) && surface_throttle_.pick();
  outputs.strain = outputs.surface && surface_.isStrainWanted();
  for (const auto& camera : cameras_) {
    const bool due = camera->pick();
    for (size_t k = 0; k < kPictureKinds; ++k) {
      const auto kind = static_cast<PictureKind>(k);
      outputs.of(kind).push_back(due && camera->viewers(kind) > 0);
    }
  }
  return outputs;
}

void FramePublisher::setSurfaceRate(double rate_hz) {
  surface_throttle_.setRate(rate_hz, tick_hz_);
  scene_markers_.setRate(rate_hz);
}

ros::Time FramePublisher::stampOf(uint64_t tick) const {
  const Stamped<uint64_t>& entry = stamps_[tick % stamps_.size()];
  return entry.value == tick ? entry.stamp : ros::Time::now();
}

FrameRequest FramePublisher::stills(bool changed, bool aimed) {
  tick_stamp_ = ros::Time::now();
  FrameRequest outputs;
  const uint32_t before =
      std::exchange(surface_viewers_, surface_.viewers() + (has_marks_ ? scene_markers_.viewers() : 0));
  outputs.surface = surface_viewers_ > (changed ? 0 : before);
  outputs.strain = outputs.surface && surface_.isStrainWanted();
  for (size_t c = 0; c < cameras_.size(); ++c) {
    for (size_t k = 0; k < kPictureKinds; ++k) {
      const auto kind = static_cast<PictureKind>(k);
      uint32_t& viewers = image_viewers_[kPictureKinds * c + k];
      const uint32_t known = std::exchange(viewers, cameras_[c]->viewers(kind));
      outputs.of(kind).push_back(viewers > (changed || aimed ? 0 : known));
    }
  }
  return outputs;
}

void FramePublisher::addTo(const Session& session, Frame& frame) {
  if (scene_markers_.isWanted()) held_.addTo(frame, session);
  if (!cloud_.isDue()) return;
  sensor_msgs::PointCloud2 cloud = cloud_.messageOf(session, tick_stamp_);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    slots_.cloud = std::move(cloud);
    any_ = true;
  }
  filled_.notify_one();
}

void FramePublisher::deliver(Frame&& frame, const StylusSamples& samples) {
  stamps_[frame.tick % stamps_.size()] = {tick_stamp_, frame.tick};
  putCameraFrames(frame);
  has_marks_ = frame.marks != nullptr;
  const bool scene_due = scene_markers_.isDue(), sutures_due = sutures_.isWanted(), needles_due = needles_.isWanted();
  if (!scene_due && !sutures_due && !needles_due && !frame.surface && frame.images.empty()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (scene_due) slots_.scene = {stampOf(frame.tick), styleOf(frame, samples)};
    if (sutures_due) slots_.sutures = sutures_.messageOf(frame, stampOf(frame.tick));
    if (needles_due) slots_.needles = needles_.messageOf(frame, stampOf(frame.tick));
    if (frame.surface) {
      const ros::Time stamp = stampOf(frame.surface->tick);
      slots_.surface = {stamp, std::move(frame.surface)};
      slots_.marks = frame.marks;
    }
    for (ImageFrame& image : frame.images) {
      const size_t slot = kPictureKinds * image.camera + static_cast<size_t>(image.kind);
      slots_.images.at(slot) = {stampOf(image.tick), std::move(image)};
    }
    any_ = true;
  }
  filled_.notify_one();
}

/// Queues one transform per tick, so there is one at the stamp of every image. Sending the same stamp twice, as while
/// /clock is stopped, would make every tf2 listener warn.
void FramePublisher::putCameraFrames(const Frame& frame) {
  if (carried_.empty() || tick_stamp_ == frames_stamp_) return;
  frames_stamp_ = tick_stamp_;
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const Carried& it : carried_)
    slots_.frames.push_back(toTransform(frame.cameras[it.camera], tissue_frame_, it.optical_frame, tick_stamp_));
  any_ = true;
  filled_.notify_one();
}

void FramePublisher::main() {
  nameThread("pictures");
  try {
    sendUntilStopped();
  } catch (...) {
    failed_(std::current_exception());
  }
}

void FramePublisher::sendUntilStopped() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    const auto ready = [this] { return any_ || stop_; };
    if (const auto due = surface_.due()) {
      filled_.wait_until(lock, *due, ready);
    } else {
      filled_.wait(lock, ready);
    }
    if (stop_) return;
    Slots slots = std::exchange(slots_, emptySlots());
    any_ = false;
    lock.unlock();
    send(std::move(slots));
    lock.lock();
  }
}

FramePublisher::Slots FramePublisher::emptySlots() const {
  Slots slots;
  slots.images.resize(kPictureKinds * cameras_.size());
  return slots;
}

void FramePublisher::send(Slots&& slots) {
  if (!slots.frames.empty()) moving_frames_.sendTransform(slots.frames);
  if (slots.skin) surface_.start(slots.skin->value, slots.skin->stamp);
  if (slots.surface) {
    surface_.publish(*slots.surface->value, slots.surface->stamp);
    if (surface_.isWanted()) recordSent(surface_rate_, surface_latency_, slots.surface->value->pose_received);
    mark_pieces_.clear();
    if (slots.marks && scene_markers_.isWanted()) mark_pieces_ = markPieces(*slots.marks, *slots.surface->value);
  }
  surface_.publishDue();
  if (slots.scene) {
    SceneStyle& addTo = slots.scene->value;
    if (addTo.marks && isOf(mark_pieces_, *addTo.marks)) addTo.mark_pieces = mark_pieces_;
    scene_markers_.publish(addTo, slots.scene->stamp);
  }
  if (slots.sutures) sutures_.publish(*slots.sutures);
  if (slots.needles) needles_.publish(*slots.needles);
  if (slots.cloud) cloud_.publish(*slots.cloud);
  for (size_t i = 0; i < slots.images.size(); ++i) {
    if (!slots.images[i]) continue;
    const SteadyTime pose_received = slots.images[i]->value.pose_received;
    const bool timed = slots.images[i]->value.kind == PictureKind::kColor;
    const size_t camera = i / kPictureKinds;
    cameras_[camera]->publish(std::move(slots.images[i]->value), slots.images[i]->stamp);
    if (timed) recordSent(image_rates_[camera], image_latency_[camera], pose_received);
  }
}

bool FramePublisher::isViewed() const {
  const auto watched = [](const auto& camera) { return camera->isWanted(); };
  return surface_.isWanted() || scene_markers_.isWanted() || sutures_.isWanted() || needles_.isWanted() ||
         cloud_.isWanted() || std::any_of(cameras_.begin(), cameras_.end(), watched);
}

void FramePublisher::recordSent(RateMeter& rate, LatencyMeter& latency, SteadyTime pose_received) {
  const std::lock_guard<std::mutex> lock(latency_mutex_);
  rate.add();
  latency.add(pose_received, std::chrono::steady_clock::now());
}

FramePublisher::Latencies FramePublisher::takeLatencies() {
  const std::lock_guard<std::mutex> lock(latency_mutex_);
  Latencies out;
  out.surface = surface_latency_.take().reading();
  for (LatencyMeter& meter : image_latency_) out.images.push_back(meter.take().reading());
  const auto now = std::chrono::steady_clock::now();
  out.surface_rate_hz = surface_rate_.take(now);
  for (RateMeter& meter : image_rates_) out.image_rates_hz.push_back(meter.take(now));
  for (const auto& camera : cameras_) out.images_wanted_hz.push_back(camera->wantedRate_hz());
  return out;
}

}  // namespace viscera::nodes
