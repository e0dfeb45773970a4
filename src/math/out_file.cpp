// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "math/out_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>
#include <random>
#include <utility>

#include "math/file_kind.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

namespace fs = std::filesystem;

constexpr size_t kHead = size_t{64} << 10;   // bytes that identify a file's kind
constexpr size_t kBuffer = size_t{1} << 20;  // bytes
constexpr size_t kAtOnce = size_t{1} << 30;  // bytes; Linux writes fewer than 2^31 in one call
constexpr size_t kLongestName = 80;  // bytes of the names of file and host within a draft's name, which has 255 at most

using FileId = std::pair<dev_t, ino_t>;

/// Files that this process reads, and the listener for files that it writes.
struct Known {
  std::mutex mutex;
  std::map<FileId, std::string> read;  ///< by path; another file may have this path by now
  std::mutex listening;
  WriteListener listener;
};
Known& known() {
  static Known of_process;
  return of_process;
}

bool idOf(const std::string& path, FileId& id) {
  struct stat status = {};
  if (stat(path.c_str(), &status) != 0) return false;
  id = {status.st_dev, status.st_ino};
  return true;
}

std::string headOf(const std::string& path) {
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY);
  if (fd < 0) return "";
  std::string head(kHead, '\0');
  const ssize_t bytes = pread(fd, head.data(), head.size(), 0);
  close(fd);
  head.resize(static_cast<size_t>(std::max<ssize_t>(0, bytes)));
  return head;
}

/// Returns a unique name: processes of several hosts or containers may share a folder and have the same process number.
std::string draftOf(const std::string& target) {
  static thread_local std::random_device random;
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  const fs::path at(target);
  const std::string name = at.filename().string().substr(0, kLongestName) + "." +
                           std::string(host).substr(0, kLongestName) + "." + std::to_string(getpid()) + "." +
                           std::to_string(random()) + ".draft";
  return (at.parent_path() / name).string();
}

bool isPlain(const std::string& path, bool& exists) {
  struct stat status = {};
  exists = stat(path.c_str(), &status) == 0;
  return !exists || S_ISREG(status.st_mode);
}

void syncFolderOf(const std::string& target) {
  const std::string folder = fs::path(target).parent_path().string();
  const int fd = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;
  fsync(fd);
  close(fd);
}

}  // namespace

void recordRead(const std::string& path) {
  FileId id;
  if (!idOf(path, id)) return;
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  const std::lock_guard<std::mutex> lock(known().mutex);
  known().read[id] = error ? path : absolute.string();
}

bool isRead(const std::string& path) {
  FileId id, now;
  if (!idOf(path, id)) return false;
  const std::lock_guard<std::mutex> lock(known().mutex);
  const auto found = known().read.find(id);
  return found != known().read.end() && idOf(found->second, now) && now == id;
}

void requireReplaceable(const std::string& path, FileKind kind, bool updates) {
  std::error_code error;
  if (fs::is_directory(path, error)) throw Error(path + ": cannot be written: it is a folder");
  bool exists = false;
  if (!isPlain(path, exists) || !exists) return;
  const bool is_updated = updates || kind == FileKind::kState || kind == FileKind::kRegistration;
  if (!is_updated && isRead(path))
    throw Error(path + ": cannot be written: this command reads it and would destroy it; choose another file");
  if (access(path.c_str(), W_OK) != 0) throw Error(path + ": cannot be written: " + std::strerror(errno));
  const std::string head = headOf(path);
  if (head.empty() || kindOf(head) == kind) return;
  throw Error(path + ": cannot be written: it already exists as " + nameOf(kindOf(head)) + ", and " + nameOf(kind) +
              " does not replace it; choose another file, or remove it");
}

void setWriteListener(WriteListener listener) {
  const std::lock_guard<std::mutex> lock(known().listening);
  known().listener = std::move(listener);
}

OutFile::OutFile(const std::string& path, FileKind kind, bool updates) : path_(path) {
  requireReplaceable(path, kind, updates);
  {
    const std::lock_guard<std::mutex> lock(known().listening);
    if (known().listener) known().listener(path, kind);
  }
  std::error_code error;
  bool exists = false;
  if (!isPlain(path, exists)) {
    fd_ = open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (fd_ < 0) fail();
    return;
  }
  const fs::path resolved = exists ? fs::canonical(path, error) : fs::path(path);
  target_ = error ? path : resolved.string();
  constexpr int kTries = 100;
  for (int i = 0; i < kTries && fd_ < 0; ++i) {
    draft_ = draftOf(target_);
    fd_ = open(draft_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd_ < 0 && errno != EEXIST) break;
  }
  if (fd_ < 0) fail();
  struct stat status = {};
  if (exists && stat(target_.c_str(), &status) == 0) fchmod(fd_, status.st_mode & 0777U);
}

OutFile::~OutFile() {
  if (fd_ < 0) return;
  close(fd_);
  if (!draft_.empty()) unlink(draft_.c_str());
}

void OutFile::fail() const {
  throw Error(path_ + ": cannot be written: " + std::strerror(errno));
}

void OutFile::write(const void* data, size_t bytes) {
  if (buffer_.size() + bytes >= kBuffer) flush();
  if (bytes >= kBuffer) return writeDirectly(static_cast<const char*>(data), bytes);  // a state may have gigabytes
  buffer_.append(static_cast<const char*>(data), bytes);
}

void OutFile::writeDirectly(const char* data, size_t bytes) const {
  while (bytes > 0) {
    const ssize_t done = ::write(fd_, data, std::min(bytes, kAtOnce));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) fail();
    data += done;
    bytes -= static_cast<size_t>(done);
  }
}

void OutFile::flush() {
  writeDirectly(buffer_.data(), buffer_.size());
  buffer_.clear();
}

void OutFile::writeAt(uint64_t offset, const void* data, size_t bytes) {
  flush();
  const char* at = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t done = pwrite(fd_, at, bytes, static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) fail();
    at += done;
    offset += static_cast<uint64_t>(done);
    bytes -= static_cast<size_t>(done);
  }
}

void OutFile::keep(bool durable) {
  flush();
  if (durable && !draft_.empty() && fsync(fd_) != 0) fail();
  const int fd = std::exchange(fd_, -1);
  const bool closed = close(fd) == 0;
  if (draft_.empty()) return closed ? void() : fail();
  if (!closed || std::rename(draft_.c_str(), target_.c_str()) != 0) {
    const int why = errno;
    unlink(draft_.c_str());
    errno = why;
    fail();
  }
  if (durable) syncFolderOf(target_);
}

void writeFile(const std::string& path, FileKind kind, std::string_view bytes) {
  OutFile file(path, kind);
  file.write(bytes);
  file.keep();
}

void updateFile(const std::string& path, std::string_view text) {
  OutFile file(path, kindOf(headOf(path)), true);
  file.write(text);
  file.keep();
}

}  // namespace viscera
