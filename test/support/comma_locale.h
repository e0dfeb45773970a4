// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <clocale>
#include <cstdlib>
#include <locale>
#include <string>

#include "support/temporary_folder.h"

namespace viscera::test {

/// Makes the program write and read numbers in the German format, 1.234,5, in C++ streams and in C, while it lives.
class CommaLocale {
 public:
  CommaLocale() : before_(std::locale::global(std::locale(std::locale::classic(), new Punctuation))) {
    const std::string made = folder().file("de_DE.UTF-8");
    const std::string make = "localedef -i de_DE -f UTF-8 '" + made + "' >/dev/null 2>&1";
    static const bool is_made = std::system(make.c_str()) == 0;
    if (!is_made) return;
    setenv("LOCPATH", folder().path().c_str(), 1);
    has_c_ = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
  }
  ~CommaLocale() {
    std::locale::global(before_);
    std::setlocale(LC_ALL, "C");
    unsetenv("LOCPATH");
  }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;

  /// Returns whether C has the locale too: the sources of de_DE, from the Debian package locales, are installed.
  bool hasC() const { return has_c_; }

 private:
  struct Punctuation : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  static const TemporaryFolder& folder() {
    static const TemporaryFolder of_process;
    return of_process;
  }

  std::locale before_;
  bool has_c_ = false;
};

}  // namespace viscera::test
