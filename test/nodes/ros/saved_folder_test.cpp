// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/ros/saved_folder.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "support/temporary_folder.h"
#include "viscera/math/error.h"

namespace viscera::nodes {
namespace {

TEST(SavedFolder, TakesPlainNamesAlone) {
  const test::TemporaryFolder folder;
  const SavedFolder saved(folder.path(), 1);
  EXPECT_EQ(saved.pathOf("a.state"), folder.file("a.state"));
  for (const char* name : {"", ".hidden", "../a", "a/b", "/a"}) EXPECT_THROW(saved.pathOf(name), Error) << name;
}

TEST(SavedFolder, HasRoomUntilAllFilesInItReachTheLimit) {
  const test::TemporaryFolder folder;
  const SavedFolder saved(folder.path() + "/new", 2e-6);
  EXPECT_EQ(saved.room(), 2000U);
  folder.write("new/a", std::string(500, 'a'));
  std::filesystem::create_directory(folder.file("new/report"));
  folder.write("new/report/b", std::string(700, 'b'));
  EXPECT_EQ(saved.room(), 800U);
  folder.write("new/c", std::string(800, 'c'));
  try {
    saved.room();
    ADD_FAILURE() << "no limit";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("raise ~saved_limit_gb"), std::string::npos) << error.what();
  }
  std::filesystem::remove(folder.file("new/a"));
  EXPECT_EQ(saved.room(), 500U);
}

}  // namespace
}  // namespace viscera::nodes
