// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scene/yaml/yaml_fault.h"

#include <vector>

#include "math/number_text.h"

namespace viscera {
namespace {

/// Beginning of a line of a file.
struct Begin {
  size_t indent;  ///< number of characters
  bool is_item;   ///< it begins with "- "
  bool is_used;   ///< neither empty nor a comment
};

Begin beginOf(const std::string& line) {
  const size_t indent = line.find_first_not_of(" \t");
  if (indent == std::string::npos || line[indent] == '#' || line[indent] == '\r') return {0, false, false};
  return {indent, line.compare(indent, 2, "- ") == 0 || line.substr(indent) == "-", true};
}

/// Open block: keys at one indent, or items of a list.
struct Block {
  size_t indent;
  bool of_items;
};

/// Closes the blocks that a line ends, and opens those that it begins.
void take(const Begin& begin, const std::string& line, std::vector<Block>& open) {
  while (!open.empty() && open.back().indent > begin.indent) open.pop_back();
  if (open.empty() || open.back().indent < begin.indent || open.back().of_items != begin.is_item)
    open.push_back({begin.indent, begin.is_item});
  if (!begin.is_item) return;
  const size_t content = line.find_first_not_of(' ', begin.indent + 1);
  if (content != std::string::npos) open.push_back({content, false});
}

bool opensBlock(const std::string& line) {
  const size_t last = line.find_last_not_of(" \t\r");
  return last != std::string::npos &&
         (line[last] == ':' || line[last] == '-' || line[last] == '|' || line[last] == '>');
}

/// Returns the indents that the line could have; empty: its indent is right.
std::string indentsFor(const Begin& begin, const std::vector<Block>& open, bool opened) {
  std::string accepted;
  for (const Block& block : open) {
    if (block.of_items != begin.is_item) continue;
    if (block.indent == begin.indent) return "";
    accepted += (accepted.empty() ? "" : ", ") + std::to_string(block.indent);
  }
  const bool may_open = opened && !open.empty() && begin.indent > open.back().indent;
  return may_open ? "" : accepted;
}

/// Returns what is wrong with the indent of the line; empty: nothing. @param number  of the line, from 0
std::string indentFault(const std::string& text, int number) {
  TextIn lines(text);
  std::vector<Block> open;
  bool opened = true;
  std::string line;
  for (int at = 0; std::getline(lines, line); ++at) {
    const Begin begin = beginOf(line);
    if (at == number) {
      if (line.substr(0, begin.indent).find('\t') != std::string::npos || (!line.empty() && line[0] == '\t'))
        return "the line is indented by a tab; YAML accepts only spaces";
      const std::string accepted = begin.is_used ? indentsFor(begin, open, opened) : "";
      if (accepted.empty()) return "";
      return "wrong indentation: the line is indented by " + std::to_string(begin.indent) +
             (begin.is_item ? ", items" : ", keys") + " above by " + accepted;
    }
    if (!begin.is_used) continue;
    take(begin, line, open);
    opened = opensBlock(line);
  }
  return "";
}

}  // namespace

std::string yamlFault(const std::string& file, const YAML::Exception& error, const std::string& text) {
  const std::string location = error.mark.is_null() ? file : file + ":" + std::to_string(error.mark.line + 1);
  if (error.msg == YAML::ErrorMsg::BAD_FILE) return location + ": lists and maps are nested too deep";
  const std::string indent = error.mark.is_null() ? "" : indentFault(text, error.mark.line);
  return location + ": " + (indent.empty() ? error.msg : indent);
}

}  // namespace viscera
