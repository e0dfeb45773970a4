// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/ros/parameters.h"

#include <ros/param.h>

#include <algorithm>
#include <cmath>

#include "math/number_text.h"

namespace viscera::nodes {
namespace {

using XmlRpc::XmlRpcValue;

[[noreturn]] void refuse(const std::string& key, const std::string& accepted) {
  throw ParameterError("parameter ~" + key + ": must be " + accepted);
}

std::string stringOf(const XmlRpcValue& value, const std::string& key, const std::string& accepted) {
  if (value.getType() != XmlRpcValue::TypeString) refuse(key, accepted);
  return static_cast<const std::string&>(value);
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> items;
  TextIn in(text);
  for (std::string item; std::getline(in, item, ';');)
    if (item.find_first_not_of(" \t\n") != std::string::npos) items.push_back(item);
  return items;
}

}  // namespace

Parameters::Parameters(const XmlRpcValue& values) : values_(values) {}

Parameters Parameters::ofThisNode() {
  XmlRpcValue values;
  ros::param::get("~", values);
  return Parameters(values);
}

bool Parameters::has(const std::string& key) const {
  return values_.getType() == XmlRpcValue::TypeStruct && values_.hasMember(key);
}

const XmlRpcValue* Parameters::find(const std::string& key) {
  known_.insert(key);
  return has(key) ? &values_[key] : nullptr;
}

std::string Parameters::text(const std::string& key, const std::string& fallback) {
  const XmlRpcValue* value = find(key);
  return value ? stringOf(*value, key, "a string") : fallback;
}

std::string Parameters::identifier(const std::string& key, const std::string& fallback) {
  const XmlRpcValue* value = find(key);
  if (!value) return fallback;
  if (value->getType() == XmlRpcValue::TypeInt) return std::to_string(static_cast<const int&>(*value));
  return stringOf(*value, key, "a string or an integer; in a launch file, type=\"str\" keeps a string");
}

double Parameters::number(const std::string& key, double fallback, double min, double max) {
  const XmlRpcValue* value = find(key);
  if (!value) return fallback;
  TextOut accepted;
  accepted << "a number, " << min << ".." << max;
  double number = std::nan("");
  if (value->getType() == XmlRpcValue::TypeInt) number = static_cast<const int&>(*value);
  if (value->getType() == XmlRpcValue::TypeDouble) number = static_cast<const double&>(*value);
  if (!(number >= min && number <= max)) refuse(key, accepted.str());
  return number;
}

bool Parameters::flag(const std::string& key, bool fallback) {
  const XmlRpcValue* value = find(key);
  if (!value) return fallback;
  if (value->getType() != XmlRpcValue::TypeBoolean) refuse(key, "true or false");
  return static_cast<const bool&>(*value);
}

std::vector<std::string> Parameters::texts(const std::string& key) {
  static const std::string kAccepted = "a list of strings, or one string with ';' between the items";
  const XmlRpcValue* value = find(key);
  if (!value) return {};
  if (value->getType() != XmlRpcValue::TypeArray) return split(stringOf(*value, key, kAccepted));
  std::vector<std::string> items;
  for (int i = 0; i < value->size(); ++i) items.push_back(stringOf((*value)[i], key, kAccepted));
  return items;
}

std::vector<double> Parameters::numbers(const std::string& key, const std::vector<double>& fallback, double min,
                                        double max) {
  const XmlRpcValue* value = find(key);
  if (!value) return fallback;
  TextOut accepted;
  accepted << fallback.size() << " numbers, each " << min << ".." << max
           << ": a list, or one string separated by spaces";
  std::vector<double> out;
  if (value->getType() == XmlRpcValue::TypeString) {
    TextIn in(static_cast<const std::string&>(*value));
    for (double number; in >> number;) out.push_back(number);
    if (!in.eof()) refuse(key, accepted.str());
  } else if (value->getType() == XmlRpcValue::TypeArray) {
    for (int i = 0; i < value->size(); ++i) {
      const XmlRpcValue& item = (*value)[i];
      if (item.getType() == XmlRpcValue::TypeInt) out.push_back(static_cast<const int&>(item));
      if (item.getType() == XmlRpcValue::TypeDouble) out.push_back(static_cast<const double&>(item));
    }
  }
  const auto in_range = [&](double number) { return number >= min && number <= max; };
  if (out.size() != fallback.size() || !std::all_of(out.begin(), out.end(), in_range)) refuse(key, accepted.str());
  return out;
}

void Parameters::refuseOthers() const {
  if (values_.getType() != XmlRpcValue::TypeStruct) return;
  for (auto entry = values_.begin(); entry != values_.end(); ++entry) {
    if (known_.count(entry->first)) continue;
    std::string accepted;
    for (const std::string& key : known_) accepted += " ~" + key;
    throw ParameterError("parameter ~" + entry->first + ": unknown; accepted:" + accepted);
  }
}

}  // namespace viscera::nodes
