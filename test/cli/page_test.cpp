// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Pages of sessions: --page of `viscera run`, `task` and `replay`. test/cli/page_in_browser_test.py opens them.
#include "cli/page_decoder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>

#include "cli/small_scene.h"

namespace viscera {
namespace {

using namespace test;
namespace fs = std::filesystem;

/// A cut through the block, of half a second.
constexpr const char* kPageStrokes =
    "strokes:\n"
    "  - stylus: left\n"
    "    keys:\n"
    "      - {t_s: 0, position_m: [-0.05, 0, 0], rotation_deg: [0, 0, 0], button1: true}\n"
    "      - {t_s: 0.5, position_m: [0.05, 0, 0], rotation_deg: [0, 0, 0], button1: true}\n"
    "marks: [{name: half <way>, t_s: 0.25}]\n";

/// Surface mesh of a PLY file that `viscera` wrote.
struct Ply {
  std::vector<float> positions_m;
  std::multiset<std::array<uint32_t, 4>> triangles;  ///< corners and kind

  explicit Ply(const std::string& path) {
    const std::string bytes = readFile(path), end = "end_header\n";
    const auto after = [&](const std::string& text) {
      return std::stoul(bytes.substr(bytes.find(text) + text.size()));
    };
    const size_t vertices = after("element vertex "), faces = after("element face ");
    const size_t stride = 24 + (bytes.find("property uchar red") < bytes.find(end) ? 3 : 0);
    const char* at = bytes.data() + bytes.find(end) + end.size();
    positions_m.resize(3 * vertices);
    for (size_t v = 0; v < vertices; ++v, at += stride) std::memcpy(&positions_m[3 * v], at, 12);
    for (size_t f = 0; f < faces; ++f, at += 15) {
      std::array<uint32_t, 4> triangle{};
      std::memcpy(triangle.data(), at + 1, 12);
      triangle[3] = static_cast<uint8_t>(at[14]);
      triangles.insert(triangle);
    }
  }
};

class PageCommand : public ::testing::Test {
 protected:
  Ending run(std::vector<std::string> options) const {
    options.insert(options.begin(),
                   {"run", scene_, "--strokes", strokes_, "--page", page_, "--set", "styluses[0].button1=cut"});
    return viscera(options);
  }
  std::set<std::string> files() const {
    std::set<std::string> out;
    for (const auto& file : fs::directory_iterator(folder_.path())) out.insert(file.path().filename().string());
    return out;
  }

  TemporaryFolder folder_;
  const std::string scene_ = folder_.write("scene.yaml", kBlockScene);
  const std::string strokes_ = folder_.write("strokes.yaml", kPageStrokes);
  const std::string page_ = folder_.file("page.html");
};

/// Expects that a moment shows the mesh of a PLY file, to half a step of its grid.
void expectMesh(const PageDecoder::Moment& moment, const std::string& file) {
  constexpr double kFloat_m = 1e-7;  // rounding of positions of float32, some cm from the origin
  const Ply ply(file);
  EXPECT_TRUE(std::multiset<decltype(moment.triangles)::value_type>(moment.triangles.begin(), moment.triangles.end()) ==
              ply.triangles)
      << file;
  ASSERT_EQ(3 * moment.vertices(), ply.positions_m.size()) << file;
  double farthest_m = 0;
  for (const auto& triangle : ply.triangles)
    for (size_t c = 0; c < 3; ++c)
      for (size_t axis = 0; axis < 3; ++axis)
        farthest_m = std::max(farthest_m, std::abs(moment.position_m(triangle[c], axis) -
                                                   static_cast<double>(ply.positions_m[3 * triangle[c] + axis])));
  EXPECT_LE(farthest_m, moment.step_m / 2 + kFloat_m) << file;
}

TEST_F(PageCommand, HasTheSurfaceOfEveryMoment) {
  const std::string out = folder_.file("out");
  const Ending ending = run({"--out", out, "--export", "skin", "--every", "0.05", "--format", "ply", "--no-view"});
  ASSERT_EQ(ending.status, 0) << ending.err;
  EXPECT_NE(ending.out.find("page: " + page_ + ", 11 frames, 20 per second, "), std::string::npos) << ending.out;
  const std::string html = readFile(page_);
  PageDecoder page(html);
  const std::vector<PageDecoder::Moment> moments = page.moments();
  ASSERT_EQ(moments.size(), 11U);
  EXPECT_EQ(page.index["times"].size(), 11U);
  size_t meshes = 0;
  for (size_t i = 1; i < moments.size(); ++i) {
    EXPECT_NEAR(page.index["times"][i], 0.05 * static_cast<double>(i), 1e-9);
    char name[64];
    std::snprintf(name, sizeof name, "/export/skin_%06zu.ply", 3 * i);
    expectMesh(moments[i], out + name);
    meshes += moments[i].triangles != moments[i - 1].triangles;
    EXPECT_EQ(moments[i].tools.size(), 1U);
    EXPECT_NEAR(static_cast<double>(moments[i].tools[0].position_m[0]), -0.05 + 0.01 * static_cast<double>(i), 1e-6);
  }
  EXPECT_GT(meshes, 1U) << "the cut has changed the triangles";
  expectMesh(moments.back(), out + "/surface.ply");
  ASSERT_EQ(page.index["marks"].size(), 2U) << page.index["marks"];
  EXPECT_EQ(page.index["marks"][0]["text"], "half <way>");
  EXPECT_EQ(page.index["marks"][1]["kind"], "cut");
}

TEST_F(PageCommand, IsOneFileThatLoadsNothing) {
  ASSERT_EQ(run({"--no-view"}).status, 0);
  const std::string html = readFile(page_);
  EXPECT_EQ(html.rfind("<!DOCTYPE html>", 0), 0U);
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
  for (const char* text : {"http:", "https:", " src=", "import "})
    EXPECT_EQ(html.find(text), std::string::npos) << "refers to something else by " << text;
  EXPECT_EQ(html.find("half <way>"), std::string::npos) << "a mark's text must not be HTML";
}

TEST_F(PageCommand, AKeyFrameBeginsEveryBlockAndALargerGridFollowsFarMotion) {
  const std::string falls = folder_.write(
      "falls.yaml",
      "name: falls\nbodies:\n  - {name: block, source: box, box_size_m: [0.04, 0.04, 0.04], spacing_m: 0.01}\n");
  const std::string out = folder_.file("out");
  const Ending ending = viscera({"run", falls, "--seconds", "0.6", "--page", page_, "--page-rate", "60", "--out", out,
                                 "--export", "skin", "--every", "0.1", "--format", "ply", "--no-view"});
  ASSERT_EQ(ending.status, 0) << ending.err;
  const std::string html = readFile(page_);
  PageDecoder page(html);
  const std::vector<PageDecoder::Moment> moments = page.moments();
  ASSERT_EQ(moments.size(), 37U);
  EXPECT_GT(page.index["bases"].size(), 1U) << "it falls farther than a grid has room, 0.3 m";
  for (size_t tick = 6; tick <= 36; tick += 6) {
    char name[64];
    std::snprintf(name, sizeof name, "/export/skin_%06zu.ply", tick);
    expectMesh(moments[tick], out + name);
  }
}

TEST_F(PageCommand, IsMadeOfARecordingAndOfATask) {
  const std::string recording = folder_.file("session.viscera"), again = folder_.file("again.html");
  ASSERT_EQ(run({"--no-view", "--record", recording}).status, 0);
  ASSERT_EQ(viscera({"replay", recording, "--no-view", "--page", again}).status, 0);
  const std::string first = readFile(page_), second = readFile(again);
  PageDecoder ran(first), replayed(second);
  const auto moments = ran.moments(), moments_again = replayed.moments();
  ASSERT_EQ(moments.size(), moments_again.size());
  EXPECT_EQ(ran.index["times"], replayed.index["times"]);
  for (size_t i = 0; i < moments.size(); ++i) EXPECT_EQ(moments[i].steps, moments_again[i].steps) << i;
  ASSERT_EQ(viscera({"replay", recording, "--no-view", "--page", again, "--from", "0.1", "--until", "0.3"}).status, 0);
  const std::string part = readFile(again);
  EXPECT_EQ(PageDecoder(part).index["times"].size(), 5U);
  const Ending judged = viscera({"task", "touch_targets", "--seconds", "0.2", "--no-view", "--page", page_});
  ASSERT_EQ(judged.status, 0) << judged.err;
  const std::string task = readFile(page_);
  const nlohmann::json index = PageDecoder(task).index;
  EXPECT_GT(index["lines"].size(), 0U);
  EXPECT_EQ(index["statuses"].back()[1].get<std::string>().empty(), false);
}

TEST_F(PageCommand, ErrorsNameWhatIsWrong) {
  const std::string text = folder_.write("text.html", "mine");
  const std::set<std::string> before = files();
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"--page", folder_.file("page.mp4")}, "pages are .html files; give a name that ends in .html"},
      {{"--page", text}, text + ": cannot be written: it already exists as text"},
      {{"--page", folder_.file("none/page.html")}, "none/page.html: cannot be written: No such file"},
      {{"--page", page_, "--page-rate", "0"}, "--page-rate"},
      {{"--page-rate", "20"}, "--page"},
  };
  for (const auto& [options, says] : cases) {
    std::vector<std::string> words = {"run", scene_, "--seconds", "0.1", "--no-view"};
    words.insert(words.end(), options.begin(), options.end());
    const Ending ending = viscera(words);
    EXPECT_NE(ending.status, 0) << says;
    EXPECT_NE(ending.err.find(says), std::string::npos) << ending.err;
    EXPECT_EQ(files(), before) << says;
  }
}

}  // namespace
}  // namespace viscera
