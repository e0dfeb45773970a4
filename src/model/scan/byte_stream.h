// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace viscera {

/// Bytes of a file in order, inflated if they are compressed (gzip or zlib, recognised by their first bytes). Holds two
/// buffers of 64 KiB, whatever the file says.
class ByteStream {
 public:
  /// @param offset  of the first byte, for compressed data within the file   @throws SceneError  no such file, or too
  /// short
  ByteStream(std::string path, uint64_t offset, bool packed);
  ~ByteStream();
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;

  const std::string& path() const { return path_; }
  /// Checks the size before anything is allocated for it. @throws SceneError  the file cannot hold this many bytes in
  /// all
  void requireHolds(uint64_t bytes) const;
  /// Reads bytes. @throws SceneError  the file ends early, or is corrupt
  void read(void* to, size_t bytes);
  void skip(uint64_t bytes);
  /// Reads the compressed bytes to their end and verifies their checksum. @throws SceneError  the checksum does not
  /// match
  void finish();

 private:
  struct Inflater;
  size_t more(uint8_t* to, size_t bytes);  ///< 0: at the end
  size_t inflated(uint8_t* to, size_t bytes);
  bool nextMember();

  std::string path_;
  uint64_t held_ = 0;  ///< bytes of the file from the offset on
  uint64_t done_ = 0;  ///< bytes delivered
  std::unique_ptr<FILE, int (*)(FILE*)> file_;
  std::unique_ptr<Inflater> inflater_;
};

/// Returns whether a file begins like gzip. @throws SceneError  it cannot be read
bool beginsAsGzip(const std::string& path);
/// Returns the size of a file [bytes]. @throws SceneError  it is no regular file
uint64_t fileBytes(const std::string& path);
/// Returns the data file that a header names: a plain name, or one after ./, in the header's own folder, also through
/// links.
/// @param key  of the header, for errors   @throws SceneError  no such file there
std::string dataFileBeside(const std::string& header, const std::string& name_in_header, const std::string& key);

}  // namespace viscera
