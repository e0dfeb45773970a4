// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/haply/inverse_message.h"

#include <gtest/gtest.h>

namespace viscera::nodes {
namespace {

/// Inventory after the example of docs.haply.co: two devices, and grips with and without a cable.
constexpr const char* kInventory = R"({"session_id": 7, "inverse3": [
  {"device_id": "049D", "config": {"handedness": "right"},
   "state": {"cursor_position": {"x": 0.01, "y": -0.12, "z": 0.15}, "cursor_velocity": {"x": 0, "y": 1, "z": 0}}},
  {"device_id": "04BA", "config": {"handedness": "left"},
   "state": {"cursor_position": {"x": 0.02, "y": -0.1, "z": 0.1}, "cursor_velocity": {"x": 0, "y": 0, "z": 0}}}],
  "verse_grip": [{"device_id": "61548", "state": {"button": true, "hall": 0, "orientation": {"x": 0, "y": 0, "z": 0, "w": 1}}}],
  "wireless_verse_grip": [{"device_id": "6", "state": {"buttons": {"a": false, "b": true, "c": true},
                           "orientation": {"x": 0, "y": 0, "z": 0.6, "w": 0.8}}}]})";

std::string errorOf(const std::string& device, const std::string& grip) {
  try {
    chooseDevices(kInventory, device, grip);
  } catch (const InverseError& error) {
    return error.what();
  }
  return {};
}

TEST(InverseMessage, ChoosesDevicesByHandednessAndIdentifier) {
  EXPECT_EQ(chooseDevices(kInventory, "any", "any").device, "049D");
  EXPECT_EQ(chooseDevices(kInventory, "left", "any").device, "04BA");
  EXPECT_EQ(chooseDevices(kInventory, "04BA", "6").grip, "6");
  EXPECT_EQ(chooseDevices(kInventory, "any", "any").grip, "61548");
  EXPECT_EQ(chooseDevices(kInventory, "any", "none").grip, "");
  EXPECT_FALSE(chooseDevices(kInventory, "any", "none").watches_for_grip);
  EXPECT_EQ(errorOf("0000", "any"), "the service has no Inverse3 '0000' (~device); it has 049D (right) 04BA (left)");
  EXPECT_EQ(errorOf("any", "7"), "the service has no grip '7' (~grip); it has 61548 6");
}

TEST(InverseMessage, ReadsBothKindsOfGrips) {
  const InverseState wired = readState(kInventory, chooseDevices(kInventory, "any", "61548"));
  EXPECT_EQ(wired.position_m, Vector3d(0.01, -0.12, 0.15));
  EXPECT_EQ(wired.velocity_m_per_s, Vector3d(0, 1, 0));
  EXPECT_EQ(wired.buttons, (std::array<bool, 3>{true, false, false}));
  const InverseState wireless = readState(kInventory, chooseDevices(kInventory, "left", "6"));
  EXPECT_EQ(wireless.position_m.x(), 0.02);
  EXPECT_EQ(wireless.buttons, (std::array<bool, 3>{false, true, true}));
  EXPECT_NEAR(wireless.grip->z(), 0.6, 1e-15);
}

TEST(InverseMessage, FindsAGripThatComesLater) {
  InverseDevices devices;
  devices.device = "049D";
  EXPECT_EQ(readState(kInventory, devices).grip_came, "");
  devices.watches_for_grip = true;
  EXPECT_EQ(readState(kInventory, devices).grip_came, "61548");
  devices.grip = "6";
  EXPECT_EQ(readState(kInventory, devices).grip_came, "");
}

TEST(InverseMessage, WritesForcesForBothVersionsOfTheService) {
  InverseDevices devices = chooseDevices(kInventory, "any", "any");
  EXPECT_EQ(
      forceCommand(devices, {1, 0, -2.5}, false),
      R"({"inverse3":[{"commands":{"set_cursor_force":{"vector":{"x":1.0,"y":0.0,"z":-2.5}}},"device_id":"049D"}]})");
  EXPECT_NE(forceCommand(devices, Vector3d::Zero(), true).find(R"("session":{"configure":{"profile")"),
            std::string::npos);
  devices.has_session = false;
  EXPECT_EQ(
      forceCommand(devices, {0, 0, 1}, true),
      R"({"inverse3":[{"commands":{"set_cursor_force":{"values":{"x":0.0,"y":0.0,"z":1.0}}},"device_id":"049D"}]})");
}

}  // namespace
}  // namespace viscera::nodes
