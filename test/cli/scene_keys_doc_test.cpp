// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>

#include "cli/small_scene.h"

namespace viscera {
namespace {

using namespace test;

constexpr const char* kRenew =
    "renew the table: sed -i '/^|/d' docs/scene_keys.md && build/viscera keys >> docs/scene_keys.md";

/// Lines from the head of the table to the end of the text.
std::vector<std::string> tableOf(const std::string& text) {
  const size_t head = text.find("| key |");
  return head == std::string::npos ? std::vector<std::string>() : linesOf(text.substr(head));
}

TEST(Keys, DocumentHoldsTheTableThatTheCommandPrints) {
  const std::vector<std::string> document = tableOf(readFile(std::string(VISCERA_SOURCE_DIR) + "/docs/scene_keys.md"));
  const std::vector<std::string> printed = tableOf(viscera({"keys"}).out);
  ASSERT_FALSE(printed.empty());
  for (size_t i = 0; i < std::min(document.size(), printed.size()); ++i) ASSERT_EQ(document[i], printed[i]) << kRenew;
  EXPECT_EQ(document.size(), printed.size()) << kRenew;
}

}  // namespace
}  // namespace viscera
