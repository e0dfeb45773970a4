// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace viscera {

/// Words and numbers of a Gmsh file in sequence: text, or bytes within binary sections.
class MshNumbers {
 public:
  /// @throws MeshError  the file cannot be read
  explicit MshNumbers(const std::string& path);

  /// Switches to bytes, after the end of the text line, or back to words.
  void setBinary(bool binary);
  bool isAtEnd();
  std::string word();                  ///< next word of text
  std::string line();                  ///< rest of a line of text
  void pass(const std::string& word);  ///< skips everything up to the end of this word

  int64_t whole(size_t bytes);   ///< integer of 4 or 8 bytes if binary
  uint64_t count(size_t bytes);  ///< whole() that is not negative
  double number();

  [[noreturn]] void fail(const std::string& what) const;

 private:
  void skipBlanks();
  template <class Number>
  Number next();

  std::string text_;
  size_t at_ = 0, word_at_ = 0;
  bool binary_ = false;
};

}  // namespace viscera
