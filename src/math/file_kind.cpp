// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "math/file_kind.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace viscera {

namespace {

using Text = std::string_view;

struct Signature {
  Text bytes;
  FileKind kind;
};
constexpr Signature kSignatures[] = {
    {Text("viscera's state\0", 16), FileKind::kState},
    {Text("viscera session\0", 16), FileKind::kRecording},
    {"\x89PNG", FileKind::kPng},
    {"\x93NUMPY", FileKind::kNpy},
    {"ply\n", FileKind::kPly},
    {"ply\r", FileKind::kPly},
    {"glTF", FileKind::kGlb},
    {"POINTCACHE2", FileKind::kPc2},
};

/// Top-level keys that identify a scene file.
constexpr std::array<Text, 6> kSceneKeys = {"bodies", "solver", "environment", "styluses", "cameras", "obstacles"};
constexpr std::array<Text, 3> kRegistrationKeys = {"tip", "base", "residual_mm"};

bool begins(Text text, Text with) {
  return text.substr(0, with.size()) == with;
}

FileKind kindOfYaml(Text text) {
  while (!text.empty()) {
    const Text line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    const size_t colon = line.find(':');
    if (colon == Text::npos || line[0] == ' ' || line[0] == '#') continue;
    const auto isKey = [key = line.substr(0, colon)](Text known) { return key == known; };
    if (isKey("strokes")) return FileKind::kStrokes;
    if (std::any_of(kSceneKeys.begin(), kSceneKeys.end(), isKey)) return FileKind::kScene;
    if (std::any_of(kRegistrationKeys.begin(), kRegistrationKeys.end(), isKey)) return FileKind::kRegistration;
  }
  return FileKind::kText;
}

}  // namespace

FileKind kindOf(Text head) {
  for (const Signature& signature : kSignatures)
    if (begins(head, signature.bytes)) return signature.kind;
  if (begins(head.substr(std::min<size_t>(head.size(), 4)), "ftyp")) return FileKind::kFilm;  // after a length
  if (head.find('\0') != Text::npos && !begins(head, "<?xml")) return FileKind::kBytes;
  Text text = head;
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text[0]))) text.remove_prefix(1);
  if (begins(text, "<?xml")) {
    if (text.find("<VTKFile") != Text::npos) return FileKind::kVtk;
    if (text.find("<Xdmf") != Text::npos) return FileKind::kXdmf;
  }
  if (begins(text, "<!")) return FileKind::kHtml;
  if (begins(text, "{") || begins(text, "[")) return FileKind::kJson;
  return kindOfYaml(head);
}

const char* nameOf(FileKind kind) {
  switch (kind) {
    case FileKind::kState:
      return "a saved state";
    case FileKind::kRecording:
      return "a recording";
    case FileKind::kPng:
      return "a PNG picture";
    case FileKind::kNpy:
      return "an array of NumPy";
    case FileKind::kPly:
      return "a PLY mesh";
    case FileKind::kGlb:
      return "a glTF mesh";
    case FileKind::kVtk:
      return "a VTK file";
    case FileKind::kXdmf:
      return "an XDMF file";
    case FileKind::kPc2:
      return "a point cache";
    case FileKind::kFilm:
      return "a film";
    case FileKind::kHtml:
      return "an HTML page";
    case FileKind::kJson:
      return "JSON";
    case FileKind::kScene:
      return "a scene";
    case FileKind::kStrokes:
      return "strokes";
    case FileKind::kRegistration:
      return "a registration";
    case FileKind::kText:
      return "text";
    case FileKind::kBytes:
      break;
  }
  return "binary data";
}

}  // namespace viscera
