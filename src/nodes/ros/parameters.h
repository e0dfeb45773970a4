// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <set>
#include <string>
#include <vector>

#include "viscera/math/error.h"

namespace viscera::nodes {

/// Error for a ROS parameter that is unknown, of the wrong type or out of range. Names the parameter and the accepted
/// values.
struct ParameterError : Error {
  using Error::Error;
};

/// A node's private parameters. roscpp silently returns the default for a wrong type and casts numbers unchecked. Here
/// every such value is an error: each reader throws ParameterError.
class Parameters {
 public:
  /// @param values  struct of all private parameters, or an invalid value if there are none
  explicit Parameters(const XmlRpc::XmlRpcValue& values);
  /// Reads the parameters of this node from the parameter server.
  static Parameters ofThisNode();

  std::string text(const std::string& key, const std::string& fallback);
  /// Reads a string or an integer, which roscpp makes of an argument with digits alone.
  std::string identifier(const std::string& key, const std::string& fallback);
  double number(const std::string& key, double fallback, double min, double max);
  bool flag(const std::string& key, bool fallback);
  /// Reads a list of strings, or one string with ';' between the items. Empty items are left out.
  std::vector<std::string> texts(const std::string& key);
  /// Reads a list of numbers of the length of `fallback`, or one string with spaces between them.
  std::vector<double> numbers(const std::string& key, const std::vector<double>& fallback, double min, double max);
  bool has(const std::string& key) const;

  /// Throws ParameterError if there is a parameter that no reader has read, such as a misspelt one. Call it after all
  /// readers.
  void refuseOthers() const;

 private:
  const XmlRpc::XmlRpcValue* find(const std::string& key);
  XmlRpc::XmlRpcValue values_;
  std::set<std::string> known_;
};

}  // namespace viscera::nodes
