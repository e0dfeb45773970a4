// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tasks/attempt.h"

#include <cctype>

#include "math/one_line.h"

namespace viscera {

Attempt attemptAt(std::time_t now, const std::string& trainee) {
  return {trainee, utcText(now), VISCERA_VERSION, ""};
}

std::string utcText(std::time_t time) {
  std::tm utc{};
  gmtime_r(&time, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

bool isUtcText(const std::string& text) {
  constexpr const char* kForm = "0000-00-00T00:00:00Z";
  if (text.size() != std::string(kForm).size()) return false;
  for (size_t i = 0; i < text.size(); ++i) {
    const bool fits = kForm[i] == '0' ? std::isdigit(static_cast<unsigned char>(text[i])) != 0 : text[i] == kForm[i];
    if (!fits) return false;
  }
  return true;
}

std::string traineeFault(const std::string& name) {
  const auto fault = [&](const std::string& found) {
    return "a trainee's name must have 1 to " + std::to_string(kLongestTrainee) +
           " printable characters and begin with a letter or a digit; found " + found;
  };
  if (name.empty()) return fault("an empty text");
  const auto first = static_cast<unsigned char>(name[0]);
  if (first < 0x80 && std::isalnum(first) == 0) return fault("'" + oneLine(name) + "'");
  int characters = 0;
  for (std::string_view rest = name; !rest.empty(); ++characters) {
    const size_t bytes = printableBytes(rest);
    if (bytes == 0) return fault("'" + oneLine(name) + "'");
    rest.remove_prefix(bytes);
  }
  return characters <= kLongestTrainee ? "" : fault(std::to_string(characters));
}

}  // namespace viscera
