// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <QGroupBox>
#include <memory>
#include <string>

namespace viscera::received {
class RosWorker;
}

namespace viscera::rviz_plugin {

/// The task of a lesson: instructions, progress and score. choices() has the buttons that start and end it.
class TaskBox : public QGroupBox {
 public:
  /// @param worker  must outlive all calls except the destructor
  explicit TaskBox(received::RosWorker& worker);
  ~TaskBox() override;
  /// Shows the task of another simulator. @param node  handle with a queue that rviz's own thread serves
  /// @param space  its namespace, with a slash at its end; empty: none
  void follow(const ros::NodeHandle& node, const std::string& space);
  /// Returns the box of tasks and the buttons, as a separate widget that does not move when texts grow.
  QWidget* choices() const;
  /// Sets the choices. @param names  names of tasks of the package   @param folder  folder of their files
  void offerTasks(const QStringList& names, const QString& folder);
  /// Sets whether there is a simulator. @param runs  whether a simulator runs
  void setRuns(bool runs);

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace viscera::rviz_plugin
