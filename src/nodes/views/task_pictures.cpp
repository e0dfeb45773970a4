// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/views/task_pictures.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include "export/png_writer.h"
#include "viscera/math/error.h"

namespace viscera::nodes {

namespace {

// Longest wait for an image: a paused or overloaded simulator writes its report without one.
constexpr std::chrono::seconds kLongest{5};

}  // namespace

void TaskPictures::clear() {
  asked_.reset();
  taken_.clear();
}

void TaskPictures::ask(const std::string& caption, const std::string& name, uint64_t tick) {
  if (can_draw_) asked_ = Asked{caption, name, tick, std::chrono::steady_clock::now()};
}

bool TaskPictures::waits() const {
  return asked_ && std::chrono::steady_clock::now() - asked_->since < kLongest;
}

void TaskPictures::addTo(FrameRequest& outputs) const {
  if (!waits()) return;
  if (outputs.cameras.empty()) outputs.cameras.resize(1);
  outputs.cameras[0] = true;
}

void TaskPictures::take(const std::vector<ImageFrame>& images, uint64_t tick) {
  if (!waits()) {
    asked_.reset();
    return;
  }
  for (const ImageFrame& image : images) {  // those of before a reset have later ticks
    if (image.camera != 0 || image.kind != PictureKind::kColor || image.tick <= asked_->tick || image.tick > tick)
      continue;
    taken_.push_back({asked_->caption, asked_->name, image});
    asked_.reset();
    return;
  }
}

std::vector<TaskPictures::Taken> TaskPictures::release() {
  asked_.reset();
  return std::exchange(taken_, {});
}

std::vector<ReportPicture> TaskPictures::write(const std::string& folder, const std::vector<Taken>& taken) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error(folder + ": cannot create this folder for a report: " + error.message());
  std::vector<ReportPicture> out;
  for (const Taken& picture : taken) {
    const std::string file = folder + "/" + picture.name + ".png";
    writePng(file, picture.image.width, picture.image.height, picture.image.rgb);
    out.push_back({picture.caption, file});
  }
  return out;
}

}  // namespace viscera::nodes
