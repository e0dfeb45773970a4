// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#if __has_include(<boost/beast/websocket.hpp>)
#include "nodes/page/web_rules.h"

#include <gtest/gtest.h>

namespace viscera::nodes {
namespace {

TEST(WebRules, AHostIsLocalhostOrAnAddress) {
  for (const char* host : {"localhost", "localhost:8765", "127.0.0.1:8765", "10.0.0.7", "[::1]:80", "[fe80::1]"})
    EXPECT_TRUE(isHostAllowed(host)) << host;
  for (const char* host : {"", "evil.example", "127.0.0.1.evil.example", "localhost.evil.example:8765", "localhost:",
                           "[::1", "[::1]evil", "127.0.0.1:8765:1", "localhost:123456", "2130706433", "[]", ":80"})
    EXPECT_FALSE(isHostAllowed(host)) << host;
}

TEST(WebRules, AWebSocketIsOfTheServersOwnPageOrOfNoPage) {
  EXPECT_TRUE(isOriginAllowed("", "localhost:1"));
  EXPECT_TRUE(isOriginAllowed("http://localhost:1", "localhost:1"));
  for (const char* origin :
       {"http://localhost", "http://localhost:12", "https://localhost:1", "null", "http://evil.example"})
    EXPECT_FALSE(isOriginAllowed(origin, "localhost:1")) << origin;
}

TEST(WebRules, MessagesAreTheViewersOrNone) {
  EXPECT_EQ(clientMessageOf(R"({"shown": 7})")->shown, 7U);
  EXPECT_EQ(clientMessageOf(R"({"call": "reset"})")->service, "reset");
  EXPECT_EQ(clientMessageOf(R"({"call": "start_task", "task": "incision"})")->task, "incision");
  for (const char* text :
       {"", "7", "[]", "{}", "{", R"({"shown": -1})", R"({"shown": 1.5})", R"({"shown": 4294967296})",
        R"({"shown": "1"})", R"({"shown": 1, "call": "reset"})", R"({"call": "load_scene"})",
        R"({"call": "reset", "task": "a"})", R"({"call": "start_task"})", R"({"call": "start_task", "task": 1})",
        R"({"call": "start_task", "task": "/etc/passwd"})", R"({"call": ["reset"]})"})
    EXPECT_FALSE(clientMessageOf(text)) << text;
  EXPECT_FALSE(clientMessageOf(R"({"call": "start_task", "task": ")" + std::string(2000, 'x') + "\"}"));
  EXPECT_FALSE(clientMessageOf(std::string(4096, '[')));
}

}  // namespace
}  // namespace viscera::nodes
#endif
