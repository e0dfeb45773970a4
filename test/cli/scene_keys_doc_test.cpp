// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>

#include "cli/small_scene.h"
#include "support/source_folder.h"

namespace viscera {
namespace {

using namespace test;

std::string renew(const std::string& document, const std::string& command) {
  return "renew the table: sed -i '/^|/d' " + document + " && build/viscera " + command + " >> " + document;
}

/// Returns the lines from the header of the table to the end of the text.
std::vector<std::string> tableOf(const std::string& text, const std::string& of) {
  const size_t head = text.find("| " + of + " |");
  return head == std::string::npos ? std::vector<std::string>() : linesOf(text.substr(head));
}

void expectTable(const std::string& name, const std::vector<std::string>& command, const std::string& of = "key") {
  const std::vector<std::string> document = tableOf(readFile(sourceFolder() + "/" + name), of);
  const std::vector<std::string> printed = tableOf(viscera(command).out, of);
  const std::string how = renew(name, command.size() > 1 ? "keys " + command[1] : "keys");
  ASSERT_FALSE(printed.empty());
  for (size_t i = 0; i < std::min(document.size(), printed.size()); ++i) ASSERT_EQ(document[i], printed[i]) << how;
  EXPECT_EQ(document.size(), printed.size()) << how;
}

TEST(Keys, DocumentHoldsTheTableThatTheCommandPrints) {
  expectTable("docs/scene_keys.md", {"keys"});
}

TEST(Keys, DocumentOfDevicesToo) {
  expectTable("docs/device_keys.md", {"keys", "device"});
}

TEST(Keys, DocumentOfTasksToo) {
  expectTable("docs/lessons/task_keys.md", {"keys", "task"});
}

TEST(Keys, DocumentOfTissuesToo) {
  expectTable("docs/tissues.md", {"keys", "tissues"}, "tissue");
}

TEST(Keys, DocumentOfFeaturesToo) {
  expectTable("docs/material.md", {"keys", "features"}, "feature");
}

}  // namespace
}  // namespace viscera
