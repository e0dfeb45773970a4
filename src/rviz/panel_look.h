// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QComboBox>
#include <QIcon>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>

#include <string>

namespace viscera::rviz_plugin {

/// What a button does, as a sign on it; colours after Okabe and Ito.
enum class Sign { kReset, kPause, kResume, kStep, kLoad, kRecord, kStop, kStart, kEnd, kMouse };
QIcon icon(Sign sign);

inline constexpr int kLeastLetters = 10;  ///< that a box of choices has room for: a dock may be narrow

/// Box of choices that the mouse wheel leaves alone while it is closed: the wheel scrolls the panel around it.
class ChoiceBox : public QComboBox {
 public:
  ChoiceBox() { setFocusPolicy(Qt::StrongFocus); }

 protected:
  void wheelEvent(QWheelEvent* event) override;
};

/// Box of a number that the mouse wheel leaves alone.
class CountBox : public QSpinBox {
 public:
  CountBox() { setFocusPolicy(Qt::StrongFocus); }

 protected:
  void wheelEvent(QWheelEvent* event) override;
};

/// Plain text of several lines that can be selected. A long word is cut off and does not make the panel wider.
QLabel* wrappedLabel();

/// The same with room for a fixed number of lines: what is below it keeps its place.
QLabel* steadyLabel(int lines);
/// Writes the text, and the whole of it as a tool tip.
void write(QLabel* label, const QString& text);

/// Makes a button as wide as the widest of the texts that it will have, so that its neighbours keep their places.
void keepWidthOf(QPushButton* button, const QStringList& texts);

/// Writes a number that a node sent as text. @param digits  after the point   @returns the text as it is if it is none
QString rounded(const std::string& number, int digits);

/// The text is the chosen one, and one of the choices; not while a person chooses.
void choose(QComboBox* box, const QString& text);

/// Choices without a change of what is written or chosen; not while a person chooses.
void offer(QComboBox* box, const QStringList& choices);

}  // namespace viscera::rviz_plugin
