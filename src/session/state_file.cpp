// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "session/state_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "math/out_file.h"

namespace viscera {

namespace {

constexpr char kMagic[] = "viscera's state";  // 16 bytes with the terminating 0
constexpr uint32_t kMostSections = 1000;
constexpr uint32_t kLongestName = 100;
constexpr size_t kAtOnce = size_t{1} << 30;  // bytes; zlib and the kernel count in fewer than 64 bits

struct SectionHead {
  uint32_t name_length, crc;
  uint64_t bytes;
};

Error fault(const std::string& path, const std::string& what) {
  return Error(path + ": " + what + ": " + std::strerror(errno));
}
Error damaged(const std::string& path, const std::string& where) {
  return Error(path + ": the saved state is damaged or truncated: " + where);
}

/// File that closes itself.
class File {
 public:
  explicit File(const std::string& path) : path_(path), fd_(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (fd_ < 0) throw fault(path, "cannot be opened");
  }
  ~File() {
    if (fd_ >= 0) close(fd_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  /// Reads bytes. @return whether the file had this many bytes
  bool read(void* data, size_t size) {
    char* to = static_cast<char*>(data);
    while (size > 0) {
      const ssize_t done = ::read(fd_, to, std::min(size, kAtOnce));
      if (done < 0 && errno == EINTR) continue;
      if (done < 0) throw fault(path_, "cannot be read");
      if (done == 0) return false;
      to += done;
      size -= static_cast<size_t>(done);
    }
    return true;
  }
  uint64_t size() const {
    struct stat status = {};
    if (fstat(fd_, &status) != 0) throw fault(path_, "cannot be read");
    if (!S_ISREG(status.st_mode)) throw Error(path_ + ": is not a saved state");
    return static_cast<uint64_t>(status.st_size);
  }

 private:
  std::string path_;
  int fd_;
};

uint32_t crcOf(const SectionHead& head, const std::string& name, const std::vector<char>& bytes) {
  uLong crc = crc32(0, nullptr, 0);
  const auto add = [&crc](const void* data, size_t size) {
    const auto* at = static_cast<const Bytef*>(data);
    for (; size > 0; size -= std::min(size, kAtOnce), at += kAtOnce)
      crc = crc32(crc, at, static_cast<uInt>(std::min(size, kAtOnce)));
  };
  add(&head.name_length, sizeof head.name_length);
  add(&head.bytes, sizeof head.bytes);
  add(name.data(), name.size());
  add(bytes.data(), bytes.size());
  return static_cast<uint32_t>(crc);
}

/// Bytes in memory, with the interface of File.
class Memory {
 public:
  void write(const void* data, size_t size) { bytes_.append(static_cast<const char*>(data), size); }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

class MemoryReader {
 public:
  explicit MemoryReader(const std::string& bytes) : bytes_(bytes) {}
  bool read(void* data, size_t size) {
    if (size > bytes_.size() - at_) return false;
    std::copy_n(bytes_.data() + at_, size, static_cast<char*>(data));
    at_ += size;
    return true;
  }

 private:
  const std::string& bytes_;
  size_t at_ = 0;
};

template <class To>
void writeSections(To& file, const std::vector<Archive::Section>& sections) {
  const uint32_t numbers[2] = {kStateVersion, static_cast<uint32_t>(sections.size())};
  file.write(kMagic, sizeof kMagic);
  file.write(numbers, sizeof numbers);
  for (const Archive::Section& section : sections) {
    SectionHead head{static_cast<uint32_t>(section.name.size()), 0, section.bytes.size()};
    head.crc = crcOf(head, section.name, section.bytes);
    file.write(&head, sizeof head);
    file.write(section.name.data(), section.name.size());
    file.write(section.bytes.data(), section.bytes.size());
  }
}

/// Reads a section. @param left  bytes of the file from here on; decreases
template <class From>
Archive::Section readSection(From& file, const std::string& path, uint64_t& left, const std::string& where) {
  SectionHead head;
  if (left < sizeof head || !file.read(&head, sizeof head)) throw damaged(path, where + " is missing");
  left -= sizeof head;
  if (head.name_length > std::min<uint64_t>(left, kLongestName)) throw damaged(path, where + " has no name");
  Archive::Section section{std::string(head.name_length, ' '), {}};
  left -= head.name_length;
  if (head.bytes > left) throw damaged(path, where + " is longer than the file");
  left -= head.bytes;
  section.bytes.resize(head.bytes);
  const bool all = file.read(section.name.data(), section.name.size()) && file.read(section.bytes.data(), head.bytes);
  if (!all || crcOf(head, section.name, section.bytes) != head.crc)
    throw damaged(path, where + " has a wrong checksum");
  return section;
}

}  // namespace

void writeStateFile(const std::string& path, const std::vector<Archive::Section>& sections) {
  OutFile file(path, FileKind::kState);
  writeSections(file, sections);
  constexpr bool kDurable = true;
  file.keep(kDurable);
}

namespace {

/// Reads all sections. @param left  available bytes
template <class From>
std::vector<Archive::Section> readSections(From& file, const std::string& path, uint64_t left) {
  char magic[sizeof kMagic];
  uint32_t numbers[2];
  if (left < sizeof magic || !file.read(magic, sizeof magic) || std::memcmp(magic, kMagic, sizeof magic) != 0)
    throw Error(path + ": is not a saved state");
  left -= sizeof magic;
  if (left < sizeof numbers || !file.read(numbers, sizeof numbers)) throw damaged(path, "it ends after its first line");
  left -= sizeof numbers;
  if (numbers[0] != kStateVersion) {
    throw Error(path + ": is a saved state of version " + std::to_string(numbers[0]) + "; this program reads version " +
                std::to_string(kStateVersion));
  }
  if (numbers[1] > kMostSections) throw damaged(path, "it announces too many sections");
  std::vector<Archive::Section> out;
  for (uint32_t s = 0; s < numbers[1]; ++s)
    out.push_back(readSection(file, path, left, "section " + std::to_string(s + 1)));
  if (left > 0) throw damaged(path, "there are data after its last section");
  return out;
}

}  // namespace

std::vector<Archive::Section> readStateFile(const std::string& path) {
  File file(path);
  return readSections(file, path, file.size());
}

std::string stateBytes(const std::vector<Archive::Section>& sections) {
  Memory memory;
  writeSections(memory, sections);
  return memory.take();
}

std::vector<Archive::Section> readStateBytes(const std::string& bytes, const std::string& name) {
  MemoryReader reader(bytes);
  return readSections(reader, name, bytes.size());
}

}  // namespace viscera
