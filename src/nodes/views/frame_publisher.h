// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <array>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "nodes/ros/latency_meter.h"
#include "nodes/ros/publish_options.h"
#include "nodes/ros/rate_meter.h"
#include "nodes/ros/throttle.h"
#include "nodes/views/camera_publisher.h"
#include "nodes/views/held_nodes.h"
#include "nodes/views/needle_publisher.h"
#include "nodes/views/scene_marker_publisher.h"
#include "nodes/views/surface_publisher.h"
#include "nodes/views/thread_publisher.h"

namespace viscera::nodes {

/// Sends what the simulation made, on a thread of its own. Every topic has one slot: what a slow subscriber has not let
/// go in time is overtaken by newer data, and the simulation never waits.
class FramePublisher {
 public:
  /// @param failed  called on the thread of this, once, with what ended it; from then on nothing is sent
  FramePublisher(ros::NodeHandle node, const Scene& scene, const PublishOptions& options,
                 std::function<void(std::exception_ptr)> failed);
  ~FramePublisher();
  FramePublisher(const FramePublisher&) = delete;
  FramePublisher& operator=(const FramePublisher&) = delete;

  /// From the arrival of a pose to the sending of what answers it, since they were last taken.
  struct Latencies {
    LatencyMeter::Reading surface;
    std::vector<LatencyMeter::Reading> images;  ///< [cameras]
    double surface_rate_hz = 0;                 ///< that they were sent, `surface_marker` and `surface` as one
    std::vector<double> image_rates_hz;         ///< [cameras], of image_raw
    std::vector<double> images_wanted_hz;       ///< [cameras] the same as it should be; 0: no subscriber
  };
  Latencies takeLatencies();
  /// There are subscribers to the surface, to markers or to an image. From any thread.
  bool isViewed() const;

  /// Says it in the place of the tissue, for rviz, until there are markers of a tick. Before start().
  void tell(const std::string& text) { scene_markers_.tell(text); }

  // For the simulation's thread:
  void start(const std::shared_ptr<const ShownTopology>& skin);
  /// What subscribers want of the tick that begins now; the tick's stamp is taken here.
  Wants beginTick();
  /// What is wanted of a state that stands still: what those want who subscribe since the last call, and the others too
  /// if it has changed. @param aimed  a camera has moved: its viewers have not seen that
  Wants stills(bool changed, bool aimed);
  /// How often from now on, at most.
  void setSurfaceRate(double rate_hz);
  void setImageRate(size_t camera, double rate_hz) { cameras_[camera]->setRate(rate_hz); }
  ros::Time tickStamp() const { return tick_stamp_; }
  /// Before deliver(): what of the session's state is shown too.
  void look(const Session& session, Frame& frame);
  /// @param samples  as the frames of the tools in tf have them
  void deliver(Frame&& frame, const StylusSamples& samples);

 private:
  template <class T>
  struct Stamped {
    ros::Time stamp;
    T value{};
  };
  struct Slots {
    std::optional<Stamped<std::shared_ptr<const ShownTopology>>> skin;
    std::optional<Stamped<std::unique_ptr<SurfaceFrame>>> surface;
    std::vector<std::optional<Stamped<ImageFrame>>> images;  ///< [cameras * kPictureKinds]
    std::vector<geometry_msgs::TransformStamped> frames;     ///< of cameras that are carried; none is overtaken
    std::optional<Stamped<SceneLook>> scene;
    std::optional<Threads> threads;
    std::optional<Needles> needles;
  };

  void putCameraFrames(const Frame& frame);
  void broadcastStaticFrames(const Scene& scene, const std::string& frame_prefix);
  ros::Time stampOf(uint64_t tick) const;
  Slots emptySlots() const;
  void main();
  void sendUntilStopped();
  void send(Slots&& slots);
  void noteSent(RateMeter& rate, LatencyMeter& latency, SteadyTime pose_received);

  tf2_ros::StaticTransformBroadcaster static_frames_;
  tf2_ros::TransformBroadcaster moving_frames_;
  const std::string tissue_frame_;
  struct Carried {
    size_t camera;
    std::string optical_frame;
  };
  std::vector<Carried> carried_;  ///< cameras whose optical frame is ours and moves
  SurfacePublisher surface_;
  const double tick_hz_;
  Throttle surface_throttle_;
  SceneMarkerPublisher scene_markers_;
  ThreadPublisher threads_;
  NeedlePublisher needles_;
  std::vector<std::unique_ptr<CameraPublisher>> cameras_;
  const std::function<void(std::exception_ptr)> failed_;

  // Of the simulation's thread: when the last ticks began, since images and surfaces come back late.
  static constexpr size_t kStampedTicks = 4096;
  ros::Time tick_stamp_;
  std::array<Stamped<uint64_t>, kStampedTicks> stamps_;
  HeldNodes held_;
  uint32_t surface_viewers_ = 0;         ///< when stills() was asked last
  std::vector<uint32_t> image_viewers_;  ///< [cameras * kPictureKinds]
  ros::Time frames_stamp_;               ///< of the camera frames put last

  std::mutex latency_mutex_;
  std::vector<LatencyMeter> image_latency_;
  LatencyMeter surface_latency_;
  std::vector<RateMeter> image_rates_;  ///< [cameras]
  RateMeter surface_rate_;

  std::mutex mutex_;
  std::condition_variable filled_;
  Slots slots_;
  bool any_ = false, stop_ = false;
  std::thread thread_;
};

}  // namespace viscera::nodes
