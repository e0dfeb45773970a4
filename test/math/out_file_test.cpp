// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "math/out_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "math/file_kind.h"
#include "support/temporary_folder.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

namespace fs = std::filesystem;
using namespace test;

void put(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::string faultOf(const std::function<void()>& act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

size_t filesIn(const std::string& folder) {
  return static_cast<size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

/// No file of this process grows beyond it: what a full disk does to writers.
class SizeLimit {
 public:
  explicit SizeLimit(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    rlimit now = before_;
    now.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &now);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  ~SizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST(OutFile, AppearsWholeOrNotAtAll) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/a.txt";
  put(path, "old");
  {
    OutFile file(path, FileKind::kText);
    file.write("new");
    EXPECT_EQ(readFile(path), "old");
  }
  EXPECT_EQ(readFile(path), "old");
  writeFile(path, FileKind::kText, "new");
  EXPECT_EQ(readFile(path), "new");
  EXPECT_EQ(filesIn(folder.path()), 1u) << "a draft was left";
}

TEST(OutFile, FullDiskLeavesTheOldFileAndNoOther) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/a.txt", fresh = folder.path() + "/b.txt";
  put(path, "old");
  const std::string large(100'000, 'x');
  {
    const SizeLimit limit(1000);
    for (const std::string& each : {path, fresh}) {
      const std::string fault = faultOf([&] { writeFile(each, FileKind::kText, large); });
      EXPECT_EQ(fault, each + ": cannot be written: File too large");
    }
  }
  EXPECT_EQ(readFile(path), "old");
  EXPECT_EQ(filesIn(folder.path()), 1u);
  EXPECT_EQ(faultOf([&] { writeFile("/dev/full", FileKind::kText, large); }),
            "/dev/full: cannot be written: No space left on device");
}

TEST(OutFile, NeverReplacesAFileOfAnotherKind) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/a";
  const std::pair<FileKind, std::string> all[] = {
      {FileKind::kState, std::string("viscera's state\0\1\0\0\0", 20)},
      {FileKind::kRecording, std::string("viscera session\0\1\0\0\0", 20)},
      {FileKind::kPng, "\x89PNG\r\n\x1a\n"},
      {FileKind::kNpy, "\x93NUMPY\1"},
      {FileKind::kPly, "ply\nformat ascii 1.0\n"},
      {FileKind::kGlb, std::string("glTF\2\0\0\0", 8)},
      {FileKind::kVtk, "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\">"},
      {FileKind::kXdmf, "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">"},
      {FileKind::kPc2, std::string("POINTCACHE2\0", 12)},
      {FileKind::kFilm, std::string("\0\0\0\x20"
                                    "ftypisom",
                                    12)},
      {FileKind::kHtml, "<!doctype html>\n"},
      {FileKind::kJson, "{\"a\": 1}\n"},
      {FileKind::kScene, "# mine\nname: a\nbodies:\n  - name: b\n"},
      {FileKind::kStrokes, "tick_hz: 100\nstrokes:\n  - stylus: left\n"},
      {FileKind::kRegistration, "tip: {position_m: [0, 0, 0]}\n"},
      {FileKind::kText, "step,tick\n1,2\n"},
      {FileKind::kBytes, std::string("\1\2\0\3", 4)},
  };
  for (const auto& [there, bytes] : all) {
    for (const auto& [kind, others] : all) {
      put(path, bytes);
      EXPECT_EQ(kindOf(bytes), there) << nameOf(there);
      const std::string fault = faultOf([&, written = kind] { writeFile(path, written, "x"); });
      if (kind == there) {
        EXPECT_EQ(fault, "");
        continue;
      }
      EXPECT_EQ(readFile(path), bytes);
      EXPECT_EQ(fault, path + ": cannot be written: it already exists as " + nameOf(there) + ", and " + nameOf(kind) +
                           " does not replace it; choose another file, or remove it");
    }
  }
  put(path, "");
  EXPECT_EQ(faultOf([&] { writeFile(path, FileKind::kPly, "ply\n"); }), "") << "an empty file holds nothing to lose";
}

TEST(OutFile, NeverReplacesAFileThatIsReadWhateverItsName) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/a.ply", link = folder.path() + "/link.ply";
  put(path, "ply\n");
  fs::create_symlink(path, link);
  EXPECT_FALSE(isRead(path));
  recordRead(link);
  recordRead(folder.path() + "/none");
  for (const std::string& each : {path, link}) {
    EXPECT_TRUE(isRead(each));
    EXPECT_EQ(faultOf([&] { writeFile(each, FileKind::kPly, "ply\nnew"); }),
              each + ": cannot be written: this command reads it and would destroy it; choose another file");
  }
  EXPECT_EQ(readFile(path), "ply\n");
  fs::remove(path);
  const std::string other = folder.path() + "/b.ply";  // which may have the removed one's inode
  put(other, "ply\n");
  EXPECT_EQ(faultOf([&] { writeFile(other, FileKind::kPly, "ply\nnew"); }), "");
}

TEST(OutFile, GoesOnWithTheStateThatItWasResumedFrom) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/state", bytes("viscera's state\0", 16);
  put(path, bytes);
  recordRead(path);
  EXPECT_EQ(faultOf([&] { writeFile(path, FileKind::kState, bytes); }), "");
}

TEST(OutFile, KeepsLinksModesAndProtection) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/a.txt", link = folder.path() + "/link.txt";
  put(path, "old");
  fs::create_symlink(path, link);
  chmod(path.c_str(), 0640);
  writeFile(link, FileKind::kText, "new");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(readFile(path), "new");
  struct stat status = {};
  stat(path.c_str(), &status);
  EXPECT_EQ(status.st_mode & 0777U, 0640u);
  if (geteuid() != 0) {
    chmod(path.c_str(), 0440);
    EXPECT_NE(faultOf([&] { writeFile(path, FileKind::kText, "newer"); }), "");
  }
  EXPECT_NE(faultOf([&] { writeFile(folder.path(), FileKind::kText, "x"); }).find("is a folder"), std::string::npos);
}

TEST(OutFile, ManyWritersOfOnePositionNeverShareADraft) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/" + std::string(250, 'n');  // as long a name as may be
  std::vector<std::thread> writers;
  for (char c : std::string("abcdefgh"))
    writers.emplace_back([&, c] {
      for (int i = 0; i < 20; ++i) writeFile(path, FileKind::kText, std::string(100'000, c));
    });
  for (std::thread& writer : writers) writer.join();
  const std::string text = readFile(path);
  EXPECT_EQ(text, std::string(100'000, text.at(0)));
  EXPECT_EQ(filesIn(folder.path()), 1u);
}

}  // namespace
}  // namespace viscera
