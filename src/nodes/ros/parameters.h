// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <set>
#include <string>
#include <vector>

#include "viscera/math/error.h"

namespace viscera::nodes {

/// A ROS parameter is unknown, has the wrong type or is out of range. Names the parameter and what would do.
struct ParameterError : Error {
  using Error::Error;
};

/// A node's private parameters. roscpp gives the default in silence for a wrong type, and casts numbers unchecked: here
/// every such value is an error. Each reader throws ParameterError.
class Parameters {
 public:
  /// @param values  struct of all private parameters, or an invalid value where there is none
  explicit Parameters(const XmlRpc::XmlRpcValue& values);
  /// Those of this node, from the parameter server.
  static Parameters ofThisNode();

  std::string text(const std::string& key, const std::string& fallback);
  double number(const std::string& key, double fallback, double min, double max);
  bool flag(const std::string& key, bool fallback);
  /// A list of strings, or one string with ';' between the items. Empty items are left out.
  std::vector<std::string> texts(const std::string& key);
  /// A list of so many numbers, or one string with blanks between them.
  std::vector<double> numbers(const std::string& key, const std::vector<double>& fallback, double min, double max);
  bool has(const std::string& key) const;

  /// Call after all readers: a parameter that none of them asked for is a slip of the pen.
  void refuseOthers() const;

 private:
  const XmlRpc::XmlRpcValue* find(const std::string& key);
  XmlRpc::XmlRpcValue values_;
  std::set<std::string> known_;
};

}  // namespace viscera::nodes
