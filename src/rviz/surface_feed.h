// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include <optional>
#include <string>
#include <utility>

#include "rviz/sender_watch.h"
#include "rviz/sent_surface.h"

namespace viscera::rviz_plugin {

/// The surface of a simulator by its three topics. Callbacks are of the thread that serves the node's queue, and all
/// else is called there.
class SurfaceFeed {
 public:
  SurfaceFeed() = default;
  ~SurfaceFeed() { unsubscribe(); }
  SurfaceFeed(const SurfaceFeed&) = delete;
  SurfaceFeed& operator=(const SurfaceFeed&) = delete;

  /// @param topic  of the surface; triangles come from the topics that have _topology and _topology_change behind that
  /// name   @param strain  vertices come from the one that has _strain behind it
  /// @throws ros::Exception  it is no name of a topic
  void subscribe(ros::NodeHandle& node, const std::string& topic, bool strain = false);
  void unsubscribe();
  /// Forgets what was sent.
  void clear();
  /// Forgets what was sent and subscribes again if a simulator that sent it has gone and another is there.
  /// @returns whether that was so   @throws ros::Exception
  bool renew();

  const SentSurface& surface() const { return surface_; }
  const ros::Subscriber& vertices() const { return vertices_; }
  SenderWatch::Senders senders() const { return watch_.senders(); }
  /// What was wrong with the last message that was left out; empty: nothing since it was taken.
  const std::string& wrong() const { return wrong_; }
  void forgive() { wrong_.clear(); }

 private:
  template <class Message>
  void take(const Message& message) {
    std::string wrong = surface_.take(message);
    if (!wrong.empty()) wrong_ = std::move(wrong);
  }

  void connect();

  struct Stamps {
    ros::Time whole = ros::TIME_MAX, vertices = ros::TIME_MAX;  ///< of messages; TIME_MAX: of none
  };

  ros::NodeHandle node_;
  std::string topic_;
  bool strain_ = false;
  ros::Subscriber whole_, changes_, vertices_;
  SenderWatch watch_;
  std::set<std::string> senders_;  ///< that were alive when all of them were seen last
  Stamps last_;                    ///< of what came last
  std::optional<Stamps> gone_;     ///< last_ as one of senders_ was missed first
  Stamps dead_;                    ///< of the last of one that has gone: what was latched roscpp hands out again
  SentSurface surface_;
  std::string wrong_;
};

}  // namespace viscera::rviz_plugin
