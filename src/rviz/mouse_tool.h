// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rviz/tool.h>

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "nodes/received/surface_feed.h"
#include "rviz/mouse_aim.h"

namespace rviz {
class FloatProperty;
class StringProperty;
}  // namespace rviz

namespace viscera::rviz_plugin {

class StylusSender;

/// Tool `viscera/Mouse`: the mouse moves a stylus. The tip is on the surface under the cursor; the wheel pushes it
/// deeper.
class MouseTool : public rviz::Tool {
 public:
  MouseTool();
  ~MouseTool() override;

  void onInitialize() override;
  void activate() override;
  void deactivate() override;
  void update(float wall_dt, float ros_dt) override;
  int processMouseEvent(rviz::ViewportMouseEvent& event) override;
  int processKeyEvent(QKeyEvent* event, rviz::RenderPanel* panel) override;
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  struct ScreenPoint {
    int x = 0, y = 0;  ///< screen coordinates [pixels]
  };
  bool press(const QKeyEvent& event, bool down);
  void follow();
  void tell(const QString& text);
  std::array<bool, 2> pressed() const;
  std::optional<Pose> aim();

  rviz::StringProperty *space_, *stylus_;
  rviz::FloatProperty *depth_, *step_, *speed_, *tilt_;
  received::SurfaceFeed feed_;
  MouseAim aim_;
  std::optional<ScreenPoint> position_;  ///< mouse position; empty before the mouse entered the window
  std::array<bool, 2> keys_{}, mouse_{};
  bool active_ = false;
  QString last_;
  std::string topics_;  ///< prefix of the simulator's topics, with a slash at its end; empty: the name is invalid
  std::unique_ptr<StylusSender> sender_;
};

}  // namespace viscera::rviz_plugin
