// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace viscera {

/// Source of the data that the viewer shows.
enum class ViewerData {
  kFile,  ///< blocks and index within the page
  kLive,  ///< a web socket of the server that sent the page
};

/// Returns the page up to the place of the data.
std::string viewerHead(ViewerData data);
/// Returns the index of the data, the scripts and the end of the page. @param index  as in page_writer.h
std::string viewerTail(ViewerData data, const nlohmann::ordered_json& index);

}  // namespace viscera
