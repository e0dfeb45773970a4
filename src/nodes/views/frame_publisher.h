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
#include "nodes/views/markers/needle_publisher.h"
#include "nodes/views/markers/scene_marker_publisher.h"
#include "nodes/views/markers/suture_publisher.h"
#include "nodes/views/surface_publisher.h"
#include "nodes/views/tissue_cloud.h"

namespace viscera::nodes {

/// Publishes frames of the simulation on a thread of its own. Every topic has one slot: newer data replaces data that a
/// slow subscriber has not received, and the simulation never waits.
class FramePublisher {
 public:
  /// @param failed  called once with the error that ends the publishing thread, on that thread; nothing is sent
  /// afterwards
  FramePublisher(ros::NodeHandle node, const Scene& scene, const PublishOptions& options,
                 std::function<void(std::exception_ptr)> failed);
  ~FramePublisher();
  FramePublisher(const FramePublisher&) = delete;
  FramePublisher& operator=(const FramePublisher&) = delete;

  /// Latencies from the arrival of a pose to the sending of the answer, since the last call.
  struct Latencies {
    LatencyMeter::Reading surface;
    std::vector<LatencyMeter::Reading> images;  ///< [cameras]
    double surface_rate_hz = 0;                 ///< rate of `surface_marker` and `surface` as one [Hz]
    std::vector<double> image_rates_hz;         ///< [cameras] rates of image_raw [Hz]
    std::vector<double> images_wanted_hz;       ///< [cameras] desired rates [Hz]; 0: no subscriber
  };
  Latencies takeLatencies();
  /// Returns whether the surface, markers or an image have subscribers. Thread-safe.
  bool isViewed() const;

  /// Shows a text in place of the tissue in rviz, until there are markers of a tick. Call it before start().
  void tell(const std::string& text) { scene_markers_.tell(text); }

  // Called on the simulation thread:
  void start(const std::shared_ptr<const VisibleTopology>& skin);
  /// Returns the outputs that subscribers need from the tick that begins, and takes the tick's stamp.
  FrameRequest beginTick();
  /// Returns the outputs that are needed of a state that does not advance: those of subscribers since the last call,
  /// and of all subscribers if it has changed.
  /// @param aimed  a camera has moved since its images were sent
  FrameRequest stills(bool changed, bool aimed);
  /// Sets the largest rate of the surface.
  void setSurfaceRate(double rate_hz);
  void setImageRate(size_t camera, double rate_hz) { cameras_[camera]->setRate(rate_hz); }
  ros::Time tickStamp() const { return tick_stamp_; }
  /// Adds data of the session's state to the frame. Call it before deliver().
  void addTo(const Session& session, Frame& frame);
  /// Publishes a frame. @param samples  samples that determine the tool frames in tf
  void deliver(Frame&& frame, const StylusSamples& samples);

 private:
  template <class T>
  struct Stamped {
    ros::Time stamp;
    T value{};
  };
  struct Slots {
    std::optional<Stamped<std::shared_ptr<const VisibleTopology>>> skin;
    std::optional<Stamped<std::unique_ptr<SurfaceFrame>>> surface;
    std::vector<std::optional<Stamped<ImageFrame>>> images;  ///< [cameras * kPictureKinds]
    std::vector<geometry_msgs::TransformStamped> frames;     ///< frames of carried cameras; none is dropped
    std::optional<Stamped<SceneStyle>> scene;
    std::optional<Sutures> sutures;
    std::optional<Needles> needles;
    std::optional<sensor_msgs::PointCloud2> cloud;
    std::shared_ptr<const VisibleMarks> marks;  ///< marks on `surface`
  };

  void putCameraFrames(const Frame& frame);
  void broadcastStaticFrames(const Scene& scene, const std::string& frame_prefix);
  ros::Time stampOf(uint64_t tick) const;
  bool areMarksViewed() const { return has_marks_ && scene_markers_.isWanted(); }
  Slots emptySlots() const;
  void main();
  void sendUntilStopped();
  void send(Slots&& slots);
  void recordSent(RateMeter& rate, LatencyMeter& latency, SteadyTime pose_received);

  tf2_ros::StaticTransformBroadcaster static_frames_;
  tf2_ros::TransformBroadcaster moving_frames_;
  const std::string tissue_frame_;
  struct Carried {
    size_t camera;
    std::string optical_frame;
  };
  std::vector<Carried> carried_;  ///< cameras with a moving optical frame that this node broadcasts
  SurfacePublisher surface_;
  const double tick_hz_;
  Throttle surface_throttle_;
  SceneMarkerPublisher scene_markers_;
  SuturePublisher sutures_;
  NeedlePublisher needles_;
  TissueCloud cloud_;
  std::vector<std::unique_ptr<CameraPublisher>> cameras_;
  const std::function<void(std::exception_ptr)> failed_;

  // Used on the simulation thread: stamps of the last ticks, since images and surfaces arrive late.
  static constexpr size_t kStampedTicks = 4096;
  ros::Time tick_stamp_;
  std::array<Stamped<uint64_t>, kStampedTicks> stamps_;
  HeldNodes held_;
  bool has_marks_ = false;               ///< marks are on the tissue: scene_markers needs its surface
  uint32_t surface_viewers_ = 0;         ///< number of viewers at the last call of stills()
  std::vector<uint32_t> image_viewers_;  ///< [cameras * kPictureKinds]
  ros::Time frames_stamp_;               ///< stamp of the last camera frames

  std::vector<MarkPiece> mark_pieces_;  ///< on the last surface; used on the thread that publishes

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
