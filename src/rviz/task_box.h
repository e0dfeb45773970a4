// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <QGroupBox>
#include <memory>
#include <string>

namespace viscera::rviz_plugin {

class RosWorker;

/// The task of a lesson: what is to be done, how far it is and the score. choices() has what begins it and gives it up.
class TaskBox : public QGroupBox {
 public:
  /// @param worker  must outlive all calls but the destructor
  explicit TaskBox(RosWorker& worker);
  ~TaskBox() override;
  /// Shows the task of another simulator from here on. @param node  whose queue is served by rviz's own thread
  /// @param space  its namespace, with a slash at its end; empty: none
  void follow(const ros::NodeHandle& node, const std::string& space);
  /// The box of tasks and the buttons, a widget of their own: texts that grow do not move them.
  QWidget* choices() const;
  /// @param names  of tasks of the package   @param folder  where their files are
  void offerTasks(const QStringList& names, const QString& folder);
  /// @param runs  there is a simulator to ask
  void setRuns(bool runs);

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace viscera::rviz_plugin
