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

// A recording on the disk: the sixteen bytes of kRecordMagic, a version as 32 bits, then chunks one behind the other:
// what they are (32 bits), a CRC-32 of all the rest of them, length as stored and unpacked (64 bits each), and what
// zlib made of their bytes. All little-endian. It is only appended to: whatever ends the program, all but the last
// quarter of a second is there.

constexpr uint32_t kRecordVersion = 1;  ///< of the format and of what chunks hold

enum class ChunkKind : uint32_t {
  kScene = 1,  ///< a session begins: its scene
  kState,      ///< all of its state, and the hash of that
  kEvents,     ///< what happened to it
  kEnd,        ///< it was recorded to its end: the hash of its state
};

/// Bytes of a chunk, unpacked, but of states, of which the scene says how large they are: a file from elsewhere may ask
/// for a thousand times its own size.
constexpr uint64_t kMostEventBytes = uint64_t{64} << 20, kMostSceneBytes = uint64_t{128} << 20;

/// Packs and writes on a thread of its own. A fault, as a full disk, ends what is written, not who writes.
class RecordFileWriter {
 public:
  /// @param most_bytes  of the file: fault() says when a chunk found no room
  /// @throws Error  the file is there already, or cannot be made
  explicit RecordFileWriter(const std::string& path, uint64_t most_bytes = UINT64_MAX);
  ~RecordFileWriter();  ///< finish()
  RecordFileWriter(const RecordFileWriter&) = delete;
  RecordFileWriter& operator=(const RecordFileWriter&) = delete;

  /// Does not wait. Events that follow each other go into one chunk, four times a second.
  void put(ChunkKind kind, std::vector<char> bytes);
  void finish();                                            ///< writes what waits; nothing may be put after this
  uint64_t lastStateBytes() const { return state_bytes_; }  ///< as stored; 0: none was yet
  std::string fault() const;                                ///< why nothing is written any more; empty: it is

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
  uint64_t whole_bytes_ = 0;  ///< of chunks that are in the file; written by the thread
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
  /// @throws Error  it cannot be read, is no recording, or of another version
  explicit RecordFileReader(const std::string& path);

  /// The next whole chunk; none at the end, or where the file is cut or damaged, see damage().
  std::optional<ChunkKind> next();
  /// What it holds. @param most  bytes that it may unpack to   @throws Error  no bytes of zlib, or more of them
  std::vector<char> bytes(uint64_t most = kMostEventBytes) const;
  uint64_t place() const { return place_; }  ///< of that chunk
  /// next() is the chunk at this place.
  void go(uint64_t place);
  const std::string& damage() const { return damage_; }  ///< why next() found none; empty: all was read
  const std::string& path() const { return path_; }

 private:
  const std::string path_;
  std::ifstream file_;
  uint64_t size_ = 0, place_ = 0, next_ = 0, raw_bytes_ = 0;
  std::vector<char> stored_;
  std::string damage_;
};

}  // namespace viscera
