// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/forces/wrench_watchdog.h"

#include <gtest/gtest.h>

#include <string>

#include "support/source_folder.h"

namespace viscera::nodes {
namespace {

WatchdogOptions optionsOf(const std::string& device, const std::string& stylus, const std::string& device_options) {
  XmlRpc::XmlRpcValue values;
  values["device"] = device;
  if (!stylus.empty()) values["stylus"] = stylus;
  values["device_options"] = device_options;
  Parameters parameters(values);
  return watchdogOptions(parameters, test::sourceFolder());
}

TEST(WatchdogOptions, OfAStylusSendToTheTopicOfItsProfile) {
  EXPECT_EQ(optionsOf("crtk", "left", "").topic, "left/body/servo_cf");
  EXPECT_EQ(optionsOf("phantom_omni", "left", "").topic, "phantom/force_feedback");
  EXPECT_EQ(optionsOf("phantom_omni:desk", "right", "").topic, "desk/force_feedback");
  EXPECT_EQ(optionsOf("dvrk_mtm", "right", "left.force.topic=others").topic, "MTMR/body/servo_cf");
  EXPECT_EQ(optionsOf("crtk", "right", "right.force.topic=mine;left.scale=0.5").topic, "mine");
}

TEST(WatchdogOptions, WithoutAStylusSendToWrenchOutWhichTheCommandLineNames) {
  EXPECT_EQ(optionsOf("phantom_omni", "", "").topic, "wrench_out");
  EXPECT_THROW(optionsOf("polhemus", "", ""), ParameterError);
  EXPECT_EQ(optionsOf("polhemus", "left", "").port.type, ForceType::kNone) << "left alone";
}

}  // namespace
}  // namespace viscera::nodes
