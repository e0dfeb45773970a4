// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>
#include <string>
#include <variant>
#include <vector>

namespace viscera::bench {

struct Column {
  std::string name;
  std::string unit = {};  ///< such as "Pa"; empty: none
  int digits = 4;         ///< number of significant digits when printed
};

/// A word or a number. An empty word means "not measured".
class Cell {
 public:
  Cell(std::string text) : value_(std::move(text)) {}
  Cell(const char* text) : value_(std::string(text)) {}
  Cell(double number) : value_(number) {}
  Cell(int number) : value_(static_cast<double>(number)) {}
  bool isNumber() const { return std::holds_alternative<double>(value_); }
  /// Returns the number. @throws std::bad_variant_access  it is a word
  double number() const { return std::get<double>(value_); }
  /// Returns the cell as text. @param digits  significant digits of a number
  std::string text(int digits) const;

 private:
  std::variant<std::string, double> value_;
};

/// Results in rows and columns, printed with alignment or written as CSV.
class Table {
 public:
  Table(std::string title, std::vector<Column> columns);
  /// Adds a row. @param row  one cell per column  @throws std::invalid_argument  more or fewer cells
  void add(std::vector<Cell> row);
  const std::string& title() const { return title_; }
  const std::vector<Column>& columns() const { return columns_; }
  const std::vector<std::vector<Cell>>& rows() const { return rows_; }

  void print(std::ostream& out) const;
  /// Writes a header line "name [unit]", then one line per row; numbers with 9 digits, words quoted if necessary (RFC
  /// 4180).
  void writeCsv(std::ostream& out) const;

 private:
  std::string title_;
  std::vector<Column> columns_;
  std::vector<std::vector<Cell>> rows_;
};

}  // namespace viscera::bench
