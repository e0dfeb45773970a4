// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QGridLayout>
#include <QWidget>

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "nodes/received/discovered_simulators.h"

class QComboBox;
class QLabel;

namespace viscera::rviz_plugin {

/// Table of a simulator's styluses: tool modes per button, and forces.
class ToolTable : public QWidget {
 public:
  /// Callback for a chosen mode. @param which  idle, button1 or button2
  using ModeChosen = std::function<void(const std::string& stylus, const std::string& which, const std::string& mode)>;
  /// @param chosen  called when the user has chosen a mode
  explicit ToolTable(ModeChosen chosen);
  void show(const std::vector<received::DiscoveredStylus>& styluses);

 private:
  struct Row {
    std::string stylus;
    std::array<QComboBox*, 3> modes;  ///< idle, button 1, button 2
    QLabel* force;
  };
  void makeRows(const std::vector<received::DiscoveredStylus>& styluses);

  const ModeChosen chosen_;
  QWidget* table_ = nullptr;
  std::vector<Row> rows_;
};

}  // namespace viscera::rviz_plugin
