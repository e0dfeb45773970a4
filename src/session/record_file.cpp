// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "session/record_file.h"

#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

#include "math/out_file.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

constexpr char kRecordMagic[] = "viscera session";  // 16 bytes with the terminating 0
constexpr std::chrono::milliseconds kWritePeriod{250};
constexpr size_t kMostWaiting = size_t{1} << 30;  // bytes waiting for a disk that is full or too slow
constexpr uint64_t kMostPacked = 1040;            // largest expansion of a byte by deflate
constexpr uint64_t kFirstChunk = sizeof kRecordMagic + sizeof(uint32_t);

struct ChunkHead {
  uint32_t kind, crc;
  uint64_t stored, raw;
};

uint32_t chunkCrc(const ChunkHead& head, const char* stored) {
  uLong crc = crc32(0, nullptr, 0);
  crc = crc32_z(crc, reinterpret_cast<const Bytef*>(&head.kind), sizeof head.kind);
  crc = crc32_z(crc, reinterpret_cast<const Bytef*>(&head.stored), 2 * sizeof head.stored);
  return static_cast<uint32_t>(crc32_z(crc, reinterpret_cast<const Bytef*>(stored), head.stored));
}

}  // namespace

RecordFileWriter::RecordFileWriter(const std::string& path, uint64_t most_bytes)
    : path_(path),
      most_bytes_(most_bytes),
      fd_(open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0666)) {
  if (fd_ < 0 && errno == EEXIST)
    throw Error(path + ": already exists, and recordings are never overwritten; choose another file or remove it");
  if (fd_ < 0) throw Error(path + ": cannot be created for a recording: " + std::strerror(errno));
  try {
    writeAll(kRecordMagic, sizeof kRecordMagic);
    writeAll(&kRecordVersion, sizeof kRecordVersion);
  } catch (const Error&) {
    close(fd_);
    unlink(path_.c_str());
    throw;
  }
  thread_ = std::thread([this] { main(); });
}

RecordFileWriter::~RecordFileWriter() {
  finish();
  close(fd_);
}

void RecordFileWriter::finish() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    end_ = true;
  }
  changed_.notify_all();
  if (!thread_.joinable()) return;
  thread_.join();
  if (!fault_.empty() && whole_bytes_ == 0) unlink(path_.c_str());  // an empty file would block the name
}

void RecordFileWriter::put(ChunkKind kind, std::vector<char> bytes) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!fault_.empty()) return;
  waiting_bytes_ += bytes.size();
  if (waiting_bytes_ > kMostWaiting) {
    fault_ = path_ + ": the disk no longer accepts data";
    return;
  }
  constexpr size_t kMostTogether = kMostEventBytes / 4;
  if (kind == ChunkKind::kEvents && !waiting_.empty() && waiting_.back().kind == kind &&
      waiting_.back().bytes.size() < kMostTogether) {
    waiting_.back().bytes.insert(waiting_.back().bytes.end(), bytes.begin(), bytes.end());
  } else {
    waiting_.push_back({kind, std::move(bytes)});
  }
}

std::string RecordFileWriter::fault() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return fault_;
}

void RecordFileWriter::main() {
  std::unique_lock<std::mutex> lock(mutex_);
  for (bool end = false; !end;) {
    changed_.wait_for(lock, kWritePeriod, [this] { return end_; });
    end = end_;
    std::deque<Waiting> taken;
    taken.swap(waiting_);
    waiting_bytes_ = 0;
    if (!fault_.empty()) continue;
    lock.unlock();
    std::string fault;
    try {
      for (const Waiting& chunk : taken) write(chunk);
    } catch (const std::exception& error) {
      fault = error.what();
    }
    lock.lock();
    if (!fault.empty()) fault_ = fault;
  }
}

void RecordFileWriter::write(const Waiting& chunk) {
  std::vector<char> out(sizeof(ChunkHead) + compressBound(chunk.bytes.size()));
  uLongf stored = out.size() - sizeof(ChunkHead);
  char* const packed = out.data() + sizeof(ChunkHead);
  const int level = chunk.kind == ChunkKind::kState ? Z_BEST_SPEED : Z_DEFAULT_COMPRESSION;
  if (compress2(reinterpret_cast<Bytef*>(packed), &stored, reinterpret_cast<const Bytef*>(chunk.bytes.data()),
                chunk.bytes.size(), level) != Z_OK)
    throw Error(path_ + ": out of memory while compressing the recording");
  ChunkHead head{static_cast<uint32_t>(chunk.kind), 0, stored, chunk.bytes.size()};
  head.crc = chunkCrc(head, packed);
  std::memcpy(out.data(), &head, sizeof head);
  if (kFirstChunk + whole_bytes_ + sizeof head + stored > most_bytes_)
    throw Error(path_ + ": the recording ends here: it has reached its limit of " + std::to_string(most_bytes_) +
                " bytes");
  try {
    writeAll(out.data(), sizeof head + stored);
  } catch (const Error&) {
    if (ftruncate(fd_, static_cast<off_t>(kFirstChunk + whole_bytes_)) != 0) {  // a reader detects the remains
    }
    throw;
  }
  whole_bytes_ += sizeof head + stored;
  if (chunk.kind == ChunkKind::kState) state_bytes_ = stored;
}

void RecordFileWriter::writeAll(const void* data, size_t size) const {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t done = ::write(fd_, at, size);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) throw Error(path_ + ": cannot be written: " + std::strerror(errno));
    at += done;
    size -= static_cast<size_t>(done);
  }
}

RecordFileReader::RecordFileReader(const std::string& path) : path_(path), file_(path, std::ios::binary) {
  recordRead(path);
  if (!file_) throw Error(path + ": cannot be read (does the file exist?)");
  char magic[sizeof kRecordMagic] = {};
  uint32_t version = 0;
  file_.read(magic, sizeof magic);
  if (!file_ || std::memcmp(magic, kRecordMagic, sizeof magic) != 0) throw Error(path + ": is not a recorded session");
  if (!file_.read(reinterpret_cast<char*>(&version), sizeof version)) throw Error(path + ": contains nothing yet");
  if (version != kRecordVersion) {
    throw Error(path + ": is a recording of version " + std::to_string(version) + "; this program reads version " +
                std::to_string(kRecordVersion));
  }
  file_.seekg(0, std::ios::end);
  size_ = static_cast<uint64_t>(std::max<std::streamoff>(0, file_.tellg()));
  go(kFirstChunk);
}

void RecordFileReader::go(uint64_t position) {
  next_ = position;
  damage_.clear();
}

std::optional<ChunkKind> RecordFileReader::next() {
  ChunkHead head{};
  const auto ends = [this](const std::string& why) {
    damage_ = path_ + ": " + why + " after " + std::to_string(next_) + " bytes";
    return std::nullopt;
  };
  if (next_ >= size_) return std::nullopt;
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(next_));
  if (size_ - next_ < sizeof head || !file_.read(reinterpret_cast<char*>(&head), sizeof head))
    return ends("the recording is truncated");
  if (head.stored > size_ - next_ - sizeof head) return ends("the recording is truncated or damaged");
  stored_.resize(head.stored);
  if (!file_.read(stored_.data(), static_cast<std::streamsize>(head.stored))) return ends("the recording is truncated");
  const bool known =
      head.kind >= static_cast<uint32_t>(ChunkKind::kScene) && head.kind <= static_cast<uint32_t>(ChunkKind::kEnd);
  if (!known || chunkCrc(head, stored_.data()) != head.crc || head.raw / kMostPacked > head.stored)
    return ends("the recording is damaged");
  position_ = next_;
  next_ += sizeof head + head.stored;
  raw_bytes_ = head.raw;
  return static_cast<ChunkKind>(head.kind);
}

std::vector<char> RecordFileReader::bytes(uint64_t most) const {
  if (raw_bytes_ > most)
    throw Error(path_ + ": the chunk after " + std::to_string(position_) + " bytes unpacks to " +
                std::to_string(raw_bytes_) + " bytes; chunks of its kind have at most " + std::to_string(most));
  std::vector<char> out(raw_bytes_);
  uLongf size = out.size();
  char none = 0;  // zlib accepts no null pointer
  if (uncompress(reinterpret_cast<Bytef*>(out.empty() ? &none : out.data()), &size,
                 reinterpret_cast<const Bytef*>(stored_.data()), stored_.size()) != Z_OK ||
      size != out.size())
    throw Error(path_ + ": the recording is damaged after " + std::to_string(position_) + " bytes");
  return out;
}

}  // namespace viscera
