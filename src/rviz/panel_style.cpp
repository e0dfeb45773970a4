// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/panel_style.h"

#include <QAbstractItemView>
#include <QLineEdit>
#include <QPainter>
#include <QSignalBlocker>
#include <QWheelEvent>

#include <algorithm>
#include <optional>

#include "math/number_text.h"

namespace viscera::rviz_plugin {
namespace {

constexpr int kIcon_px = 16;
constexpr int kPerMille = 1000;

bool isUsed(const QComboBox* box) {
  return box->view()->isVisible() || (box->lineEdit() && box->lineEdit()->hasFocus());
}

QColor colorOf(Sign sign) {
  switch (sign) {
    case Sign::kReset:
      return {230, 159, 0};
    case Sign::kPause:
      return {0, 114, 178};
    case Sign::kResume:
      return {0, 158, 115};
    case Sign::kStep:
      return {86, 180, 233};
    case Sign::kLoad:
      return {204, 121, 167};
    case Sign::kRecord:
      return {213, 94, 0};
    case Sign::kStop:
      return {150, 60, 0};
    case Sign::kStart:
      return {0, 130, 90};
    case Sign::kEnd:
      return {120, 70, 100};
    case Sign::kMouse:
      return {240, 228, 66};
  }
  return {};
}

void draw(Sign sign, QPainter& painter) {
  switch (sign) {
    case Sign::kPause:
      painter.drawRect(2, 1, 5, 14);
      painter.drawRect(9, 1, 5, 14);
      return;
    case Sign::kResume:
    case Sign::kStart:
    case Sign::kLoad:
      painter.drawPolygon(QPolygon({{2, 1}, {15, 8}, {2, 15}}));
      return;
    case Sign::kStep:
      painter.drawPolygon(QPolygon({{1, 1}, {10, 8}, {1, 15}}));
      painter.drawRect(11, 1, 4, 14);
      return;
    case Sign::kReset:
      painter.drawPolygon(QPolygon({{15, 1}, {6, 8}, {15, 15}}));
      painter.drawRect(1, 1, 4, 14);
      return;
    case Sign::kRecord:
      painter.drawEllipse(1, 1, 14, 14);
      return;
    case Sign::kStop:
    case Sign::kEnd:
      painter.drawRect(2, 2, 12, 12);
      return;
    case Sign::kMouse:
      painter.drawPolygon(QPolygon({{2, 1}, {14, 9}, {8, 10}, {4, 15}}));
      return;
  }
}

}  // namespace

QIcon icon(Sign sign) {
  QPixmap picture(kIcon_px, kIcon_px);
  picture.fill(Qt::transparent);
  QPainter painter(&picture);
  painter.setPen(Qt::NoPen);
  painter.setBrush(colorOf(sign));
  draw(sign, painter);
  return QIcon(picture);
}

void ChoiceBox::wheelEvent(QWheelEvent* event) {
  event->ignore();
}

void CountBox::wheelEvent(QWheelEvent* event) {
  event->ignore();
}

QLabel* wrappedLabel() {
  auto* label = new QLabel;
  label->setWordWrap(true);
  label->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  label->setTextFormat(Qt::PlainText);
  label->setTextInteractionFlags(Qt::TextSelectableByMouse);
  return label;
}

QLabel* steadyLabel(int lines) {
  QLabel* const label = wrappedLabel();
  label->setAlignment(Qt::AlignLeft | Qt::AlignTop);
  label->setFixedHeight(lines * label->fontMetrics().lineSpacing() + 2 * label->margin());
  return label;
}

void write(QLabel* label, const QString& text) {
  label->setText(text);
  label->setToolTip(text);
}

void keepWidthOf(QPushButton* button, const QStringList& texts) {
  const QString now = button->text();
  int width = 0;
  for (const QString& text : texts) {
    button->setText(text);
    width = std::max(width, button->sizeHint().width());
  }
  button->setText(now);
  button->setMinimumWidth(width);
}

PassBar::PassBar() {
  setRange(0, kPerMille);
}

void PassBar::show(double share, double pass_share, bool passes, const QString& text) {
  pass_share_ = pass_share;
  setValue(static_cast<int>(kPerMille * share));
  setFormat(text);
  setStyleSheet(QString("QProgressBar {border: 1px solid gray; text-align: center; color: black; background: #f0f0f0}"
                        "QProgressBar::chunk {background: %1}")
                    .arg(passes ? "#4fc3a1" : "#f0a070"));  // light enough for the text on them
  show();
}

void PassBar::paintEvent(QPaintEvent* event) {
  QProgressBar::paintEvent(event);
  QPainter painter(this);
  const int x = 1 + static_cast<int>(pass_share_ * (width() - 2));
  painter.setPen(QPen(Qt::black, 2));
  painter.drawLine(x, 0, x, height());
}

QString rounded(const std::string& number, int digits) {
  const std::optional<double> value = readNumber(number);
  return value ? QString::number(*value, 'f', digits) : QString::fromStdString(number);
}

void choose(QComboBox* box, const QString& text) {
  if (isUsed(box) || box->currentText() == text) return;
  const QSignalBlocker quiet(box);
  if (box->findText(text) < 0) box->addItem(text);
  box->setCurrentText(text);
}

void offer(QComboBox* box, const QStringList& choices) {
  if (isUsed(box)) return;
  QStringList shown;
  for (int i = 0; i < box->count(); ++i) shown += box->itemText(i);
  if (shown == choices) return;
  const QSignalBlocker quiet(box);
  const QString written = box->currentText();
  box->clear();
  box->addItems(choices);
  if (box->isEditable() || choices.contains(written)) box->setCurrentText(written);
}

}  // namespace viscera::rviz_plugin
