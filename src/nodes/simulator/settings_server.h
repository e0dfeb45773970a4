// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/node_handle.h>

#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace viscera::nodes {

/// A number, or a word from a list, that can be changed while a node runs.
struct Setting {
  std::string name, meaning;
  double min = 0, max = 0, number = 0;
  std::vector<std::string> choices;  ///< accepted words; empty: the setting is a number
  std::string word;

  bool isNumber() const { return choices.empty(); }
};

/// The server side of dynamic_reconfigure, for rqt_reconfigure and dynparam: topics `parameter_descriptions` and
/// `parameter_updates` and the service `set_parameters` of a namespace. It differs from dynamic_reconfigure::Server in
/// three points. It is not generated from a file, so names, ranges and words are those of the scene. It leaves nothing
/// on the parameter server, since at the next start those values would belong to another scene. It refuses values out
/// of range instead of clamping them.
class SettingsServer {
 public:
  /// Applies changed settings. @throws Error  reason of the failure; then nothing has changed
  using Apply = std::function<void(const std::vector<Setting>& changed)>;

  /// @param node  handle of the namespace; its queue serves the requests, one after another
  SettingsServer(ros::NodeHandle node, std::vector<Setting> settings, Apply apply);

  /// Records that a word was changed elsewhere. Thread-safe.
  void recordWord(const std::string& name, const std::string& word);

 private:
  bool onSet(dynamic_reconfigure::Reconfigure::Request& request, dynamic_reconfigure::Reconfigure::Response& response);
  std::vector<Setting> changesOf(const dynamic_reconfigure::Config& request) const;
  const Setting& find(const std::string& name, bool number) const;
  void keep(const std::vector<Setting>& changed);

  const std::string namespace_;
  const Apply apply_;
  std::mutex mutex_;
  std::vector<Setting> settings_;
  ros::Publisher descriptions_, updates_;
  ros::ServiceServer server_;
};

}  // namespace viscera::nodes
