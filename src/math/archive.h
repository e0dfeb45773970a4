// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "viscera/math/error.h"

namespace viscera {

/// A state on its way into memory or back, in named sections. A class that keeps state has one function for both
/// directions, which visits its members in one order. So what is written and what is read cannot differ.
class Archive {
 public:
  struct Section {
    std::string name;
    std::vector<char> bytes;
  };

  Archive() = default;  ///< an archive that writes
  explicit Archive(std::vector<Section> sections) : sections_(std::move(sections)), reads_(true) {}

  bool reads() const { return reads_; }
  const std::vector<Section>& sections() const { return sections_; }
  std::vector<Section> take() { return std::move(sections_); }  ///< what was written
  /// Reserves memory for so many bytes more in the section that is written, so that they are not moved.
  void reserve(size_t bytes) { sections_.back().bytes.reserve(sections_.back().bytes.size() + bytes); }

  /// Begins a section. @throws Error  another one comes next, or the one before was not read to its end
  void section(const std::string& name) {
    if (!reads_) {
      sections_.push_back({name, {}});
      return;
    }
    end();
    if (next_ == sections_.size() || sections_[next_].name != name) throw Error("section '" + name + "' is missing");
    ++next_;
    at_ = 0;
  }
  /// Checks that the last section was read to its end. @throws Error  it was not
  void end() const {
    if (reads_ && next_ > 0 && at_ != sections_[next_ - 1].bytes.size()) throw misfit();
  }

  /// Checks what was read: a checksum only shows that the file is as it was written.
  /// @param what  is wrong, and what is accepted   @throws Error  names the section
  void require(bool holds, const std::string& what) const {
    if (!holds) throw Error("section '" + sections_[reads_ ? next_ - 1 : sections_.size() - 1].name + "': " + what);
  }

  /// Returns whether the section that is read has more bytes.
  bool more() const { return next_ > 0 && at_ < sections_[next_ - 1].bytes.size(); }

  void bytes(void* data, size_t size) {
    if (size == 0) return;
    if (!reads_) {
      std::vector<char>& to = sections_.back().bytes;
      to.insert(to.end(), static_cast<const char*>(data), static_cast<const char*>(data) + size);
      return;
    }
    const std::vector<char>& from = sections_[next_ - 1].bytes;
    if (size > from.size() - at_) throw misfit();
    std::memcpy(data, from.data() + at_, size);
    at_ += size;
  }
  /// Writes or reads a flag. @throws Error  the file has neither 0 nor 1
  void value(bool& flag) {
    auto byte = static_cast<uint8_t>(flag);
    bytes(&byte, 1);
    require(byte <= 1, "a flag is " + std::to_string(byte) + "; accepted: 0 or 1");
    flag = byte == 1;
  }
  template <size_t N>
  void value(std::array<bool, N>& flags) {
    for (bool& flag : flags) value(flag);
  }
  /// Writes or reads plain data: numbers, and structs and matrices of numbers.
  template <class T>
  void value(T& it) {
    static_assert(std::is_trivially_destructible_v<T> && !std::is_pointer_v<T>);
    bytes(static_cast<void*>(&it), sizeof it);
  }
  /// Writes or reads as many values as the vector holds. @throws Error  the archive has more or fewer
  template <class Vector>
  void values(Vector& them) {
    uint64_t count = them.size();
    value(count);
    if (count != them.size()) throw misfit();
    elements(them);
  }
  /// Writes or reads any number of values.
  template <class Vector>
  void list(Vector& them) {
    uint64_t count = them.size();
    value(count);
    if (reads_) {
      if (count > (sections_[next_ - 1].bytes.size() - at_) / sizeof(typename Vector::value_type)) throw misfit();
      them.resize(count);
    }
    elements(them);
  }

 private:
  template <class Vector>
  void elements(Vector& them) {
    using Element = typename Vector::value_type;
    static_assert(std::is_trivially_destructible_v<Element> && !std::is_same_v<Element, bool>);
    bytes(static_cast<void*>(them.data()), them.size() * sizeof(Element));
  }
  Error misfit() const {
    return Error("section '" + sections_[next_ - 1].name + "' has another size than the state of this scene");
  }

  std::vector<Section> sections_;
  bool reads_ = false;
  size_t next_ = 0, at_ = 0;  ///< section that is read next; offset in the one before it
};

}  // namespace viscera
