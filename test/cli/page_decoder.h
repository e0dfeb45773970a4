// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <zlib.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace viscera::test {

/// Decoder of pages after the text in page_writer.h and surface_coder.h, independent of the writer and of the viewer in
/// the page.
class PageDecoder {
 public:
  struct Tube {
    size_t style = 0;
    std::vector<int64_t> steps;  ///< [3 * points]
  };
  struct Tool {
    size_t shape = 0;
    std::array<float, 3> position_m{};
  };
  struct Moment {
    std::vector<std::array<uint32_t, 4>> triangles;  ///< corners and kind
    std::vector<uint16_t> steps;                     ///< [3 * vertices] x of all, then y, then z
    std::vector<uint8_t> colors;                     ///< [4 * vertices] red of all, then green, blue, alpha
    std::vector<Tube> tubes;
    std::vector<Tool> tools;
    std::vector<std::array<float, 3>> forces_n;
    std::array<double, 3> origin_m{};
    double step_m = 0;

    size_t vertices() const { return steps.size() / 3; }
    double position_m(size_t vertex, size_t axis) const {
      return origin_m[axis] + step_m * steps[axis * vertices() + vertex];
    }
  };

  explicit PageDecoder(const std::string& html) : html_(html) {
    index = nlohmann::json::parse(between("id=\"index\">", "</script>"));
  }
  /// Returns all moments of the page, in order.
  std::vector<Moment> moments() {
    std::vector<Moment> out;
    for (const nlohmann::json& block : index["blocks"]) {
      const nlohmann::json& base = index["bases"][block["base"].get<size_t>()];
      load(base["block"]);
      Moment start;
      start.step_m = base["step"];
      for (size_t axis = 0; axis < 3; ++axis) start.origin_m[axis] = base["origin"][axis];
      readSurface(start);
      requireEnd();
      load(block["block"]);
      Moment now = start;
      for (size_t left = block["frames"]; left > 0; --left) {
        readSurface(now);
        readThings(now);
        out.push_back(now);
      }
      requireEnd();
    }
    return out;
  }
  nlohmann::json index;

 private:
  std::string between(const std::string& begin, const std::string& end) const {
    const size_t from = html_.find(begin), to = html_.find(end, from);
    if (from == std::string::npos || to == std::string::npos) throw std::runtime_error("page lacks " + begin);
    return html_.substr(from + begin.size(), to - from - begin.size());
  }
  void load(size_t number) {
    const std::string text = between("id=\"b" + std::to_string(number) + "\">", "</script>");
    std::string packed;
    uint32_t word = 0;
    int bits = 0;
    for (const char c : text) {
      static const std::string kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
      if (c == '=') break;
      word = word << 6 | static_cast<uint32_t>(kDigits.find(c));
      bits += 6;
      if (bits < 8) continue;
      bits -= 8;
      packed += static_cast<char>(word >> bits & 255);
    }
    z_stream stream = {};
    inflateInit(&stream);
    stream.next_in = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_in = static_cast<uInt>(packed.size());
    bytes_.clear();
    at_ = 0;
    for (int state = Z_OK; state == Z_OK;) {
      char part[65536];
      stream.next_out = reinterpret_cast<Bytef*>(part);
      stream.avail_out = sizeof part;
      state = inflate(&stream, Z_NO_FLUSH);
      bytes_.append(part, sizeof part - stream.avail_out);
      if (state != Z_OK && state != Z_STREAM_END) throw std::runtime_error("a block is damaged");
    }
    inflateEnd(&stream);
  }
  void requireEnd() const {
    if (at_ != bytes_.size()) throw std::runtime_error("a block has more bytes than its frames");
  }
  uint8_t byte() { return static_cast<uint8_t>(bytes_.at(at_++)); }
  uint32_t count() {
    uint32_t out = 0;
    for (int shift = 0;; shift += 7) {
      const uint8_t next = byte();
      out |= static_cast<uint32_t>(next & 127) << shift;
      if (next < 128) return out;
    }
  }
  int64_t signedCount() {
    const uint32_t bits = count();
    return bits & 1 ? -static_cast<int64_t>(bits >> 1) - 1 : static_cast<int64_t>(bits >> 1);
  }
  float number() {
    uint32_t bits = 0;
    for (int shift = 0; shift < 32; shift += 8) bits |= static_cast<uint32_t>(byte()) << shift;
    float out;
    static_assert(sizeof out == sizeof bits);
    std::memcpy(&out, &bits, sizeof out);
    return out;
  }
  size_t readTriangles(Moment& now) {
    const size_t vertices = count();
    std::set<size_t> removed;
    for (size_t left = count(), after = 0; left > 0; --left) {
      after += count();
      removed.insert(after++);
    }
    std::vector<std::array<uint32_t, 4>> kept;
    for (size_t i = 0; i < now.triangles.size(); ++i)
      if (removed.count(i) == 0) kept.push_back(now.triangles[i]);
    int64_t corner = 0;
    for (size_t left = count(); left > 0; --left) {
      std::array<uint32_t, 4> triangle{};
      triangle[3] = byte();
      for (size_t c = 0; c < 3; ++c) triangle[c] = static_cast<uint32_t>(corner += signedCount());
      corner = triangle[0];
      kept.push_back(triangle);
    }
    now.triangles = kept;
    return vertices;
  }
  std::vector<uint16_t> readNumbers(size_t count) {
    std::vector<uint16_t> out;
    for (size_t i = 0; i < count; ++i) {
      const uint8_t pair = static_cast<uint8_t>(bytes_.at(at_ + i / 2));
      out.push_back(i % 2 ? pair >> 4 : pair & 15);
    }
    at_ += (count + 1) / 2;
    std::vector<size_t> in_full;
    for (size_t i = 0; i < count; ++i)
      if (out[i] == 15) in_full.push_back(i);
    for (const size_t i : in_full) out[i] = byte();
    for (const size_t i : in_full) out[i] = static_cast<uint16_t>(out[i] | byte() << 8);
    return out;
  }
  void readSurface(Moment& now) {
    const uint8_t flags = byte();
    const size_t known = now.vertices(), vertices = flags & 1 ? readTriangles(now) : known;
    if (flags & 2) {
      std::vector<uint8_t> colors(4 * vertices);
      for (size_t i = 0; i < 4 * vertices; ++i) {
        const size_t v = i % vertices;
        colors[i] = static_cast<uint8_t>(byte() + (v < known ? now.colors[i / vertices * known + v] : 0));
      }
      now.colors = colors;
    }
    std::map<size_t, std::set<uint32_t>> smaller;
    for (const auto& triangle : now.triangles) {
      for (size_t a = 0; a < 3; ++a)
        for (size_t b = 0; b < 3; ++b)
          if (triangle[b] < triangle[a]) smaller[triangle[a]].insert(triangle[b]);
    }
    std::vector<uint16_t> steps(3 * vertices);
    for (size_t axis = 0; axis < 3; ++axis) {
      const std::vector<uint16_t> numbers = readNumbers(vertices);
      for (size_t v = 0; v < vertices; ++v) {
        int value = static_cast<int>(numbers[v] >> 1) ^ -static_cast<int>(numbers[v] & 1);
        if (v < known) value += now.steps[axis * known + v];
        const auto found = smaller.find(v);
        if (found != smaller.end()) {
          const auto last = std::prev(found->second.end());
          const size_t one = *last, other = found->second.size() > 1 ? *std::prev(last) : one;
          int sum = steps[axis * vertices + one] + steps[axis * vertices + other];
          if (v < known) sum -= now.steps[axis * known + one] + now.steps[axis * known + other];
          value += static_cast<int>(std::floor((sum + 1) / 2.0));
        }
        steps[axis * vertices + v] = static_cast<uint16_t>(value);
      }
    }
    now.steps = steps;
  }
  void readThings(Moment& now) {
    const std::vector<Tube> before = std::move(now.tubes);
    now.tubes.clear();
    for (size_t left = count(); left > 0; --left) {
      Tube tube{count(), {}};
      const size_t points = count();
      const bool follows = byte() != 0;
      for (size_t i = 0; i < 3 * points; ++i)
        tube.steps.push_back(signedCount() + (follows ? before.at(now.tubes.size()).steps.at(i)
                                              : i < 3 ? 0
                                                      : tube.steps[i - 3]));
      now.tubes.push_back(tube);
    }
    now.tools.clear();
    for (size_t left = count(); left > 0; --left) {
      Tool tool{count(), {number(), number(), number()}};
      for (int c = 0; c < 4; ++c) number();
      now.tools.push_back(tool);
    }
    now.forces_n.clear();
    const size_t styluses = count();
    for (size_t s = 0; s < styluses; ++s) now.forces_n.push_back({number(), number(), number()});
    for (size_t i = 0; i < 3 * styluses; ++i) number();
  }

  const std::string& html_;
  std::string bytes_;
  size_t at_ = 0;
};

}  // namespace viscera::test
