// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Files of saved states: every bit is checked, and a killed writer leaves the old file or the new one.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "session/state_file.h"
#include "support/temporary_folder.h"

namespace viscera {
namespace {

using namespace test;

std::vector<Archive::Section> someSections(size_t bytes, char content) {
  return {{"scene", std::vector<char>(100, content)}, {"nodes", std::vector<char>(bytes, content)}, {"hands", {}}};
}

/// Returns the drafts left by writers that were killed or have not finished.
std::vector<std::string> draftsIn(const std::string& folder) {
  std::vector<std::string> out;
  for (const auto& file : std::filesystem::directory_iterator(folder))
    if (file.path().extension() == ".draft") out.push_back(file.path());
  return out;
}

std::string textOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void expectRefused(const TemporaryFolder& folder, const std::string& bytes, const std::string& what) {
  const std::string path = folder.write("spoilt", bytes);
  try {
    readStateFile(path);
    ADD_FAILURE() << what << " was taken";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
  }
}

/// As expectRefused(), from memory: the same function reads both (IsInMemoryWhatItIsOnTheDisk).
void expectBytesRefused(const std::string& bytes, const std::string& what) {
  try {
    readStateBytes(bytes, "memory");
    ADD_FAILURE() << what << " was taken";
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).rfind("memory: ", 0), 0u) << error.what();
  }
}

TEST(StateFile, ComesBackAsItWas) {
  const TemporaryFolder folder;
  const auto sections = someSections(70000, 'a');
  writeStateFile(folder.file("state"), sections);
  const auto read = readStateFile(folder.file("state"));
  ASSERT_EQ(read.size(), sections.size());
  for (size_t s = 0; s < read.size(); ++s) {
    EXPECT_EQ(read[s].name, sections[s].name);
    EXPECT_EQ(read[s].bytes, sections[s].bytes);
  }
  EXPECT_TRUE(draftsIn(folder.path()).empty());
}

TEST(StateFile, IsInMemoryWhatItIsOnTheDisk) {
  const TemporaryFolder folder;
  const auto sections = someSections(70000, 'a');
  writeStateFile(folder.file("state"), sections);
  const std::string bytes = stateBytes(sections);
  EXPECT_EQ(bytes, textOf(folder.file("state")));
  const auto read = readStateBytes(bytes, "memory");
  ASSERT_EQ(read.size(), sections.size());
  for (size_t s = 0; s < read.size(); ++s) EXPECT_EQ(read[s].bytes, sections[s].bytes);
  for (const std::string& spoilt : {std::string(), bytes.substr(0, bytes.size() - 1), bytes + "x"})
    expectBytesRefused(spoilt, std::to_string(spoilt.size()) + " bytes");
}

TEST(StateFile, EveryTurnedBitIsRefused) {
  const std::string whole = stateBytes(someSections(60, 'b'));
  for (size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::string spoilt = whole;
    spoilt[bit / 8] = static_cast<char>(spoilt[bit / 8] ^ 1 << bit % 8);
    expectBytesRefused(spoilt, "bit " + std::to_string(bit));
  }
}

TEST(StateFile, EveryCutAndEveryMoreIsRefused) {
  const TemporaryFolder folder;
  writeStateFile(folder.file("state"), someSections(60, 'b'));
  const std::string whole = textOf(folder.file("state"));
  for (size_t size = 0; size < whole.size(); ++size) expectRefused(folder, whole.substr(0, size), "a shorter one");
  expectRefused(folder, whole + '\0', "a longer one");
  EXPECT_THROW(readStateFile(folder.path()), Error);
  EXPECT_THROW(readStateFile(folder.file("none")), Error);
}

TEST(StateFile, WhateverBytesThereAreMemoryStaysBounded) {
  const std::string whole = stateBytes(someSections(3000, 'c'));
  std::mt19937 random(7);
  for (int round = 0; round < 1000; ++round) {
    std::string spoilt = whole;
    for (size_t k = 1 + random() % 30; k > 0; --k) spoilt[random() % 250] = static_cast<char>(random());
    if (spoilt != whole) expectBytesRefused(spoilt, "round " + std::to_string(round));
  }
}

TEST(StateFile, CannotBeWrittenWhereThereIsNoFolder) {
  const TemporaryFolder folder;
  EXPECT_THROW(writeStateFile(folder.file("none/state"), someSections(10, 'd')), Error);
}

/// Writes one file after the other until it is killed.
[[noreturn]] void writeForEver(const std::string& path, size_t bytes) {
  for (char content = 'a';; content = content == 'z' ? 'a' : static_cast<char>(content + 1))
    writeStateFile(path, someSections(bytes, content));
}

TEST(StateFile, AKilledWriterLeavesAWholeFile) {
  constexpr size_t kBytes = 4000000;
  constexpr int kRounds = 25, kLongest_us = 2000;  // from the beginning of a file, which takes about as long to write
  const TemporaryFolder folder;
  const std::string path = folder.file("state");
  writeStateFile(path, someSections(kBytes, '-'));
  std::mt19937 random(11);
  int cut_short = 0;
  for (int round = 0; round < kRounds; ++round) {
    for (const std::string& draft : draftsIn(folder.path())) std::filesystem::remove(draft);  // of the previous writer
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) writeForEver(path, kBytes);
    while (draftsIn(folder.path()).empty()) ASSERT_EQ(waitpid(child, nullptr, WNOHANG), 0);
    usleep(random() % kLongest_us);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    cut_short += !draftsIn(folder.path()).empty();
    const auto read = readStateFile(path);
    ASSERT_EQ(read.size(), 3U);
    EXPECT_EQ(read[1].bytes, std::vector<char>(kBytes, read[0].bytes[0]));
  }
  EXPECT_GT(cut_short, 0) << "no writer was killed while it wrote";
}

/// A section with fewer or more data than requested belongs to another state.
TEST(Archive, RefusesWhatDoesNotFit) {
  Archive out;
  out.section("a");
  std::vector<float> three = {1, 2, 3};
  out.values(three);
  out.section("b");
  int number = 5;
  out.value(number);
  {
    Archive in(out.sections());
    in.section("a");
    std::vector<float> two(2);
    EXPECT_THROW(in.values(two), Error);
  }
  {
    Archive in(out.sections());
    in.section("a");
    EXPECT_THROW(in.section("b"), Error);  // not read to its end
  }
  {
    Archive in(out.sections());
    EXPECT_THROW(in.section("b"), Error);
  }
  Archive in(out.sections());
  in.section("a");
  std::vector<float> any;
  in.list(any);
  EXPECT_EQ(any, three);
  in.section("b");
  int read = 0;
  in.value(read);
  in.end();
  EXPECT_EQ(read, 5);
  EXPECT_THROW(in.value(read), Error);
}

}  // namespace
}  // namespace viscera
