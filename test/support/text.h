// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace viscera::test {

/// Returns whether a message contains all of the parts; the failure names the missing one.
inline ::testing::AssertionResult says(const std::string& message, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) {
    if (message.find(part) != std::string::npos) continue;
    return ::testing::AssertionFailure() << "message: " << message << "\n  lacks: " << part;
  }
  return ::testing::AssertionSuccess();
}

/// Returns the message of the E that `act` throws; "nothing was thrown" if it throws nothing. Other exceptions pass
/// through.
template <class E, class Act>
std::string messageOf(Act act) {
  try {
    act();
  } catch (const E& e) {
    return e.what();
  }
  return "nothing was thrown";
}

}  // namespace viscera::test
