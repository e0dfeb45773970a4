// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace viscera::nodes {

/// Returns whether a Host header is `localhost` or an IP address, with or without a port. A web page elsewhere can lead
/// its own host name to this machine, but neither of these.
bool isHostAllowed(std::string_view host);
/// Returns whether a web socket may be opened: by a page that this server sent, or by a program that is no browser.
/// @param origin  Origin header; empty: none   @param host  Host header
bool isOriginAllowed(std::string_view origin, std::string_view host);

/// Message of a browser.
struct ClientMessage {
  std::optional<uint32_t> shown;  ///< number of a frame that it has drawn; without one: a call
  std::string service, task;
};
/// Returns a message from its text; nothing if it is not one of live_message.h.
std::optional<ClientMessage> clientMessageOf(const std::string& text);

}  // namespace viscera::nodes
