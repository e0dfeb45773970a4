// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/table.h"

#include <algorithm>
#include <cstdio>
#include <iomanip>
#include <ostream>
#include <stdexcept>

namespace viscera::bench {

namespace {

constexpr int kCsvDigits = 9;

std::string headOf(const Column& column) {
  return column.unit.empty() ? column.name : column.name + " [" + column.unit + "]";
}

std::string tableQuoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

}  // namespace

std::string Cell::text(int digits) const {
  if (!isNumber()) return std::get<std::string>(value_);
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.*g", digits, number());
  return buffer;
}

Table::Table(std::string title, std::vector<Column> columns) : title_(std::move(title)), columns_(std::move(columns)) {}

void Table::add(std::vector<Cell> row) {
  if (row.size() != columns_.size()) {
    throw std::invalid_argument("table '" + title_ + "': a row of " + std::to_string(row.size()) + " cells, " +
                                std::to_string(columns_.size()) + " columns");
  }
  rows_.push_back(std::move(row));
}

void Table::print(std::ostream& out) const {
  out << title_ << '\n';
  std::vector<size_t> widths;
  for (size_t c = 0; c < columns_.size(); ++c) {
    size_t width = headOf(columns_[c]).size();
    for (const auto& row : rows_) width = std::max(width, row[c].text(columns_[c].digits).size());
    widths.push_back(width);
  }
  // Aligns numbers right and words left.
  const auto put = [&](size_t c, const std::string& text, bool right) {
    const std::string space(widths[c] - text.size(), ' ');
    const bool last = c + 1 == columns_.size();
    out << "  " << (right ? space + text : last ? text : text + space) << (last ? "\n" : "");
  };
  for (size_t c = 0; c < columns_.size(); ++c) put(c, headOf(columns_[c]), !rows_.empty() && rows_[0][c].isNumber());
  for (const auto& row : rows_) {
    for (size_t c = 0; c < columns_.size(); ++c) put(c, row[c].text(columns_[c].digits), row[c].isNumber());
  }
}

void Table::writeCsv(std::ostream& out) const {
  const char* separator = "";
  for (const Column& column : columns_) {
    out << separator << tableQuoted(headOf(column));
    separator = ",";
  }
  out << '\n';
  for (const auto& row : rows_) {
    separator = "";
    for (const Cell& cell : row) {
      out << separator << tableQuoted(cell.text(kCsvDigits));
      separator = ",";
    }
    out << '\n';
  }
}

}  // namespace viscera::bench
