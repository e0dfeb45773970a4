// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QComboBox>
#include <QIcon>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QSpinBox>

#include <string>

namespace viscera::rviz_plugin {

/// The icon of a button; colours after Okabe and Ito.
enum class Sign { kReset, kPause, kResume, kStep, kLoad, kRecord, kStop, kStart, kEnd, kMouse };
QIcon icon(Sign sign);

inline constexpr int kLeastLetters = 10;  ///< number of letters that fit a box of choices: a dock may be narrow

/// Box of choices that ignores the mouse wheel while it is closed: the wheel scrolls the panel.
class ChoiceBox : public QComboBox {
 public:
  ChoiceBox() { setFocusPolicy(Qt::StrongFocus); }

 protected:
  void wheelEvent(QWheelEvent* event) override;
};

/// Spin box that ignores the mouse wheel.
class CountBox : public QSpinBox {
 public:
  CountBox() { setFocusPolicy(Qt::StrongFocus); }

 protected:
  void wheelEvent(QWheelEvent* event) override;
};

/// Bar of a share with a line where it passes; green from there on, orange below.
class PassBar : public QProgressBar {
 public:
  PassBar();
  using QProgressBar::show;
  /// Shows a share and the least one that passes, both 0..1, with a text in the bar.
  void show(double share, double pass_share, bool passes, const QString& text);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  double pass_share_ = 0;
};

/// Creates a label of several lines of selectable plain text. A long word is clipped and does not widen the panel.
QLabel* wrappedLabel();

/// Creates such a label with a fixed number of lines, so that widgets below it do not move.
QLabel* steadyLabel(int lines);
/// Writes the text, and the whole of it as a tool tip.
void write(QLabel* label, const QString& text);

/// Makes a button as wide as the widest of its texts, so that its neighbours do not move.
void keepWidthOf(QPushButton* button, const QStringList& texts);

/// Formats a number that a node sent as text. @param digits  decimals   @returns the text itself if it is not a number
QString rounded(const std::string& number, int digits);

/// Chooses the text, and adds it to the choices. Does nothing while the user chooses.
void choose(QComboBox* box, const QString& text);

/// Replaces the choices without changing the written or chosen text. Does nothing while the user chooses.
void offer(QComboBox* box, const QStringList& choices);

}  // namespace viscera::rviz_plugin
