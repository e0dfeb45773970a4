// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "viscera/math/types.h"

namespace viscera::nodes {

// Messages of page_server to a browser (src/export/page/viewer/live.js). A message of bytes has the length of its
// header as a uint32, little-endian, the header as JSON, and data. Kinds:
// * A base, {part, origin, step}: a surface without a base (SurfaceCoder), and its grid [m].
// * A shape, {part, vertices, indices, solid}: as in PageWriter.
// * A frame, {frame, base, needs, tick, tubes, newton_m}: data of a frame as in PageWriter. Shapes are numbers of
//   parts, and styles of tubes are places in `tubes`: {part, radius [m], color}. `needs` are the parts that it shows;
//   browser and server forget all others. newton_m is the length of a force arrow [m/N].
// Messages of text are JSON: {state: ...} (PageServer::stateText()) or {answer: text for the user}.
// A browser answers with text: {shown: number of a frame} once it is drawn, or {call: service, task: name}.

/// A part that several frames show: a base or a shape.
struct LivePart {
  uint32_t number = 0;
  std::string bytes;  ///< the whole message
};

/// A moment, as a message.
struct LiveFrame {
  uint32_t number = 0;
  std::vector<std::shared_ptr<const LivePart>> parts;  ///< parts that it shows
  std::string bytes;                                   ///< the whole message
};

inline nlohmann::ordered_json jsonOf(const Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

/// Returns a message of bytes.
inline std::string liveMessage(const nlohmann::ordered_json& header, const std::string& data) {
  const std::string text = header.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  std::string out;
  out.reserve(sizeof(uint32_t) + text.size() + data.size());
  for (unsigned shift = 0; shift < 32; shift += 8)
    out += static_cast<char>(static_cast<uint32_t>(text.size()) >> shift & 255);
  return out.append(text).append(data);
}

}  // namespace viscera::nodes
