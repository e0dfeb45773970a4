// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include <optional>
#include <string>
#include <utility>

#include "nodes/received/sender_watch.h"
#include "nodes/received/sent_surface.h"

namespace viscera::received {

/// Receives the surface of a simulator from its three topics. Callbacks run on the thread that serves the node's queue;
/// call all functions on that thread.
class SurfaceFeed {
 public:
  SurfaceFeed() = default;
  ~SurfaceFeed() { unsubscribe(); }
  SurfaceFeed(const SurfaceFeed&) = delete;
  SurfaceFeed& operator=(const SurfaceFeed&) = delete;

  /// Subscribes to a surface.
  /// @param topic  topic of the surface; its name with _topology and _topology_change appended gives the topics of
  /// triangles
  /// @param strain  whether to take vertices from the topic with _strain appended
  /// @throws ros::Exception  it is not a valid name of a topic
  void subscribe(ros::NodeHandle& node, const std::string& topic, bool strain = false);
  void unsubscribe();
  /// Discards the surface.
  void clear();
  /// Discards the surface and subscribes again if the simulator that sent it has ended and another is there.
  /// @returns whether it did   @throws ros::Exception
  bool renew();

  const SentSurface& surface() const { return surface_; }
  const ros::Subscriber& vertices() const { return vertices_; }
  SenderWatch::Senders senders() const { return watch_.senders(); }
  /// Returns the error of the last message that was rejected; empty if there is none since forgive().
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
    ros::Time whole = ros::TIME_MAX, vertices = ros::TIME_MAX;  ///< stamps of messages; TIME_MAX: none
  };

  ros::NodeHandle node_;
  std::string topic_;
  bool strain_ = false;
  ros::Subscriber whole_, changes_, vertices_;
  SenderWatch watch_;
  std::set<std::string> senders_;  ///< nodes that were alive when all of them were last seen
  Stamps last_;                    ///< stamps of the last messages
  std::optional<Stamps> gone_;     ///< value of last_ when one of senders_ was first missing
  Stamps dead_;                    ///< last stamps of an ended node: roscpp delivers its latched messages again
  SentSurface surface_;
  std::string wrong_;
};

}  // namespace viscera::received
