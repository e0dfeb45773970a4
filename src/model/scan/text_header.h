// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "model/scan/byte_stream.h"

namespace viscera {

/// Returns the next line of a text header, without its end. @param left  bytes that the header may still have
/// @throws SceneError  the header is longer than 4 MiB, or the file ends
std::string headerLine(ByteStream& stream, uint64_t& left);
constexpr uint64_t kMostHeaderBytes = 4 << 20;

std::string trimmed(const std::string& text);
std::vector<std::string> words(const std::string& text);
std::string lower(std::string text);

/// Fields of a text header, with checks of their values. Names are in lower case.
struct TextHeader {
  std::string path;
  std::map<std::string, std::string> fields;

  bool has(const std::string& name) const { return fields.count(name) != 0; }
  /// Returns the value of a field. @throws SceneError  it is missing
  const std::string& text(const std::string& name) const;
  std::string textOr(const std::string& name, const std::string& otherwise) const;
  /// Returns exactly `count` numbers, finite or not. @throws SceneError  another number of values, or no numbers
  std::vector<double> numbers(const std::string& name, size_t count) const;
  std::vector<int64_t> integers(const std::string& name, size_t count) const;
  [[noreturn]] void refuse(const std::string& name, const std::string& accepted) const;
};

/// Parses a text that is a number as a whole; otherwise returns false.
bool parseNumber(const std::string& text, double& value);
bool parseInteger(const std::string& text, int64_t& value);

}  // namespace viscera
