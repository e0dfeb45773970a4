// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/panel_style.h"

#include <gtest/gtest.h>

#include <QApplication>
#include <QImage>
#include <QWheelEvent>
#include <array>
#include <string>

#include "rviz/tool_table.h"
#include "support/comma_locale.h"

namespace viscera::rviz_plugin {
namespace {

constexpr int kNotch = 120;  // of the mouse wheel

/// Widgets need one, without a screen.
QApplication& application() {
  static int count = 1;
  static char name[] = "test_rviz";
  static char* arguments[] = {name, nullptr};
  qputenv("QT_QPA_PLATFORM", "offscreen");
  static QApplication made(count, arguments);
  return made;
}

/// One notch of the wheel over a widget. @returns whether the widget leaves it to what is around it
bool turnsWheelPast(QWidget& widget, int notch) {
  QWheelEvent event(QPointF(2, 2), widget.mapToGlobal(QPointF(2, 2).toPoint()), QPoint(), QPoint(0, notch),
                    Qt::NoButton, Qt::NoModifier, Qt::NoScrollPhase, false);
  QApplication::sendEvent(&widget, &event);
  return !event.isAccepted();
}

TEST(PanelStyle, BarHasALineWhereItPasses) {
  application();
  PassBar bar;
  bar.resize(202, 20);
  const auto colors = [&bar](double share) {
    bar.show(share, 0.5, share >= 0.5, QString());
    const QImage image = bar.grab().toImage();
    return std::array<QColor, 3>{image.pixelColor(30, 10), image.pixelColor(101, 10), image.pixelColor(170, 10)};
  };
  const auto low = colors(0.25), high = colors(0.75);
  EXPECT_EQ(low[1], QColor(Qt::black));
  EXPECT_EQ(high[1], QColor(Qt::black));
  EXPECT_GT(low[0].red(), low[0].green());    // orange
  EXPECT_GT(high[0].green(), high[0].red());  // green
  EXPECT_EQ(low[2], high[2]);                 // beyond both
}

TEST(PanelStyle, WheelOverAClosedBoxScrollsPast) {
  application();
  ChoiceBox box;
  box.addItems({"grab", "cut", "cautery"});
  box.setCurrentIndex(1);
  int chosen = 0;
  QObject::connect(&box, QOverload<int>::of(&QComboBox::activated), [&](int) { ++chosen; });
  CountBox count;
  count.setRange(1, 100);
  count.setValue(50);
  for (const int notch : {kNotch, -kNotch}) {
    EXPECT_TRUE(turnsWheelPast(box, notch));
    EXPECT_TRUE(turnsWheelPast(count, notch));
  }
  EXPECT_EQ(box.currentIndex(), 1);
  EXPECT_EQ(count.value(), 50);
  EXPECT_EQ(chosen, 0);
}

TEST(PanelStyle, WheelOverAToolTableCallsNoService) {
  application();
  int chosen = 0;
  ToolTable table([&](const std::string&, const std::string&, const std::string&) { ++chosen; });
  table.show({{"left", {"none", "grab", "cut"}, "tracked", "1.5", "2", "0"}});
  const QList<QComboBox*> boxes = table.findChildren<QComboBox*>();
  ASSERT_EQ(boxes.size(), 3);
  for (QComboBox* box : boxes) {
    const QString before = box->currentText();
    for (const int notch : {kNotch, -kNotch}) turnsWheelPast(*box, notch);
    EXPECT_EQ(box->currentText(), before);
  }
  EXPECT_EQ(chosen, 0);
}

TEST(PanelStyle, TextThatGrowsDoesNotMoveWhatIsBelow) {
  application();
  QLabel* const label = steadyLabel(2);
  const int height = label->sizeHint().height();
  write(label, "tracked");
  EXPECT_EQ(label->minimumHeight(), label->maximumHeight());
  write(label, QString("several nodes send poses: /a, /b ").repeated(20));
  EXPECT_EQ(label->minimumHeight(), label->maximumHeight());
  EXPECT_GE(height, 0);
  EXPECT_EQ(label->sizePolicy().horizontalPolicy(), QSizePolicy::Ignored);
  delete label;
}

TEST(PanelStyle, ButtonIsAsWideAsItsWidestText) {
  application();
  QPushButton button("Re&cord");
  keepWidthOf(&button, {"Re&cord", "Stop re&cording"});
  EXPECT_EQ(button.text(), "Re&cord");
  EXPECT_FALSE(button.shortcut().isEmpty());
  const int width = button.minimumWidth();
  button.setText("Stop re&cording");
  EXPECT_LE(button.sizeHint().width(), width);
  EXPECT_EQ(button.shortcut(), QKeySequence("Alt+C"));
}

TEST(PanelStyle, NumbersHaveAPointInEveryLocale) {
  application();
  const test::CommaLocale locale;
  ASSERT_TRUE(locale.hasC()) << "localedef cannot make de_DE.UTF-8: install the Debian package locales";
  EXPECT_EQ(rounded("1.73", 2), "1.73");
  EXPECT_EQ(rounded("-0.5", 1), "-0.5");
  EXPECT_EQ(rounded("1e-05", 5), "0.00001");
  EXPECT_EQ(rounded("1,73", 2), "1,73");
  EXPECT_EQ(rounded("none", 2), "none");
  ToolTable table([](const std::string&, const std::string&, const std::string&) {});
  table.show({{"left", {"none", "grab", "cut"}, "tracked", "1.73", "2", "0"}});
  bool found = false;
  for (const QLabel* label : table.findChildren<QLabel*>()) found = found || label->text().contains("1.73 N");
  EXPECT_TRUE(found);
}

}  // namespace
}  // namespace viscera::rviz_plugin
