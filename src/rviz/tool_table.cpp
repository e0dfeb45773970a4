// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/tool_table.h"

#include <QVBoxLayout>
#include <algorithm>
#include <utility>

#include "model/scene/tool_kinds.h"
#include "rviz/panel_style.h"

namespace viscera::rviz_plugin {
namespace {

constexpr std::array<const char*, 3> kSwitches = {"idle", "button1", "button2"};
constexpr int kModeLetters = 4;  // a dock may be narrow; the list shows full names
constexpr int kForceLines = 2;

QString forceText(const received::DiscoveredStylus& stylus_state) {
  const QString state = QString::fromStdString(stylus_state.state);
  if (stylus_state.force_n.empty()) return state;
  return QString("%1; %2 N, touches %3 nodes, holds %4")
      .arg(state, rounded(stylus_state.force_n, 2), QString::fromStdString(stylus_state.nodes_touched),
           QString::fromStdString(stylus_state.nodes_held));
}

}  // namespace

ToolTable::ToolTable(ModeChosen chosen) : chosen_(std::move(chosen)) {
  (new QVBoxLayout(this))->setContentsMargins(0, 0, 0, 0);
}

void ToolTable::show(const std::vector<received::DiscoveredStylus>& styluses) {
  const bool same = std::equal(
      rows_.begin(), rows_.end(), styluses.begin(), styluses.end(),
      [](const Row& row, const received::DiscoveredStylus& stylus_state) { return row.stylus == stylus_state.name; });
  if (!same) makeRows(styluses);
  for (size_t i = 0; i < rows_.size(); ++i) {
    for (size_t which = 0; which < kSwitches.size(); ++which)
      choose(rows_[i].modes[which], QString::fromStdString(styluses[i].modes[which]));
    write(rows_[i].force, forceText(styluses[i]));
  }
}

void ToolTable::makeRows(const std::vector<received::DiscoveredStylus>& styluses) {
  delete table_;
  rows_.clear();
  table_ = new QWidget;
  auto* grid = new QGridLayout(table_);
  grid->setContentsMargins(0, 0, 0, 0);
  for (size_t which = 0; which < kSwitches.size() && !styluses.empty(); ++which)
    grid->addWidget(new QLabel(kSwitches[which]), 0, static_cast<int>(which) + 1);
  int line = 1;
  for (const received::DiscoveredStylus& stylus : styluses) {
    grid->addWidget(new QLabel(QString::fromStdString(stylus.name)), line, 0);
    Row row{stylus.name, {}, steadyLabel(kForceLines)};
    for (size_t which = 0; which < kSwitches.size(); ++which) {
      QComboBox* box = row.modes[which] = new ChoiceBox;
      box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
      box->setMinimumContentsLength(kModeLetters);
      box->setMinimumWidth(box->fontMetrics().averageCharWidth() * kModeLetters);
      box->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);  // a table that appears does not widen the panel
      for (const ToolKind& kind : kToolKinds) box->addItem(kind.name);
      connect(box, QOverload<int>::of(&QComboBox::activated), this, [this, box, name = stylus.name, which] {
        chosen_(name, kSwitches[which], box->currentText().toStdString());
      });
      grid->addWidget(box, line, static_cast<int>(which) + 1);
      grid->setColumnStretch(static_cast<int>(which) + 1, 1);
    }
    grid->addWidget(row.force, line + 1, 1, 1, static_cast<int>(kSwitches.size()));
    rows_.push_back(row);
    line += 2;
  }
  layout()->addWidget(table_);
}

}  // namespace viscera::rviz_plugin
