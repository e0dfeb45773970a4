// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rviz/display.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "nodes/received/surface_feed.h"

namespace rviz {
class BoolProperty;
class ColorProperty;
class EnumProperty;
class FloatProperty;
class RosTopicProperty;
}  // namespace rviz

namespace viscera::rviz_plugin {

class SurfaceMesh;
class ViewFit;

/// Display `viscera/Surface`: the surface of a simulator from `surface` or `surface_strain`, `surface_topology` and
/// `surface_topology_change`. It runs on rviz's own thread.
class SurfaceDisplay : public rviz::Display {
 public:
  SurfaceDisplay();
  ~SurfaceDisplay() override;

  void setTopic(const QString& topic, const QString& datatype) override;
  void update(float wall_dt, float ros_dt) override;
  void reset() override;

 protected:
  void onInitialize() override;
  void onEnable() override;
  void onDisable() override;

 private:
  void warnOfSamples() const;
  void subscribe();
  bool place();
  void fitView();
  void paint();
  void tell();
  void tellSenders();
  void clear();

  rviz::RosTopicProperty* topic_;
  rviz::ColorProperty *color_, *wall_color_;
  rviz::EnumProperty* color_by_;
  rviz::BoolProperty *by_body_, *fits_view_;
  rviz::FloatProperty* alpha_;
  received::SurfaceFeed feed_;
  std::unique_ptr<SurfaceMesh> mesh_;
  std::unique_ptr<ViewFit> view_;
  std::vector<std::string> fitted_;  ///< bodies to which the view was fitted
  std::shared_ptr<const received::SentTopology> drawn_topology_;
  SurfaceVerticesConstPtr drawn_vertices_;
  size_t drawn_ = 0;     ///< number of surfaces since told_
  std::string senders_;  ///< displayed status of the senders
  bool placed_ = true;   ///< whether no error about the transform is displayed
  std::chrono::steady_clock::time_point sent_at_{};
};

}  // namespace viscera::rviz_plugin
