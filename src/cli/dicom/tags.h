// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gdcmDataSet.h>
#include <gdcmSequenceOfItems.h>
#include <gdcmTag.h>

#include <cstdlib>
#include <string>
#include <vector>

namespace viscera::dicom {

/// Returns the text of an element, without trailing blanks; empty if it does not exist.
inline std::string textOf(const gdcm::DataSet& data, gdcm::Tag tag) {
  if (!data.FindDataElement(tag)) return "";
  const gdcm::ByteValue* bytes = data.GetDataElement(tag).GetByteValue();
  if (!bytes || bytes->GetLength() > 4096) return "";
  std::string text(bytes->GetPointer(), bytes->GetLength());
  while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.pop_back();
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  return text;
}

/// Returns numbers written as text, separated by backslashes; empty if they do not exist or are not numbers.
inline std::vector<double> numbersOf(const gdcm::DataSet& data, gdcm::Tag tag) {
  std::vector<double> all;
  const std::string text = textOf(data, tag);
  for (const char* at = text.c_str(); *at;) {
    char* end = nullptr;
    all.push_back(std::strtod(at, &end));
    if (end == at) return {};
    while (*end == ' ') ++end;
    if (*end && *end != '\\') return {};
    at = *end ? end + 1 : end;
  }
  return all;
}

/// Returns unsigned 16-bit numbers; empty if they do not exist. GDCM has converted them to this machine's byte order.
inline std::vector<int> shortsOf(const gdcm::DataSet& data, gdcm::Tag tag) {
  const gdcm::ByteValue* bytes = data.FindDataElement(tag) ? data.GetDataElement(tag).GetByteValue() : nullptr;
  std::vector<int> all;
  const auto* raw = bytes ? reinterpret_cast<const unsigned char*>(bytes->GetPointer()) : nullptr;
  for (size_t at = 0; raw && at + 1 < bytes->GetLength(); at += 2) all.push_back(raw[at] | raw[at + 1] << 8);
  return all;
}

/// Returns an unsigned 16-bit number; 0 if it does not exist.
inline int shortOf(const gdcm::DataSet& data, gdcm::Tag tag) {
  const std::vector<int> all = shortsOf(data, tag);
  return all.empty() ? 0 : all[0];
}

inline std::vector<const gdcm::DataSet*> itemsOf(const gdcm::DataSet& data, gdcm::Tag tag,
                                                 std::vector<gdcm::SmartPointer<gdcm::SequenceOfItems>>& kept) {
  std::vector<const gdcm::DataSet*> items;
  if (!data.FindDataElement(tag)) return items;
  kept.push_back(data.GetDataElement(tag).GetValueAsSQ());
  if (!kept.back()) return items;
  for (gdcm::SequenceOfItems::SizeType n = 1; n <= kept.back()->GetNumberOfItems(); ++n)
    items.push_back(&kept.back()->GetItem(n).GetNestedDataSet());
  return items;
}

}  // namespace viscera::dicom
