// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <rviz/panel.h>

#include <memory>
#include <string>
#include <vector>

#include "rviz/told_simulators.h"

class QComboBox;
class QLabel;
class QPushButton;
class QSpinBox;
class QVBoxLayout;

namespace viscera::rviz_plugin {

class HandTable;
class RosWorker;
class TaskBox;
struct PanelTopics;

/// `viscera/Session`: what the simulator of a namespace tells on /diagnostics, and its services as buttons.
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
  void showSession(const std::vector<ToldSimulator>& here);
  std::string stateText(const std::vector<ToldSimulator>& here) const;
  template <class Service>
  void call(const char* service, const typename Service::Request& request = {});
  void record();

  QComboBox *spaces_, *scenes_;
  QLabel *state_, *measures_, *warnings_, *answer_;
  QPushButton *load_, *reset_, *pause_, *step_, *record_;
  QSpinBox* ticks_;
  HandTable* hands_;
  TaskBox* task_;
  std::string wanted_;  ///< namespace as a person wrote it; empty: rviz's own
  std::string space_;   ///< the same in full, with a slash at its end; empty: it is no name
  ToldSimulators told_;
  ToldSimulator now_;  ///< that is shown; without a node: none
  std::shared_ptr<PanelTopics> topics_;
  std::unique_ptr<RosWorker> worker_;  ///< last: its thread uses what is above
};

}  // namespace viscera::rviz_plugin
