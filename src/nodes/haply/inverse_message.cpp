// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/haply/inverse_message.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace viscera::nodes {
namespace {

using Json = nlohmann::json;

constexpr const char* kDevices = "inverse3";
constexpr const char* kGrips[] = {"verse_grip", "wireless_verse_grip", "custom_verse_grip"};
constexpr double kUnitTolerance = 0.1;  // of the norm of a quaternion, as for other devices

Json parsed(const std::string& text) {
  Json message = Json::parse(text, nullptr, false);
  if (!message.is_object()) throw InverseError("a message is no JSON object");
  return message;
}

/// Returns a member, or null.
const Json& at(const Json& object, const char* key) {
  static const Json kNull;
  if (!object.is_object()) return kNull;
  const auto found = object.find(key);
  return found == object.end() ? kNull : *found;
}

std::string textOf(const Json& value) {
  return value.is_string() ? value.get<std::string>() : std::string();
}

double number(const Json& object, const char* key, const std::string& of) {
  const Json& value = at(object, key);
  if (!value.is_number() || !std::isfinite(value.get<double>()))
    throw InverseError(of + "." + key + " must be a finite number");
  return value.get<double>();
}

Vector3d vector(const Json& state, const char* key) {
  const Json& value = at(state, key);
  return {number(value, "x", key), number(value, "y", key), number(value, "z", key)};
}

Quaterniond quaternion(const Json& state, const char* key) {
  const Json& value = at(state, key);
  const Quaterniond q(number(value, "w", key), number(value, "x", key), number(value, "y", key),
                      number(value, "z", key));
  if (!(std::abs(q.norm() - 1) <= kUnitTolerance)) throw InverseError(std::string(key) + " must be a unit quaternion");
  return q.normalized();
}

/// Calls use(device) for the devices of an array until it returns true. @returns whether it did
template <class Use>
bool anyOf(const Json& message, const char* kind, const Use& use) {
  for (const Json& device : at(message, kind))
    if (!textOf(at(device, "device_id")).empty() && use(device)) return true;
  return false;
}

const Json* findDevice(const Json& message, const char* kind, const std::string& id) {
  const Json* found = nullptr;
  anyOf(message, kind, [&](const Json& device) {
    if (textOf(at(device, "device_id")) != id) return false;
    found = &device;
    return true;
  });
  return found;
}

std::string firstGrip(const Json& message, const std::string& wanted, std::string& list) {
  std::string id;
  for (const char* kind : kGrips) {
    const bool found = anyOf(message, kind, [&](const Json& grip) {
      const std::string own = textOf(at(grip, "device_id"));
      list += " " + own;
      if (wanted != "any" && wanted != own) return false;
      id = own;
      return true;
    });
    if (found) break;
  }
  return id;
}

void readButtons(const Json& state, InverseState& out) {
  const Json& buttons = at(state, "buttons");
  const char* const names[] = {"a", "b", "c"};
  for (size_t i = 0; i < out.buttons.size(); ++i) out.buttons[i] = at(buttons, names[i]) == Json(true);
  if (at(state, "button") == Json(true)) out.buttons[0] = true;  // a VerseGrip with a cable has one
}

}  // namespace

InverseDevices chooseDevices(const std::string& inventory, const std::string& device, const std::string& grip) {
  const Json message = parsed(inventory);
  InverseDevices out;
  out.has_session = !at(message, "session_id").is_null();
  std::string list;
  anyOf(message, kDevices, [&](const Json& one) {
    const std::string id = textOf(at(one, "device_id")), hand = textOf(at(at(one, "config"), "handedness"));
    list += " " + id + (hand.empty() ? "" : " (" + hand + ")");
    if (device != "any" && device != id && device != hand) return false;
    out.device = id;
    out.description = id + (hand.empty() ? "" : ", " + hand + "-handed");
    return true;
  });
  if (out.device.empty())
    throw InverseError("the service has no Inverse3" + (device == "any" ? "" : " '" + device + "' (~device)") +
                       "; it has" + (list.empty() ? " none" : list));
  if (grip == "none") return out;
  std::string grips;
  out.grip = firstGrip(message, grip, grips);
  out.watches_for_grip = out.grip.empty();
  if (out.grip.empty() && grip != "any")
    throw InverseError("the service has no grip '" + grip + "' (~grip); it has" + (grips.empty() ? " none" : grips));
  return out;
}

InverseState readState(const std::string& text, const InverseDevices& devices) {
  const Json message = parsed(text);
  const Json* const device = findDevice(message, kDevices, devices.device);
  if (!device) throw InverseError("a state lacks the device " + devices.device);
  const Json& state = at(*device, "state");
  InverseState out;
  out.position_m = vector(state, "cursor_position");
  out.velocity_m_per_s = vector(state, "cursor_velocity");
  out.calibrated = at(at(*device, "status"), "calibrated") != Json(false);
  if (devices.grip.empty()) {
    std::string ignored;
    if (devices.watches_for_grip) out.grip_came = firstGrip(message, "any", ignored);
    return out;
  }
  for (const char* kind : kGrips) {
    const Json* const grip = findDevice(message, kind, devices.grip);
    if (!grip) continue;
    out.grip = quaternion(at(*grip, "state"), "orientation");
    readButtons(at(*grip, "state"), out);
    return out;
  }
  throw InverseError("a state lacks the grip " + devices.grip);
}

std::string forceCommand(const InverseDevices& devices, const Vector3d& force_n, bool first) {
  const Json force = {{"x", force_n.x()}, {"y", force_n.y()}, {"z", force_n.z()}};
  const Json command = {{"set_cursor_force", {{devices.has_session ? "vector" : "values", force}}}};
  Json message = {{kDevices, Json::array({{{"device_id", devices.device}, {"commands", command}}})}};
  if (first && devices.has_session)
    message["session"] = {{"configure", {{"profile", {{"name", "viscera:haply_bridge"}}}}}};
  return message.dump(-1, ' ', true, Json::error_handler_t::replace);
}

}  // namespace viscera::nodes
