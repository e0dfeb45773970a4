// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/files/import_log.h"

#include <algorithm>
#include <assimp/DefaultLogger.hpp>
#include <assimp/LogStream.hpp>
#include <cctype>
#include <memory>
#include <mutex>

#include "viscera/math/error.h"

namespace viscera {
namespace {

class Lines : public Assimp::LogStream {
 public:
  explicit Lines(std::vector<std::string>& lines) : lines_(lines) {}
  void write(const char* message) override { lines_.emplace_back(message); }

 private:
  std::vector<std::string>& lines_;
};

}  // namespace

std::vector<std::string> assimpErrorsOf(const std::function<void()>& read) {
  static std::mutex one_at_a_time;  // assimp has one logger per program
  const std::lock_guard<std::mutex> lock(one_at_a_time);
  std::vector<std::string> errors;
  if (!Assimp::DefaultLogger::isNullLogger()) {
    read();
    return errors;
  }
  struct Logger {
    Logger() { Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0); }
    ~Logger() { Assimp::DefaultLogger::kill(); }  // and its streams
  };
  const Logger logger;
  auto lines = std::make_unique<Lines>(errors);
  if (Assimp::DefaultLogger::get()->attachStream(lines.get(), Assimp::Logger::Err)) lines.release();
  read();
  return errors;
}

void requireVerticesOfFaces(const std::vector<std::string>& errors) {
  for (std::string line : errors) {
    std::string small = line;
    std::transform(small.begin(), small.end(), small.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    for (const char* words : {"vertex index", "face index", "vertex reference", "position index"}) {
      if (small.find(words) == std::string::npos) continue;
      while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back()))) line.pop_back();
      throw MeshError("is corrupt: a face refers to a vertex that does not exist (" + line + "); export it again");
    }
  }
}

}  // namespace viscera
