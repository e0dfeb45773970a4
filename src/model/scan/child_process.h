// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

namespace viscera {

/// A program of ours that reads what may end it, and writes to us. It ends with this object.
class ChildProcess {
 public:
  /// @param arguments  the program's path or name first   @param bytes  of address space that it may have
  /// @param silence_s  after which it is ended   @param what  it reads, for errors   @throws SceneError
  ChildProcess(const std::vector<std::string>& arguments, uint64_t bytes, int silence_s, std::string what);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// @throws SceneError  with what it said, where it ended before
  void read(void* to, size_t bytes);
  std::string line();
  /// To be called when all was read. @throws SceneError  it did not end well
  void finish();

 private:
  size_t more();  ///< into the buffer; 0: it has closed its output
  [[noreturn]] void fail();
  int ended();  ///< waits for it; its status

  std::string what_;
  int silence_ms_;
  uint64_t bytes_;
  pid_t pid_ = -1;
  int out_ = -1, errors_ = -1;
  std::vector<char> buffer_;
  size_t at_ = 0, held_ = 0;
};

}  // namespace viscera
