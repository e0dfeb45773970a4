// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/detail/detail_cache.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "math/out_file.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

namespace fs = std::filesystem;

constexpr uint64_t kVersion = 1;  // version of the bake and of the file
constexpr uint64_t kCacheMagic = 0x656b616276ULL;

/// 64-bit FNV-1a, over words of eight bytes.
class Hash {
 public:
  void add(uint64_t word) { value_ = (value_ ^ word) * 0x100000001b3ULL ^ value_ >> 29U; }
  void add(const void* data, size_t bytes) {
    const auto* at = static_cast<const unsigned char*>(data);
    add(bytes);
    for (; bytes >= 8; bytes -= 8, at += 8) {
      uint64_t word = 0;
      std::memcpy(&word, at, 8);
      add(word);
    }
    uint64_t rest = 0;
    std::memcpy(&rest, at, bytes);
    add(rest);
  }
  template <class T>
  void add(const std::vector<T>& values) {
    add(values.data(), values.size() * sizeof(T));
  }
  uint64_t value() const { return value_; }

 private:
  uint64_t value_ = 0xcbf29ce484222325ULL;
};

void addMesh(const TriangleMesh& mesh, Hash& hash) {
  hash.add(mesh.positions_m);
  hash.add(mesh.triangles);
}

void addAppearance(const TriangleMesh& mesh, Hash& hash) {
  if (!mesh.detail) return;
  hash.add(mesh.parts);
  hash.add(mesh.charts);
  hash.add(mesh.detail->part_materials);
  for (const TextureChart& chart : mesh.detail->charts) {
    hash.add(chart.u.data(), sizeof(float) * 4);
    hash.add(chart.v.data(), sizeof(float) * 4);
    hash.add(chart.material);
  }
  for (const SurfaceMaterial& of : mesh.detail->materials) {
    hash.add(of.color.data(), sizeof(float) * 3);
    hash.add(static_cast<uint64_t>(of.color_texture.image + 1) << 8U |
             static_cast<uint64_t>(of.color_texture.wrap_u) << 4U | static_cast<uint64_t>(of.color_texture.wrap_v));
  }
  for (const TextureImage& image : mesh.detail->images) hash.add(image.rgba);
}

std::string absoluteVariable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && value[0] == '/' ? value : "";  // the XDG specification ignores relative ones
}

struct CacheHeader {
  uint64_t magic = kCacheMagic, version = kVersion, width = 0, height = 0, colored = 0;
  double uncovered = 0, median = 0, percentile95 = 0, bare = 0;
};

}  // namespace

std::string detailCacheFolder() {
  const std::string cache = absoluteVariable("XDG_CACHE_HOME"), home = absoluteVariable("HOME");
  if (!cache.empty()) return cache + "/viscera";
  return home.empty() ? "" : home + "/.cache/viscera";
}

DetailCache::DetailCache(const std::string& folder, const BakeInput& input, int tile_px) {
  if (folder.empty()) return;
  Hash hash;
  hash.add(kVersion);
  hash.add(static_cast<uint64_t>(tile_px) << 1U | (input.with_colors ? 1U : 0U));
  addMesh(input.skin, hash);
  addMesh(input.detailed, hash);
  if (input.with_colors) addAppearance(input.detailed, hash);
  char name[40];
  std::snprintf(name, sizeof name, "/detail_%016llx.bin", static_cast<unsigned long long>(hash.value()));
  file_ = folder + name;
}

bool DetailCache::find(Baked& out) const {
  std::ifstream in(file_, std::ios::binary);
  CacheHeader header;
  if (!in.read(reinterpret_cast<char*>(&header), sizeof header)) return false;
  constexpr uint64_t kMost = 16384;
  if (header.magic != kCacheMagic || header.version != kVersion || header.width > kMost || header.height > kMost)
    return false;
  std::error_code error;
  const uint64_t texels = 4 * header.width * header.height;
  if (fs::file_size(file_, error) != sizeof header + texels * (header.colored ? 2 : 1)) return false;
  for (TextureImage* image : {&out.relief, &out.color}) {
    if (image == &out.color && header.colored == 0) continue;
    image->width_px = static_cast<int>(header.width);
    image->height_px = static_cast<int>(header.height);
    image->rgba.resize(texels);
    if (!in.read(reinterpret_cast<char*>(image->rgba.data()), static_cast<std::streamsize>(texels))) return false;
  }
  out.report = {
      static_cast<int>(header.width), header.uncovered, header.median, header.percentile95, header.bare, true};
  return true;
}

void DetailCache::keep(const Baked& baked) const {
  if (file_.empty()) return;
  CacheHeader header;
  header.width = static_cast<uint64_t>(baked.relief.width_px);
  header.height = static_cast<uint64_t>(baked.relief.height_px);
  header.colored = baked.color.rgba.empty() ? 0 : 1;
  header.uncovered = baked.report.uncovered_share;
  header.median = baked.report.median_deg;
  header.percentile95 = baked.report.percentile95_deg;
  header.bare = baked.report.bare_median_deg;
  std::error_code error;
  fs::create_directories(fs::path(file_).parent_path(), error);
  try {
    OutFile out(file_, FileKind::kBytes);
    out.write(&header, sizeof header);
    for (const TextureImage* image : {&baked.relief, &baked.color}) out.write(image->rgba.data(), image->rgba.size());
    out.keep();
  } catch (const Error&) {  // it is baked again next time
  }
}

}  // namespace viscera
