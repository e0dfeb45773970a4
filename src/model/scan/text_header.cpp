// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scan/text_header.h"

#include <algorithm>
#include <cctype>
#include <charconv>

#include "math/number_text.h"
#include "viscera/math/error.h"

namespace viscera {

std::string headerLine(ByteStream& stream, uint64_t& left) {
  std::string line;
  for (char c = 0;; line += c) {
    if (left-- == 0) throw SceneError(stream.path() + ": its header is too long; accepted: at most 4 MiB");
    stream.read(&c, 1);
    if (c == '\n') break;
  }
  if (!line.empty() && line.back() == '\r') line.pop_back();
  return line;
}

std::string trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(" \t\r\n");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

std::vector<std::string> words(const std::string& text) {
  TextIn stream(text);
  std::vector<std::string> all;
  for (std::string word; stream >> word;) all.push_back(word);
  return all;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

bool parseNumber(const std::string& text, double& value) {
  const char* begin = text.data() + (text.size() > 1 && text[0] == '+' ? 1 : 0);
  const auto result = std::from_chars(begin, text.data() + text.size(), value);
  return result.ec == std::errc() && result.ptr == text.data() + text.size();
}

bool parseInteger(const std::string& text, int64_t& value) {
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  return result.ec == std::errc() && result.ptr == text.data() + text.size();
}

const std::string& TextHeader::text(const std::string& name) const {
  const auto found = fields.find(name);
  if (found == fields.end()) throw SceneError(path + ": its header has no '" + name + "'");
  return found->second;
}

std::string TextHeader::textOr(const std::string& name, const std::string& otherwise) const {
  return has(name) ? text(name) : otherwise;
}

void TextHeader::refuse(const std::string& name, const std::string& accepted) const {
  throw SceneError(path + ": '" + name + ": " + text(name).substr(0, 200) + "'; accepted: " + accepted);
}

std::vector<double> TextHeader::numbers(const std::string& name, size_t count) const {
  std::vector<double> all;
  for (const std::string& word : words(text(name))) {
    double value = 0;
    if (!parseNumber(word, value)) refuse(name, std::to_string(count) + " numbers");
    all.push_back(value);
  }
  if (all.size() != count) refuse(name, std::to_string(count) + " numbers");
  return all;
}

std::vector<int64_t> TextHeader::integers(const std::string& name, size_t count) const {
  std::vector<int64_t> all;
  for (const std::string& word : words(text(name))) {
    int64_t value = 0;
    if (!parseInteger(word, value)) refuse(name, std::to_string(count) + " whole numbers");
    all.push_back(value);
  }
  if (all.size() != count) refuse(name, std::to_string(count) + " whole numbers");
  return all;
}

}  // namespace viscera
