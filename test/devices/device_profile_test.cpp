// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "devices/device_profile.h"
#include "support/source_folder.h"
#include "viscera/model/scene/stylus_config.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace viscera {
namespace {

DeviceChoice choiceOf(const Overrides& overrides = {}) {
  DeviceChoice choice;
  choice.stylus = "left";
  choice.overrides = overrides;
  return choice;
}

DeviceProfile parsed(const std::string& yaml, const Overrides& overrides = {}) {
  return parseDevice(yaml, "device.yaml", choiceOf(overrides));
}

std::string fault(const std::string& yaml, const Overrides& overrides = {}) {
  try {
    parsed(yaml, overrides);
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "none";
}

constexpr const char* kCrtk = "about: a device\n";

TEST(DeviceProfile, EveryShippedOneLoadsForAnyStylus) {
  size_t profiles = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::sourceFolder() + "/config/devices")) {
    const DeviceProfile device = loadDevice(entry.path().string(), choiceOf());
    EXPECT_FALSE(device.about.empty()) << entry.path();
    EXPECT_EQ(device.pose.topic.find('{'), std::string::npos) << entry.path();
    ++profiles;
  }
  EXPECT_GE(profiles, 11u);
}

TEST(DeviceProfile, NameOfTheDriverIsTheStylussUnlessGiven) {
  const std::string yaml = "{about: a, pose: {topic: \"{name}/pose\"}, force: {topic: \"{stylus}/force\"}}";
  EXPECT_EQ(parsed(yaml).pose.topic, "left/pose");
  DeviceChoice choice = choiceOf();
  choice.name = "/room/phantom";
  const DeviceProfile device = parseDevice(yaml, "device.yaml", choice);
  EXPECT_EQ(device.pose.topic, "/room/phantom/pose");
  EXPECT_EQ(device.force.topic, "left/force");
}

TEST(DeviceProfile, OptionsReplaceKeys) {
  const DeviceProfile device = parsed(kCrtk, {"pose.unit_m=0.001", "tip.position_m=[0,0,-0.1]"});
  EXPECT_EQ(device.pose.unit_m, 0.001);
  EXPECT_TRUE(device.tip.given);
  EXPECT_EQ(device.tip.position_m, Vector3d(0, 0, -0.1));
  EXPECT_FALSE(device.base.given);
}

TEST(DeviceProfile, NullLeavesTheBaseToTf) {
  const std::string yaml = "{about: a, base: {position_m: [0, 0, 1]}}";
  EXPECT_TRUE(parsed(yaml).base.given);
  EXPECT_FALSE(parsed(yaml, {"base=null"}).base.given);
}

TEST(DeviceProfile, RegistrationIsLaidOverIt) {
  const std::string path = ::testing::TempDir() + "registration.yaml";
  std::ofstream(path)
      << "tip: {position_m: [0, 0, -0.15]}\nbase: {position_m: [0.1, 0, 0], orientation_xyzw: [0, 0, 1, 0]}\n"
         "residual_mm: 0.4\n";
  DeviceChoice choice = choiceOf();
  choice.registration = path;
  const DeviceProfile device = parseDevice("{tip: {orientation_xyzw: [1, 0, 0, 0]}}", "device.yaml", choice);
  EXPECT_EQ(device.tip.position_m, Vector3d(0, 0, -0.15));
  EXPECT_EQ(device.tip.orientation.x(), 1);  // a pivot calibration does not determine it
  EXPECT_EQ(device.base.position_m, Vector3d(0.1, 0, 0));
  EXPECT_EQ(device.base.orientation.z(), 1);
  choice.overrides = {"scale=2"};
  EXPECT_THROW(parseDevice(kCrtk, "device.yaml", choice), DeviceError);
}

TEST(DeviceProfile, ErrorsNameFileLineKeyAndWhatIsAccepted) {
  EXPECT_EQ(fault("about: a\nbutton3: {}\n"),
            "device.yaml:2: unknown key 'button3'; accepted here: button1, button2, about, name, pose, tip, base, "
            "scale, stale_after_s, delay_s, clutch, gripper, force, arm");
  EXPECT_EQ(fault("about: a\npose: {unit_m: 1000}\n"),
            "device.yaml:2: 'pose.unit_m' must be a number, 1e-06 .. 10 m; found '1000'");
  EXPECT_EQ(fault("about: a\npose: {type: tf, tf_frame: a}\n"),
            "device.yaml: 'pose.type' tf needs 'pose.tf_frame' and 'pose.tf_base'");
  EXPECT_EQ(fault("[]"), "device.yaml: a device profile must be a map of keys; `viscera keys device` lists them");
  EXPECT_EQ(
      fault(kCrtk, {"pose.topic=a b"}),
      "device.yaml: 'pose.topic' gives 'a b', which is not a valid ROS name; it may contain `{name}` and `{stylus}`");
  EXPECT_EQ(fault(kCrtk, {"button1.type=joy"}), "device.yaml: 'button1.topic' must name the topic of the button");
  EXPECT_EQ(fault(kCrtk, {"tip.orientation_xyzw=[1,1,0,0]"}),
            "override: 'tip.orientation_xyzw' must be a list of x, y, z, w, a quaternion of length 1; found a list of "
            "4 items");
}

TEST(DeviceProfile, RefusesWhatContradictsItself) {
  const std::string both = "{button1: {type: joy, topic: a}, gripper: {presses: button1}}";
  EXPECT_EQ(fault(both),
            "device.yaml: 'gripper.presses' and 'button1.type' both press that button; set only one of them");
  EXPECT_NE(fault("{gripper: {presses: button1, closed_below: 1, open_above: 0}}").find("must not be less"),
            std::string::npos);
  EXPECT_NE(fault("{pose: {type: crtk_arm}, scale: 2}").find("its driver has its own"), std::string::npos);
  EXPECT_NE(fault("{button1: {type: omni_button, topic: a, index: 2}}").find("0 (grey) or 1 (white)"),
            std::string::npos);
}

TEST(DeviceProfile, AxesAreARotation) {
  EXPECT_EQ(axesOf("x -z y", "axes") * Vector3d(1, 2, 3), Vector3d(1, -3, 2));
  for (const char* wrong : {"x y", "x y y", "x y z x", "x y w", "x y -z", "", "xx y z"})
    EXPECT_THROW(axesOf(wrong, "axes"), DeviceError) << wrong;
}

TEST(DeviceProfile, LimitsAreTheNarrower) {
  StylusConfig stylus;
  stylus.max_force_n = 5;
  stylus.stale_after_s = 0.2;
  EXPECT_EQ(withDevice(stylus, parsed(kCrtk)).max_force_n, 5);
  EXPECT_EQ(withDevice(stylus, parsed(kCrtk)).stale_after_s, 0.2);
  const DeviceProfile weak = parsed(kCrtk, {"force.max_force_n=3.3", "stale_after_s=0.5"});
  EXPECT_EQ(withDevice(stylus, weak).max_force_n, 3.3);
  EXPECT_EQ(withDevice(stylus, weak).stale_after_s, 0.5);
  // A scene with a limit above that of usual devices is limited, unless the profile allows more.
  stylus.max_force_n = 1000;
  EXPECT_EQ(withDevice(stylus, parsed(kCrtk)).max_force_n, ForcePort{}.max_force_n);
  EXPECT_LE(ForcePort{}.max_force_n, 10);
  EXPECT_EQ(withDevice(stylus, parsed(kCrtk, {"force.type=omni_feedback"})).max_torque_nm, 0);
}

}  // namespace
}  // namespace viscera
