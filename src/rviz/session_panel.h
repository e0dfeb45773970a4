// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <rviz/panel.h>

#include <memory>
#include <string>
#include <vector>

#include "nodes/received/discovered_simulators.h"

class QComboBox;
class QLabel;
class QPushButton;
class QSpinBox;
class QVBoxLayout;

namespace viscera::received {
class RosWorker;
}

namespace viscera::rviz_plugin {

class ToolTable;
class TaskBox;
struct PanelTopics;

/// Panel `viscera/Session`: diagnostics of the simulator in a namespace, and buttons for its services.
class SessionPanel : public rviz::Panel {
 public:
  explicit SessionPanel(QWidget* parent = nullptr);
  ~SessionPanel() override;

  void onInitialize() override;
  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;

 private:
  void makeChoices(QVBoxLayout* rows);
  void makeButtons(QVBoxLayout* rows);
  void chooseSpace(const std::string& space);
  void follow();
  ros::NodeHandle queued() const;
  void show();
  void showSession(const std::vector<received::DiscoveredSimulator>& here);
  std::string stateText(const std::vector<received::DiscoveredSimulator>& here) const;
  template <class Service>
  void call(const char* service, const typename Service::Request& request = {});
  void record();

  QComboBox *spaces_, *scenes_;
  QLabel *state_, *measures_, *warnings_, *answer_;
  QPushButton *load_, *reset_, *pause_, *step_, *record_;
  QSpinBox* ticks_;
  ToolTable* tools_;
  TaskBox* task_;
  std::string wanted_;  ///< namespace as the user wrote it; empty: rviz's own
  std::string space_;   ///< full name of it, with a slash at its end; empty: it is not a valid name
  received::DiscoveredSimulators simulators_;
  received::DiscoveredSimulator now_;  ///< simulator that is displayed; without a node: none
  std::shared_ptr<PanelTopics> topics_;
  std::unique_ptr<received::RosWorker> worker_;  ///< last member: its thread uses the ones above
};

}  // namespace viscera::rviz_plugin
