// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "export/page/viewer_text.h"

#include "export/page/embedded_viewer.h"

namespace viscera {

namespace {

using Json = nlohmann::ordered_json;

std::string viewerText(const std::string& name) {
  for (int i = 0; i < kEmbeddedViewerFileCount; ++i)
    if (name == kEmbeddedViewerFiles[i].name) return kEmbeddedViewerFiles[i].text;
  return "";
}

void replace(std::string& text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  if (at != std::string::npos) text.replace(at, from.size(), to);
}

/// Returns JSON for a script element of HTML, which "</" would end.
std::string scriptText(const Json& json) {
  std::string out;
  for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    if (c == '<')
      out += "\\u003c";
    else
      out += c;
  }
  return out;
}

}  // namespace

std::string viewerHead(ViewerData data) {
  std::string head = viewerText("page.html");
  replace(head, "/* page.css */", viewerText("page.css"));
  if (data == ViewerData::kLive) {
    replace(head, "img-src data:", "img-src data:; connect-src 'self'");
    replace(head, "<html lang=\"en\">", "<html lang=\"en\" class=\"live\">");
  }
  return head;
}

std::string viewerTail(ViewerData data, const Json& index) {
  const std::string other = data == ViewerData::kLive ? "player.js" : "live.js";
  std::string out = "<script type=\"application/json\" id=\"index\">" + scriptText(index) + "</script>\n";
  for (int i = 0; i < kEmbeddedViewerFileCount; ++i) {
    const std::string name = kEmbeddedViewerFiles[i].name;
    if (name.size() > 3 && name.substr(name.size() - 3) == ".js" && name != other)
      out += "<script>\n" + viewerText(name) + "</script>\n";
  }
  return out + "</body>\n</html>\n";
}

}  // namespace viscera
