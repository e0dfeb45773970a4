// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

namespace viscera {

/// Child process that parses data which may crash it, and writes its results to us. It ends with this object.
class ChildProcess {
 public:
  /// @param arguments  the program's path or name first   @param bytes  limit of its address space
  /// @param silence_s  time without output after which it is killed   @param what  input that it reads, for errors
  /// @throws SceneError
  ChildProcess(const std::vector<std::string>& arguments, uint64_t bytes, int silence_s, std::string what);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Reads bytes of its output. @throws SceneError  with its message, if it ended early
  void read(void* to, size_t bytes);
  std::string line();
  /// Waits for its end; call it when all was read. @throws SceneError  it failed
  void finish();

 private:
  size_t more();  ///< reads into the buffer; 0: it has closed its output
  [[noreturn]] void fail();
  int ended();  ///< waits for it; returns its status

  std::string what_;
  int silence_ms_;
  uint64_t bytes_;
  pid_t pid_ = -1;
  int out_ = -1, errors_ = -1;
  std::vector<char> buffer_;
  size_t at_ = 0, held_ = 0;
};

}  // namespace viscera
