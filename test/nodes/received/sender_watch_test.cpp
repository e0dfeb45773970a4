// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/received/sender_watch.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>

namespace viscera::received {
namespace {

constexpr std::chrono::milliseconds kLimit{300};

TEST(SenderWatch, SeesAtOnceThatANodeHasDied) {
  const int file = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  ASSERT_EQ(bind(file, reinterpret_cast<sockaddr*>(&address), size), 0);
  ASSERT_EQ(listen(file, 1), 0);
  ASSERT_EQ(getsockname(file, reinterpret_cast<sockaddr*>(&address), &size), 0);
  const std::string uri = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port)) + "/";
  EXPECT_TRUE(listens(uri, kLimit));
  close(file);
  EXPECT_FALSE(listens(uri, kLimit));
}

TEST(SenderWatch, AnAddressThatIsNoneDoesNotListen) {
  EXPECT_FALSE(listens("", kLimit));
  EXPECT_FALSE(listens("http://", kLimit));
  EXPECT_FALSE(listens("http://a_host_that_is_not_there.invalid:1/", kLimit));
}

}  // namespace
}  // namespace viscera::received
