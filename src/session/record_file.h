// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <fstream>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace viscera {

// Recording on disk: the sixteen bytes of kRecordMagic, a version as 32 bits, then chunks in sequence. A chunk has its
// kind (32 bits), a CRC-32 of the rest of it, its length as stored and unpacked (64 bits each), and its bytes
// compressed by zlib. All numbers are little-endian. The file is only appended to: if the program ends abnormally, at
// most the last quarter of a second is lost.

constexpr uint32_t kRecordVersion = 1;  ///< version of the format and of the content of chunks

enum class ChunkKind : uint32_t {
  kScene = 1,  ///< a session begins: its scene
  kState,      ///< its complete state, and the hash of it
  kEvents,     ///< events of the session
  kEnd,        ///< the recording is complete: the hash of the final state
};

/// Largest unpacked size of a chunk [bytes], except for states, with a size that the scene determines. A file from
/// elsewhere may unpack to a thousand times its own size.
constexpr uint64_t kMostEventBytes = uint64_t{64} << 20, kMostSceneBytes = uint64_t{128} << 20;

/// Writer that compresses and writes on a thread of its own. A fault, such as a full disk, ends the recording, not the
/// caller.
class RecordFileWriter {
 public:
  /// @param most_bytes  of the file: fault() reports when a chunk had no room
  /// @throws Error  the file exists already, or cannot be created
  explicit RecordFileWriter(const std::string& path, uint64_t most_bytes = UINT64_MAX);
  ~RecordFileWriter();  ///< finish()
  RecordFileWriter(const RecordFileWriter&) = delete;
  RecordFileWriter& operator=(const RecordFileWriter&) = delete;

  /// Queues a chunk without waiting. Consecutive events are merged into one chunk, four times a second.
  void put(ChunkKind kind, std::vector<char> bytes);
  void finish();  ///< writes what is queued; put() must not be called after it
  uint64_t lastStateBytes() const { return state_bytes_; }  ///< as stored; 0: no state yet
  std::string fault() const;                                ///< reason why writing stopped; empty: it continues

 private:
  struct Waiting {
    ChunkKind kind;
    std::vector<char> bytes;
  };
  void main();
  void write(const Waiting& chunk);
  void writeAll(const void* data, size_t size) const;

  const std::string path_;
  const uint64_t most_bytes_;
  int fd_;
  uint64_t whole_bytes_ = 0;  ///< bytes of complete chunks in the file; written by the thread
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Waiting> waiting_;
  size_t waiting_bytes_ = 0;
  bool end_ = false;
  std::string fault_;
  std::atomic<uint64_t> state_bytes_{0};
  std::thread thread_;
};

class RecordFileReader {
 public:
  /// @throws Error  it cannot be read, is no recording, or is of another version
  explicit RecordFileReader(const std::string& path);

  /// Returns the next complete chunk; none at the end, or where the file is cut or damaged, see damage().
  std::optional<ChunkKind> next();
  /// Returns the bytes of the chunk. @param most  largest unpacked size   @throws Error  not zlib data, or larger
  std::vector<char> bytes(uint64_t most = kMostEventBytes) const;
  uint64_t position() const { return position_; }  ///< position of that chunk
  /// Moves to a position, so that next() returns the chunk there.
  void go(uint64_t position);
  const std::string& damage() const { return damage_; }  ///< reason why next() found none; empty: all was read
  const std::string& path() const { return path_; }

 private:
  const std::string path_;
  std::ifstream file_;
  uint64_t size_ = 0, position_ = 0, next_ = 0, raw_bytes_ = 0;
  std::vector<char> stored_;
  std::string damage_;
};

}  // namespace viscera
