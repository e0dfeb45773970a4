// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace viscera {

// Every program here writes files by these functions: next to their final path under a name of their own, then renamed.
// A file exists whole or not at all, and a file that a user may still need is never replaced.

/// Content of a file, as its first bytes show.
enum class FileKind {
  kState,
  kRecording,
  kPng,
  kNpy,
  kPly,
  kGlb,
  kVtk,
  kXdmf,
  kPc2,
  kFilm,
  kHtml,
  kJson,
  kScene,
  kStrokes,
  kRegistration,
  kText,   ///< any other text, tables included
  kBytes,  ///< anything else
};

/// Notes that this process reads the file. No writer replaces it after that. A path without a file is no error.
void recordRead(const std::string& path);
/// Returns whether recordRead() was called for this very file, whatever its name.
bool isRead(const std::string& path);

/// Checks that the file may be made or replaced, before anything is computed for it. States and registrations may
/// replace the one that was read, so that a user can resume a state and save under its name.
/// @param updates  any file that was read may be replaced, by its own new version
/// @throws Error  it is a folder, a file that this process reads, one of another kind, or is write-protected
void requireReplaceable(const std::string& path, FileKind kind, bool updates = false);

/// Function that is called before a file is written, on the writer's thread, for one file at a time.
using WriteListener = std::function<void(const std::string& path, FileKind kind)>;
/// Sets the listener for all files from now on. @param listener  null: none
void setWriteListener(WriteListener listener);

/// File that appears, or replaces an older one of its kind, with keep(). Until then, and after any error, its path is
/// as it was. Devices and pipes are written directly.
class OutFile {
 public:
  /// Makes the draft. @throws Error  of requireReplaceable(), or no file can be made there
  OutFile(const std::string& path, FileKind kind, bool updates = false);
  ~OutFile();  ///< removes the draft unless it was kept
  OutFile(const OutFile&) = delete;
  OutFile& operator=(const OutFile&) = delete;

  /// Appends data. @throws Error  names the file and what the system said
  void write(const void* data, size_t bytes);
  void write(std::string_view text) { write(text.data(), text.size()); }
  /// Replaces bytes that were written. @param offset  of the first [bytes]   @throws Error
  void writeAt(uint64_t offset, const void* data, size_t bytes);
  /// Returns the file that has the data until keep(), for another process that writes it.
  const std::string& target() const { return draft_.empty() ? path_ : draft_; }
  /// Moves the file into its place. @param durable  waits until a power failure cannot take it   @throws Error
  void keep(bool durable = false);

 private:
  [[noreturn]] void fail() const;  ///< with errno
  void writeDirectly(const char* data, size_t bytes) const;
  void flush();

  std::string path_, target_, draft_, buffer_;  ///< place: without links; draft: empty where written directly
  int fd_ = -1;
};

/// Writes the whole file. @throws Error  as OutFile
void writeFile(const std::string& path, FileKind kind, std::string_view bytes);
/// Replaces a text file that this process read by its new version. @throws Error  as OutFile
void updateFile(const std::string& path, std::string_view text);

}  // namespace viscera
