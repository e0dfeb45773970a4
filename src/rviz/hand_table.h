// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QGridLayout>
#include <QWidget>

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "rviz/told_simulators.h"

class QComboBox;
class QLabel;

namespace viscera::rviz_plugin {

/// The styluses of a simulator: what they do with which button, and what they feel.
class HandTable : public QWidget {
 public:
  /// @param which  idle, button1 or button2
  using ModeChosen = std::function<void(const std::string& stylus, const std::string& which, const std::string& mode)>;
  /// @param chosen  a person has chosen a mode
  explicit HandTable(ModeChosen chosen);
  void show(const std::vector<ToldStylus>& styluses);

 private:
  struct Row {
    std::string stylus;
    std::array<QComboBox*, 3> modes;  ///< idle, button 1, button 2
    QLabel* felt;
  };
  void makeRows(const std::vector<ToldStylus>& styluses);

  const ModeChosen chosen_;
  QWidget* table_ = nullptr;
  std::vector<Row> rows_;
};

}  // namespace viscera::rviz_plugin
