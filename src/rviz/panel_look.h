// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QComboBox>
#include <QIcon>
#include <QLabel>

namespace viscera::rviz_plugin {

/// What a button does, as a sign on it; colours after Okabe and Ito.
enum class Sign { kReset, kPause, kResume, kStep, kLoad, kRecord, kStop, kStart, kEnd, kMouse };
QIcon icon(Sign sign);

/// Plain text of several lines that can be selected.
QLabel* wrappedLabel();

/// The text is the chosen one, and one of the choices; not while a person chooses.
void choose(QComboBox* box, const QString& text);

/// Choices without a change of what is written or chosen; not while a person chooses.
void offer(QComboBox* box, const QStringList& choices);

}  // namespace viscera::rviz_plugin
