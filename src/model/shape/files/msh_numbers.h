// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace viscera {

/// The words and numbers of a Gmsh file, one after the other: text, or bytes within sections that are binary.
class MshNumbers {
 public:
  /// @throws MeshError  the file cannot be read
  explicit MshNumbers(const std::string& path);

  /// Numbers are bytes from here on, where the text's line ends; else words again.
  void setBinary(bool binary);
  bool isAtEnd();
  std::string word();                  ///< of text
  std::string line();                  ///< of text: what is left of it
  void pass(const std::string& word);  ///< all up to behind it

  int64_t whole(size_t bytes);   ///< of 4 or 8 bytes, where binary
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
