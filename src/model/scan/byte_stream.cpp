// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scan/byte_stream.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "model/scene/file_bounds.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t kMostInflation = 1032;    ///< largest expansion of a byte by deflate
constexpr uint64_t kMostTrailing = 1 << 20;  ///< bytes that compressed data may have beyond the size in the header

}  // namespace

struct ByteStream::Inflater {
  z_stream state{};
  std::array<uint8_t, 1 << 16> in{};
  bool ended = false;

  Inflater() {
    if (inflateInit2(&state, 15 + 32) != Z_OK) throw SceneError("zlib: out of memory");  // 32: gzip or zlib
  }
  ~Inflater() { inflateEnd(&state); }
};

uint64_t fileBytes(const std::string& path) {
  requireWithinBounds(path);
  std::error_code error;
  if (!fs::is_regular_file(path, error)) throw SceneError(path + ": no such file");
  const uint64_t bytes = fs::file_size(path, error);
  if (error) throw SceneError(path + ": cannot be read: " + error.message());
  return bytes;
}

bool beginsAsGzip(const std::string& path) {
  uint8_t first[2] = {0, 0};
  ByteStream stream(path, 0, false);
  if (fileBytes(path) >= 2) stream.read(first, 2);
  return first[0] == 0x1f && first[1] == 0x8b;
}

std::string dataFileBeside(const std::string& header, const std::string& name_in_header, const std::string& key) {
  const std::string name =
      name_in_header.rfind("./", 0) == 0 ? name_in_header.substr(2) : name_in_header;  // as teem writes it
  const auto refuse = [&](const std::string& why) -> SceneError {
    return SceneError(header + ": " + key + " names '" + name + "', which " + why +
                      "; accepted: the plain name of a file in the folder of the header");
  };
  if (name.empty() || name == "." || name == ".." || name.find_first_of(std::string("/\\\0", 3)) != std::string::npos)
    throw refuse("is not a plain file name");
  std::error_code error;
  const fs::path folder = fs::canonical(fs::absolute(header).parent_path(), error);
  const fs::path file = fs::canonical(folder / name, error);
  if (error || !fs::is_regular_file(file, error)) throw refuse("does not exist");
  if (file.parent_path() != folder) throw refuse("is a link to another folder");
  return (fs::path(header).parent_path() / name).string();
}

ByteStream::ByteStream(std::string path, uint64_t offset, bool packed)
    : path_(std::move(path)), file_(nullptr, &std::fclose) {
  const uint64_t bytes = fileBytes(path_);
  if (offset > bytes)
    throw SceneError(path_ + ": ends early: it has " + std::to_string(bytes) + " bytes, but its data begin at byte " +
                     std::to_string(offset));
  held_ = bytes - offset;
  file_.reset(std::fopen(path_.c_str(), "rb"));
  if (!file_ || fseeko(file_.get(), static_cast<off_t>(offset), SEEK_SET) != 0)
    throw SceneError(path_ + ": cannot be read");
  if (packed) inflater_ = std::make_unique<Inflater>();
}

ByteStream::~ByteStream() = default;

void ByteStream::requireHolds(uint64_t bytes) const {
  const uint64_t most = inflater_ ? (held_ > UINT64_MAX / kMostInflation ? UINT64_MAX : held_ * kMostInflation) : held_;
  if (bytes <= most) return;
  throw SceneError(path_ + ": ends early: its header asks for " + std::to_string(bytes) + " bytes, but its " +
                   std::to_string(held_) + (inflater_ ? " compressed bytes hold at most " : " bytes hold ") +
                   std::to_string(most));
}

bool ByteStream::nextMember() {  // gzip files may have several members
  z_stream& z = inflater_->state;
  if (z.avail_in == 0) {
    z.next_in = inflater_->in.data();
    z.avail_in = static_cast<uInt>(std::fread(inflater_->in.data(), 1, inflater_->in.size(), file_.get()));
  }
  return z.avail_in > 1 && z.next_in[0] == 0x1f && z.next_in[1] == 0x8b && inflateReset(&z) == Z_OK;
}

size_t ByteStream::inflated(uint8_t* to, size_t bytes) {
  z_stream& z = inflater_->state;
  const uInt wanted = static_cast<uInt>(std::min<size_t>(bytes, 1U << 30));
  z.next_out = to;
  z.avail_out = wanted;
  while (z.avail_out == wanted && !inflater_->ended) {
    if (z.avail_in == 0) {
      z.next_in = inflater_->in.data();
      z.avail_in = static_cast<uInt>(std::fread(inflater_->in.data(), 1, inflater_->in.size(), file_.get()));
      if (z.avail_in == 0) throw SceneError(path_ + ": ends early: its compressed data are cut off");
    }
    const int result = inflate(&z, Z_NO_FLUSH);
    if (result == Z_STREAM_END) {
      inflater_->ended = !nextMember();
    } else if (result != Z_OK && result != Z_BUF_ERROR) {
      throw SceneError(path_ + ": corrupt: its compressed data cannot be inflated (" + (z.msg ? z.msg : "zlib") + ")");
    }
  }
  return wanted - z.avail_out;
}

size_t ByteStream::more(uint8_t* to, size_t bytes) {
  return inflater_ ? inflated(to, bytes) : std::fread(to, 1, bytes, file_.get());
}

void ByteStream::read(void* to, size_t bytes) {
  auto* next = static_cast<uint8_t*>(to);
  for (size_t got = 0; got < bytes;) {
    const size_t some = more(next + got, bytes - got);
    if (some == 0) throw SceneError(path_ + ": ends early: after " + std::to_string(done_ + got) + " bytes of data");
    got += some;
  }
  done_ += bytes;
}

void ByteStream::skip(uint64_t bytes) {
  std::vector<uint8_t> buffer(std::min<uint64_t>(bytes, 1 << 16));
  for (; bytes > 0; bytes -= std::min<uint64_t>(bytes, buffer.size()))
    read(buffer.data(), std::min<uint64_t>(bytes, buffer.size()));
}

void ByteStream::finish() {
  if (!inflater_) return;
  std::vector<uint8_t> buffer(1 << 16);
  uint64_t trailing = 0;
  while (const size_t some = more(buffer.data(), buffer.size())) {
    trailing += some;
    if (trailing > kMostTrailing)
      throw SceneError(path_ + ": its compressed data exceed the size in its header by more than " +
                       std::to_string(kMostTrailing) + " bytes");
  }
}

}  // namespace viscera
