// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/album.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <utility>

#include "cli/npy_writer.h"
#include "export/png_writer.h"
#include "viscera/math/error.h"

namespace viscera::cli {

Album::Album(const std::string& folder, const Scene& scene, const Strokes& strokes, uint64_t ticks, Pictures pictures,
             const Kinds& kinds, Film* film)
    : folder_(folder), scene_(scene), pictures_(pictures), ticks_(ticks), kinds_(kinds), film_(film) {
  if (film_) film_->follow(scene_);
  if (!folder_.empty()) makeFolder(strokes);
  const bool writes_images = !folder_.empty() && pictures_ != Pictures::kNone;
  if (film_ || writes_images) writer_ = std::thread([this] { write(); });
}

void Album::makeFolder(const Strokes& strokes) {
  std::error_code error;
  std::filesystem::create_directories(pictures_ == Pictures::kNone ? folder_ : folder_ + "/frames", error);
  if (error) throw Error(folder_ + ": cannot create this folder for pictures: " + error.message());
  if (pictures_ == Pictures::kNone) return;
  for (const Mark& mark : strokes.marks) {
    const double tick = std::max(1.0, std::round(mark.time_s * scene_.solver.tick_hz));
    if (tick > static_cast<double>(ticks_)) {
      std::cout << "mark '" << mark.name << "' is after the end of the run: no picture\n";
      continue;
    }
    marks_.emplace(static_cast<uint64_t>(tick), mark.name);
  }
}

Album::~Album() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    end_ = true;
  }
  changed_.notify_all();
  if (writer_.joinable()) writer_.join();
}

FrameRequest Album::outputs(const Session& session) {
  FrameRequest out = filesOf(session);
  if (!film_) return out;
  out.every_image = true;
  if (!session.imageDue(film_->camera())) return out;
  film_ticks_.push_back(session.tick() + 1);
  out.cameras.resize(scene_.cameras.size());
  out.cameras[film_->camera()] = true;
  return out;
}

FrameRequest Album::filesOf(const Session& session) const {
  FrameRequest out;
  if (folder_.empty()) return out;
  const bool marked = marks_.count(session.tick() + 1) > 0;
  out.surface = session.tick() + 1 == ticks_;
  if (pictures_ == Pictures::kNone) return out;
  out.every_image = pictures_ == Pictures::kAll || marked || out.surface;
  for (size_t c = 0; c < scene_.cameras.size(); ++c) {
    const bool due = session.imageDue(c) || marked;
    out.cameras.push_back(due);
    out.right.push_back(due && scene_.cameras[c].stereo_baseline_m > 0);
    out.depth.push_back(due && kinds_.depth);
    out.labels.push_back(due && kinds_.labels);
  }
  return out;
}

void Album::add(Frame&& frame) {
  if (frame.surface) surface_ = std::move(frame.surface);
  if (frame.images.empty()) return;
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return waiting_.size() < kWaiting || error_; });
  rethrow();
  for (ImageFrame& image : frame.images) {
    const bool is_filmed = isFilmed(image);
    if (is_filmed || !folder_.empty()) waiting_.push_back({std::move(image), is_filmed});
  }
  changed_.notify_all();
}

/// Returns whether the film gets this image. Images at marks are not due in the film.
bool Album::isFilmed(const ImageFrame& image) {
  if (!film_ || image.camera != film_->camera() || image.kind != PictureKind::kColor) return false;
  if (film_ticks_.empty() || film_ticks_.front() != image.tick) return false;
  film_ticks_.pop_front();
  return true;
}

void Album::finish() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    end_ = true;
  }
  changed_.notify_all();
  if (writer_.joinable()) writer_.join();
  rethrow();
  if (!film_ticks_.empty())
    throw Error("--film: the picture of tick " + std::to_string(film_ticks_.front()) + " is missing");
  if (surface_ && !folder_.empty()) writePly(*surface_, folder_ + "/surface.ply");
}

void Album::rethrow() {
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void Album::write() {
  std::unique_lock<std::mutex> lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return end_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    const Waiting next = std::move(waiting_.front());
    waiting_.pop_front();
    changed_.notify_all();
    lock.unlock();
    std::exception_ptr error;
    try {
      if (next.is_filmed) film_->add(next.image);
      if (!folder_.empty()) writeOut(next.image);
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    if (!error) continue;
    error_ = error;
    changed_.notify_all();
    return;
  }
}

void Album::writeOut(const ImageFrame& image) const {
  constexpr const char* kSuffixes[kPictureKinds] = {"", "_right", "_depth", "_labels"};
  char number[32];
  std::snprintf(number, sizeof number, "_%06llu", static_cast<unsigned long long>(image.tick));
  const std::string camera = scene_.cameras[image.camera].name + kSuffixes[static_cast<size_t>(image.kind)];
  writeFile(image, folder_ + "/frames/" + camera + number);
  const auto named = marks_.equal_range(image.tick);
  for (auto mark = named.first; mark != named.second; ++mark)
    writeFile(image, folder_ + "/" + mark->second + "_" + camera);
}

/// Writes an image. @param stem  path without the suffix for the kind of file
void Album::writeFile(const ImageFrame& image, const std::string& stem) {
  switch (image.kind) {
    case PictureKind::kDepth:
      return writeNpy(stem + ".npy", image.width, image.height, image.depths_m);
    case PictureKind::kLabels:
      return writeGreyPng(stem + ".png", image.width, image.height, image.labels);
    default:
      return writePng(stem + ".png", image.width, image.height, image.rgb);
  }
}

Frame frameNow(Session& session, Album* album) {
  Frame now = session.drain();  // makes room for the surface
  FrameRequest outputs;
  outputs.surface = outputs.every_image = true;
  Pictures shown = session.show(outputs);
  if (!shown.surface) throw Error("the skin of tick " + std::to_string(session.tick()) + " is missing");
  for (Pictures* ready : {static_cast<Pictures*>(&now), &shown}) {
    Frame images;
    images.images = std::move(ready->images);
    if (album) album->add(std::move(images));
  }
  if (now.surface && album) {
    Frame asked;
    asked.surface = std::move(now.surface);
    album->add(std::move(asked));
  }
  now.surface = std::move(shown.surface);
  return now;
}

}  // namespace viscera::cli
