// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/page/web_rules.h"

#include <arpa/inet.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

namespace viscera::nodes {
namespace {

constexpr size_t kLongestTask = 100;  // letters of its name

bool isAddress(int family, std::string_view text) {
  unsigned char bytes[sizeof(in6_addr)];
  return inet_pton(family, std::string(text).c_str(), bytes) == 1;
}

bool isPort(std::string_view text) {
  constexpr size_t kLongest = 5;
  return !text.empty() && text.size() <= kLongest &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

bool isHostAllowed(std::string_view host) {
  const bool bracketed = !host.empty() && host[0] == '[';
  const size_t end = bracketed ? host.find(']') : host.find(':');
  if (bracketed && end == std::string_view::npos) return false;
  const std::string_view name = bracketed ? host.substr(1, end - 1) : host.substr(0, end);
  const size_t after = bracketed ? end + 1 : std::min(end, host.size());
  const std::string_view rest = host.substr(after);
  if (!rest.empty() && (rest[0] != ':' || !isPort(rest.substr(1)))) return false;
  if (bracketed) return isAddress(AF_INET6, name);
  return name == "localhost" || isAddress(AF_INET, name);
}

bool isOriginAllowed(std::string_view origin, std::string_view host) {
  constexpr std::string_view kScheme = "http://";
  return origin.empty() || (origin.substr(0, kScheme.size()) == kScheme && origin.substr(kScheme.size()) == host);
}

std::optional<ClientMessage> clientMessageOf(const std::string& text) {
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  ClientMessage out;
  const auto shown = json.find("shown"), call = json.find("call"), task = json.find("task");
  if (shown != json.end() && json.size() == 1) {
    if (!shown->is_number_unsigned() || shown->get<uint64_t>() > std::numeric_limits<uint32_t>::max())
      return std::nullopt;
    out.shown = shown->get<uint32_t>();
    return out;
  }
  if (call == json.end() || !call->is_string()) return std::nullopt;
  out.service = call->get<std::string>();
  const bool starts = out.service == "start_task";
  if (json.size() != (starts ? 2 : 1)) return std::nullopt;
  if (!starts && out.service != "reset" && out.service != "pause" && out.service != "resume") return std::nullopt;
  if (!starts) return out;
  if (task == json.end() || !task->is_string()) return std::nullopt;
  out.task = task->get<std::string>();
  if (out.task.size() > kLongestTask || out.task.find('/') != std::string::npos) return std::nullopt;  // no paths
  return out;
}

}  // namespace viscera::nodes
