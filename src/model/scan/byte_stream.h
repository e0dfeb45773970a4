// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace viscera {

/// Bytes of a file in order, inflated where they are packed (gzip or zlib, told by their first bytes). Holds two
/// buffers of 64 KiB, whatever the file says.
class ByteStream {
 public:
  /// @param offset  of the first byte; of packed ones, in the file   @throws SceneError  no such file, or too short
  ByteStream(std::string path, uint64_t offset, bool packed);
  ~ByteStream();
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;

  const std::string& path() const { return path_; }
  /// To be asked before anything is allocated for them. @throws SceneError  it cannot hold so many bytes in all
  void requireHolds(uint64_t bytes) const;
  /// @throws SceneError  it ends early, or is corrupt
  void read(void* to, size_t bytes);
  void skip(uint64_t bytes);
  /// Packed bytes: to their end, where their checksum stands. @throws SceneError  that does not agree
  void finish();

 private:
  struct Inflater;
  size_t more(uint8_t* to, size_t bytes);  ///< 0: at the end
  size_t inflated(uint8_t* to, size_t bytes);
  bool nextMember();

  std::string path_;
  uint64_t held_ = 0;  ///< bytes of the file from the offset on
  uint64_t done_ = 0;  ///< bytes handed out
  std::unique_ptr<FILE, int (*)(FILE*)> file_;
  std::unique_ptr<Inflater> inflater_;
};

/// Whether a file begins as gzip does. @throws SceneError  it cannot be read
bool beginsAsGzip(const std::string& path);
/// [bytes] @throws SceneError  it is no plain file
uint64_t fileBytes(const std::string& path);
/// The file that a header names for its data: a plain name, or one after ./, in the header's own folder, wherever links
/// lead.
/// @param key  of the header, for errors   @throws SceneError
std::string dataFileBeside(const std::string& header, const std::string& told, const std::string& key);

}  // namespace viscera
