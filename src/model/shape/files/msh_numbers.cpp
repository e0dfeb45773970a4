// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/files/msh_numbers.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>

#include "math/number_text.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

bool isBlank(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

}  // namespace

MshNumbers::MshNumbers(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  text_.assign(std::istreambuf_iterator<char>(file), {});
  if (!file) throw MeshError("cannot be read");
}

void MshNumbers::setBinary(bool binary) {
  if (binary && !binary_) line();
  binary_ = binary;
}

void MshNumbers::skipBlanks() {
  while (at_ < text_.size() && isBlank(text_[at_])) ++at_;
}

bool MshNumbers::isAtEnd() {
  skipBlanks();
  return at_ == text_.size();
}

std::string MshNumbers::word() {
  skipBlanks();
  const size_t end = static_cast<size_t>(
      std::find_if(text_.begin() + static_cast<std::ptrdiff_t>(at_), text_.end(), isBlank) - text_.begin());
  word_at_ = at_;
  if (end == at_) fail("the file ends within a section");
  std::string word = text_.substr(at_, end - at_);
  at_ = end;
  return word;
}

std::string MshNumbers::line() {
  word_at_ = at_;
  const size_t end = std::min(text_.find('\n', at_), text_.size());
  std::string line = text_.substr(at_, end - at_);
  at_ = std::min(end + 1, text_.size());
  return line;
}

void MshNumbers::pass(const std::string& word) {
  word_at_ = at_;
  at_ = text_.find("\n" + word, at_);
  if (at_ == std::string::npos) fail("the file ends before " + word);
  at_ += 1 + word.size();
}

template <class Number>
Number MshNumbers::next() {
  word_at_ = at_;
  Number value{};
  if (text_.size() - at_ < sizeof value) fail("the file ends within a section");
  std::memcpy(&value, text_.data() + at_, sizeof value);
  at_ += sizeof value;
  return value;
}

int64_t MshNumbers::whole(size_t bytes) {
  if (binary_) return bytes == 4 ? next<int32_t>() : next<int64_t>();
  const std::string text = word();
  int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) fail("'" + text + "' is not a whole number");
  return value;
}

uint64_t MshNumbers::count(size_t bytes) {
  const int64_t value = whole(bytes);
  if (value < 0) fail(std::to_string(value) + " is negative");
  return static_cast<uint64_t>(value);
}

double MshNumbers::number() {
  const std::string text = binary_ ? "" : word();
  const std::optional<double> value = binary_ ? next<double>() : readNumber(text);
  if (!value) fail("'" + text + "' is not a number");
  if (!std::isfinite(*value)) fail((binary_ ? numberText(*value) : "'" + text + "'") + " is not finite");
  return *value;
}

void MshNumbers::fail(const std::string& what) const {
  const auto lines = std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(word_at_), '\n');
  throw MeshError((binary_ ? "byte " + std::to_string(word_at_) : "line " + std::to_string(lines + 1)) + ": " + what);
}

}  // namespace viscera
