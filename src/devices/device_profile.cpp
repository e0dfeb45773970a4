// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "devices/device_profile.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "devices/da_vinci_arm.h"
#include "devices/device_fields.h"
#include "devices/registration_file.h"
#include "math/number_text.h"
#include "model/scene/key_table.h"
#include "model/scene/yaml/yaml_overrides.h"
#include "model/scene/yaml/yaml_reader.h"

namespace viscera {

namespace {

YAML::Node mapOf(const std::string& yaml, const std::string& where) {
  YAML::Node root = YAML::Load(yaml);
  if (!root.IsMap())
    throw DeviceError(where + ": a device profile must be a map of keys; `viscera keys device` lists them");
  return root;
}

void lay(const RegistrationFile& registration, DeviceProfile& device) {
  if (registration.tip_m) {
    device.tip.given = true;
    device.tip.position_m = *registration.tip_m;
  }
  if (registration.base) device.base = {true, registration.base->position_m, registration.base->orientation};
}

void replaceAll(std::string& text, const std::string& what, const std::string& by) {
  for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
}

/// Inserts the names. @throws DeviceError  the result is not a valid ROS name
void putNames(DeviceProfile& device, const std::string& where) {
  if (device.name.empty()) device.name = device.stylus;
  struct Named {
    const char* key;
    std::string* text;
  };
  for (const Named& named :
       {Named{"pose.topic", &device.pose.topic}, Named{"pose.frame", &device.pose.frame},
        Named{"pose.tf_frame", &device.pose.tf_frame}, Named{"pose.tf_base", &device.pose.tf_base},
        Named{"button1.topic", &device.button1.topic}, Named{"button2.topic", &device.button2.topic},
        Named{"clutch.topic", &device.clutch.topic}, Named{"gripper.topic", &device.gripper.topic},
        Named{"force.topic", &device.force.topic}, Named{"force.absolute_topic", &device.force.absolute_topic}}) {
    replaceAll(*named.text, "{stylus}", device.stylus);
    replaceAll(*named.text, "{name}", device.name);
    const bool good = std::all_of(named.text->begin(), named.text->end(), [](unsigned char c) {
      return std::isalnum(c) || c == '_' || c == '/' || c == '~' || c == '-' || c == '.';
    });
    if (!good)
      throw DeviceError(where + ": '" + named.key + "' gives '" + *named.text +
                        "', which is not a valid ROS name; it may contain `{name}` and `{stylus}`");
  }
}

void requireButton(const ButtonPort& button, const char* key, const std::string& where) {
  if (button.type != ButtonType::kNone && button.topic.empty())
    throw DeviceError(where + ": '" + key + ".topic' must name the topic of the button");
  if (button.type == ButtonType::kOmniButton && button.index > 1)
    throw DeviceError(where + ": '" + key + ".index' must be 0 (grey) or 1 (white) with type omni_button; found " +
                      std::to_string(button.index));
}

void requireGripper(const DeviceProfile& device, const std::string& where) {
  const GripperPort& gripper = device.gripper;
  if (gripper.presses == PressedButton::kNone || gripper.presses == PressedButton::kJaws) return;
  const bool first = gripper.presses == PressedButton::kButton1;
  if ((first ? device.button1 : device.button2).type != ButtonType::kNone)
    throw DeviceError(where + ": 'gripper.presses' and '" + (first ? "button1" : "button2") +
                      ".type' both press that button; set only one of them");
  if (gripper.open_above < gripper.closed_below)
    throw DeviceError(where + ": 'gripper.open_above' must not be less than 'gripper.closed_below', " +
                      numberText(gripper.closed_below) + "; found " + numberText(gripper.open_above));
}

void requireStart(const ArmConfig& arm, const std::string& where) {
  if (arm.joints == ArmJoints::kNone) return;
  const DaVinciArm joints(arm.joints);
  if (!joints.reach({arm.start_m, rotationFromDegrees(arm.start_rotation_deg)}, DaVinciArm::Joints(joints.count())))
    throw DeviceError(where +
                      ": the arm cannot reach 'arm.start_m' with 'arm.start_rotation_deg', of the tip relative " +
                      "to the remote centre; its joints are " + joints.limitsText());
}

/// Checks conditions that involve several keys.
void requireConsistent(const DeviceProfile& device, const std::string& where) {
  axesOf(device.pose.axes, where + ": 'pose.axes'");
  if (!device.pose.turn_axes.empty()) axesOf(device.pose.turn_axes, where + ": 'pose.turn_axes'");
  if (device.pose.type == PoseType::kTf && (device.pose.tf_frame.empty() || device.pose.tf_base.empty()))
    throw DeviceError(where + ": 'pose.type' tf needs 'pose.tf_frame' and 'pose.tf_base'");
  requireButton(device.button1, "button1", where);
  requireButton(device.button2, "button2", where);
  requireButton(device.clutch, "clutch", where);
  requireGripper(device, where);
  if (device.pose.type != PoseType::kCrtkArm) return;
  if (device.scale != 1 || device.clutch.type != ButtonType::kNone)
    throw DeviceError(
        where + ": an arm (pose.type crtk_arm) has no 'scale' and no 'clutch'; remove them: its driver has its own");
  requireStart(device.arm, where);
}

}  // namespace

Eigen::Matrix3d axesOf(const std::string& axes, const std::string& key) {
  const auto refuse = [&](const std::string& why) {
    throw DeviceError(key + " must contain x, y and z, each once, with or without '-', as in 'x -z y'" + why +
                      "; found '" + axes + "'");
  };
  TextIn words(axes);
  std::string word;
  Eigen::Matrix3d out = Eigen::Matrix3d::Zero();
  int row = 0;
  for (; words >> word; ++row) {
    const bool negative = word.front() == '-';
    const std::string letter = negative ? word.substr(1) : word;
    if (row > 2 || letter.size() != 1 || letter[0] < 'x' || letter[0] > 'z') refuse("");
    out(row, letter[0] - 'x') = negative ? -1 : 1;
  }
  if (row != 3 || std::abs(out.determinant()) != 1) refuse("");
  if (out.determinant() < 0) refuse(", and must not mirror the axes of the device");
  return out;
}

DeviceProfile parseDevice(const std::string& yaml, const std::string& where, const DeviceChoice& choice) {
  YamlSource source{where, {}};
  DeviceProfile device;
  try {
    YAML::Node root = mapOf(yaml, where);
    for (const std::string& text : choice.overrides) applyOverride(root, text, source);
    if (root["base"].IsDefined() && root["base"].IsNull()) root.remove("base");  // left to tf
    YamlReader::readMap(root, "", source, device);
  } catch (const YAML::Exception& error) {
    throw DeviceError(yamlFault(where, error, yaml));
  } catch (const SceneError& error) {
    throw DeviceError(error.what());
  }
  if (!choice.registration.empty()) lay(loadRegistration(choice.registration), device);
  device.file = where;
  device.stylus = choice.stylus;
  if (!choice.name.empty()) device.name = choice.name;
  putNames(device, where);
  requireConsistent(device, where);
  if (!choice.registration.empty() && device.base.given && device.scale != 1)
    throw DeviceError(where + ": 'scale' must be 1 with the registered base of " + choice.registration + "; found " +
                      numberText(device.scale));
  return device;
}

DeviceProfile loadDevice(const std::string& path, const DeviceChoice& choice) {
  try {
    return parseDevice(textOf(path, "device profile"), path, choice);
  } catch (const SceneError& error) {
    throw DeviceError(error.what());
  }
}

StylusConfig withDevice(StylusConfig stylus, const DeviceProfile& device) {
  stylus.max_force_n = std::min(stylus.max_force_n, device.force.max_force_n);
  stylus.max_torque_nm = hasTorque(device.force) ? std::min(stylus.max_torque_nm, device.force.max_torque_nm) : 0;
  if (device.stale_after_s > 0) stylus.stale_after_s = device.stale_after_s;
  return stylus;
}

std::string deviceKeysTable() {
  return keyTable<DeviceProfile>();
}

}  // namespace viscera
