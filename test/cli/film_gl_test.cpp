// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Films of sessions: --film of `viscera run`, `task` and `replay`. They need ffmpeg.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "cli/small_scene.h"
#include "support/source_folder.h"
#include "support/temporary_folder.h"

namespace viscera {
namespace {

using namespace test;
namespace fs = std::filesystem;

constexpr const char* kFilmStrokes =
    "strokes:\n"
    "  - stylus: left\n"
    "    keys:\n"
    "      - {t_s: 0, position_m: [0, 0, 0.05], rotation_deg: [0, 0, 0]}\n"
    "      - {t_s: 0.4, position_m: [0, 0, -0.035], rotation_deg: [0, 0, 0]}\n"
    "marks: [{name: between, t_s: 0.25}]\n";  // tick 15, which has no picture at 30 a second

class FilmCommand : public ::testing::Test {
 protected:
  Ending run(std::vector<std::string> options, const std::vector<std::string>& environment = {}) const {
    options.insert(options.begin(), {"run", scene_, "--strokes", strokes_, "--film", film_});
    return viscera(options, environment);
  }
  std::set<std::string> files() const {
    std::set<std::string> out;
    for (const auto& file : fs::directory_iterator(folder_.path())) out.insert(file.path().filename().string());
    return out;
  }
  /// Returns codec, size, pixels, rate and number of decoded images of the film.
  std::string formatOf() const {
    const Ending probe = runProgram("ffprobe", {"-v", "error", "-count_frames", "-select_streams", "v", "-show_entries",
                                                "stream=codec_name,width,height,pix_fmt,r_frame_rate,nb_read_frames",
                                                "-of", "csv=print_section=0", film_});
    EXPECT_EQ(probe.err, "");
    const std::vector<std::string> lines = linesOf(probe.out);
    return lines.size() == 1 ? lines[0] : probe.out;
  }
  /// Returns the images of a film, or of PNG files, as RGB8. @param input  options of ffmpeg
  static std::string imagesOf(std::vector<std::string> input) {
    input.insert(input.begin(), {"-v", "error"});
    input.insert(input.end(), {"-f", "rawvideo", "-pix_fmt", "rgb24", "-"});
    const Ending ending = runProgram("ffmpeg", input);
    EXPECT_EQ(ending.err, "");
    return ending.out;
  }
  /// Expects one error that says this, and no new files.
  void expectFault(const Ending& ending, const std::string& says, const std::set<std::string>& before) const {
    EXPECT_NE(ending.status, 0) << says;
    const std::vector<std::string> lines = complaints(ending);
    ASSERT_EQ(lines.size(), 1U) << ending.err;
    EXPECT_NE(lines[0].find(says), std::string::npos) << lines[0];
    EXPECT_EQ(files(), before) << says;
  }
  /// Makes a program ffmpeg that runs this script. @return the environment in which it is found
  std::string fakeFfmpeg(const std::string& script) const {
    fs::create_directory(folder_.file("bin"));
    const std::string file = folder_.write("bin/ffmpeg", "#!/bin/sh\n" + script);
    fs::permissions(file, fs::perms::owner_all);
    return "PATH=" + folder_.file("bin") + ":/usr/bin:/bin";
  }

  TemporaryFolder folder_;
  const std::string scene_ = folder_.write("scene.yaml", kBlockScene);
  const std::string strokes_ = folder_.write("strokes.yaml", kFilmStrokes);
  const std::string film_ = folder_.file("film.mp4");
};

TEST_F(FilmCommand, HasEveryPictureInOrder) {
  constexpr double kCompressed = 8;  // mean difference of 8-bit values that compression may make
  const std::string out = folder_.file("out");
  const Ending ending = run({"--out", out});
  ASSERT_EQ(ending.status, 0) << ending.err;
  EXPECT_NE(ending.out.find("film: " + film_ + ", 12 pictures of 64 x 48, 30 per second"), std::string::npos);
  EXPECT_EQ(formatOf(), "h264,64,48,yuv420p,30/1,12");
  EXPECT_EQ(files(), (std::set<std::string>{"film.mp4", "out", "scene.yaml", "strokes.yaml"}));
  ASSERT_TRUE(fs::remove(out + "/frames/eye_000015.png")) << "a mark has a picture, but not in the film";
  const std::string film = imagesOf({"-i", film_});
  const std::string pictures = imagesOf({"-pattern_type", "glob", "-i", out + "/frames/eye_*.png"});
  ASSERT_EQ(film.size(), size_t{12} * 64 * 48 * 3);
  ASSERT_EQ(film.size(), pictures.size());
  double difference = 0;
  for (size_t i = 0; i < film.size(); ++i)
    difference += std::abs(static_cast<uint8_t>(film[i]) - static_cast<uint8_t>(pictures[i]));
  EXPECT_LT(difference / static_cast<double>(film.size()), kCompressed);
}

TEST_F(FilmCommand, IsOfTheNamedCameraAtItsRateInEvenSizes) {
  ASSERT_EQ(run({"--film-camera", "side", "--set",
                 "cameras=[{name: eye}, {name: side, width_px: 63, height_px: 47, rate_hz: 10}]"})
                .status,
            0);
  EXPECT_EQ(formatOf(), "h264,64,48,yuv420p,10/1,4");
  ASSERT_EQ(run({"--set", "cameras[0].rate_hz=240"}).status, 0) << "a film replaces an older one";
  EXPECT_EQ(formatOf(), "h264,64,48,yuv420p,60/1,24") << "a picture per tick";
}

TEST_F(FilmCommand, IsMadeOfARecordingAndOfATask) {
  const std::string recording = folder_.file("session.viscera");
  ASSERT_EQ(viscera({"run", scene_, "--strokes", strokes_, "--no-view", "--record", recording}).status, 0);
  const Ending replayed = viscera({"replay", recording, "--film", film_});
  ASSERT_EQ(replayed.status, 0) << replayed.err;
  EXPECT_EQ(formatOf(), "h264,64,48,yuv420p,30/1,12");
  ASSERT_EQ(viscera({"replay", recording, "--film", film_, "--from", "0.1", "--until", "0.3", "--out",
                     folder_.file("out"), "--set", "cameras[0].width_px=32"})
                .status,
            0);
  EXPECT_EQ(formatOf(), "h264,32,48,yuv420p,30/1,6");
  EXPECT_TRUE(fs::exists(folder_.file("out") + "/surface.ply"));
  const Ending judged = viscera({"task", "touch_targets", "--seconds", "0.1", "--film", film_, "--set",
                                 "cameras[0].width_px=64", "--set", "cameras[0].height_px=48"});
  ASSERT_EQ(judged.status, 0) << judged.err;
  EXPECT_EQ(formatOf(), "h264,64,48,yuv420p,30/1,3");
}

TEST_F(FilmCommand, ErrorsNameWhatIsWrong) {
  const std::string recording = folder_.file("session.mp4"), scene = folder_.write("scene.mp4", kBlockScene);
  ASSERT_EQ(viscera({"run", scene_, "--no-view", "--seconds", "0.1", "--record", recording}).status, 0);
  const std::string text = folder_.write("text.mp4", "mine");
  const std::set<std::string> before = files();
  const std::string no_ffmpeg = "--film needs ffmpeg; install it with: apt install ffmpeg";
  expectFault(run({}, {"PATH=" + folder_.path()}), no_ffmpeg, before);
  expectFault(viscera({"replay", recording, "--film", film_}, {"PATH="}), no_ffmpeg, before);
  expectFault(run({"--no-view"}), "--film: needs pictures; remove --no-view", before);
  expectFault(run({"--set", "cameras=[]"}), "--film: needs pictures; scene block has no cameras", before);
  expectFault(run({"--film-camera", "side"}), "--film-camera side: scene block has no such camera; it has eye", before);
  expectFault(viscera({"replay", recording, "--film", film_, "--film-camera", "side"}), "has no such camera", before);
  expectFault(run({"--out", folder_.file("out"), "--live"}), "--film", before);
  const std::vector<std::pair<std::string, std::string>> targets = {
      {folder_.file("film.avi"), "give a name that ends in .mp4"},
      {text, text + ": cannot be written: it already exists as text"},
      {scene, scene + ": cannot be written: this command reads it"},
      {folder_.file("none/film.mp4"), "none/film.mp4: cannot be written: No such file"},
  };
  for (const auto& [target, says] : targets)
    expectFault(viscera({"run", scene, "--seconds", "0.1", "--film", target}), says, before);
  expectFault(viscera({"replay", recording, "--film", recording}), "this command reads it", before);
  expectFault(viscera({"run", scene_, "--seconds", "0", "--film", film_}), "no picture was due", before);
}

TEST_F(FilmCommand, AFailingFfmpegLeavesItsLastLineAndNoFile) {
  const std::string path = fakeFfmpeg("echo first >&2\necho \"Unknown encoder 'libx264'\" >&2\nexit 1\n");
  const std::set<std::string> before = files();
  expectFault(run({}, {path}), film_ + ": cannot be written: ffmpeg failed: Unknown encoder 'libx264'", before);
  const std::string killed = fakeFfmpeg("kill -9 $$\n");
  expectFault(run({}, {killed}), "ffmpeg failed: signal 9 ended it", before);
  Ending full = runProgram("sh", {"-c", "trap '' XFSZ; ulimit -f 1; exec \"$0\" \"$@\" 2>&1", kCommand, "run", scene_,
                                  "--seconds", "0.5", "--film", film_});
  full.err = full.out;  // because files cannot grow
  expectFault(full, "File too large", before);
}

TEST_F(FilmCommand, ASignalLeavesNoDraft) {
  const std::string script =
      "\"$0\" run \"$1\" --seconds 80000 --film \"$2\" & viscera=$!\n"
      "until ls \"$3\"/*.draft && kill -TERM $viscera; do sleep 0.1; done\n"
      "wait $viscera\n";
  const Ending ending = runProgram("sh", {"-c", script, kCommand, scene_, film_, folder_.path()});
  EXPECT_NE(ending.out.find(".draft"), std::string::npos);
  EXPECT_EQ(files(), (std::set<std::string>{"scene.yaml", "strokes.yaml"}));
}

}  // namespace
}  // namespace viscera
