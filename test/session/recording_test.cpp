// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Sessions that are recorded and replayed: the same states, whatever was done to them; truncated or corrupted files.
#include <gtest/gtest.h>

#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <memory>
#include <random>
#include <thread>

#include "session/block_session.h"
#include "session/session_recorder.h"
#include "session/session_recording.h"
#include "session/session_replay.h"
#include "support/temporary_folder.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

using namespace test;

Scene recordedScene() {
  Scene scene = blockScene();
  scene.environment.gravity_m_per_s2 = Vector3d(0, 0, -9.81);
  scene.solver.backend = Backend::kCpu;
  scene.solver.threads = 1;
  scene.styluses[1].button1 = ToolMode::kGrasper;
  ObstacleConfig ball;
  ball.name = "ball";
  ball.shape = ObstacleShape::kSphere;
  ball.radius_m = 0.01;
  ball.frame = "carrier";
  scene.obstacles = {ball};
  return scene;
}

/// Returns a cut, and a pull with the other stylus, with jaws that close and open.
StylusSamples samplesAt(int tick) {
  StylusSamples samples = cut(tick % kCutTicks + 1);
  if (tick > 2) samples[1] = {true, {{0.012, 0.006, kHalfM + 0.0004 * (tick % 20)}, Quaterniond::Identity()}, true};
  samples[1].jaw_rad = 0.7F - 0.03F * static_cast<float>(tick % 20);
  return samples;
}

/// Does everything that can be done to a session. @returns the final hash
uint64_t live(const std::string& file, const std::string& state) {
  Session session(recordedScene());
  play(session, press, 3);  // before the recording
  SessionRecorder recorder(file);
  recorder.follow(session);
  for (int t = 1; t <= 20; ++t) {
    session.setObstacleFrame(0, {{0, 0, kHalfM + 0.02 - 0.0005 * t}, Quaterniond::Identity()});
    session.step(samplesAt(t), {});
  }
  session.save(state);
  session.resetInput();
  session.setToolMode(0, ToolSwitch::kButton2, ToolMode::kProbe);
  for (int t = 1; t <= 10; ++t) session.step(samplesAt(t), {});
  session.reset();
  session.setForceLimits(1, {1, 1, 1, 1});
  for (int t = 1; t <= 10; ++t) session.step(samplesAt(t), {});
  session.restore(state);
  for (int t = 1; t <= 15; ++t) session.step(samplesAt(t), {});
  recorder.leave();
  Session other(blockScene());
  recorder.follow(other);
  play(other, cut, 12);
  recorder.leave();
  return other.stateHash();
}

struct Replayed {
  SessionReplay::Outcome outcome;
  uint64_t hash;
  size_t looked = 0, leaps = 0;
};

Replayed again(const std::string& file, double from_s = 0, double until_s = 1e9, const Overrides& overrides = {}) {
  SessionReplay replay(file);
  std::unique_ptr<Session> session;
  Replayed out{};
  SessionReplay::Ports ports;
  ports.make = [&](const Scene& scene, size_t) -> Session& { return *(session = std::make_unique<Session>(scene)); };
  ports.leaps = [&](Session&) { ++out.leaps; };
  ports.outputs = [](const Session&) { return FrameRequest{}; };
  ports.stepped = [&](Session&, Frame&&, double) { ++out.looked; };
  out.outcome = replay.run(from_s, until_s, overrides, ports);
  out.hash = session->stateHash();
  return out;
}

class RecordingTest : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
  const std::string file_ = folder_.file("recording");
};

TEST_F(RecordingTest, EndsAsTheLiveSessionThreeTimes) {
  const uint64_t hash = live(file_, folder_.file("state"));
  for (int time = 0; time < 3; ++time) {
    const Replayed replayed = again(file_);
    EXPECT_EQ(replayed.hash, hash);
    EXPECT_FALSE(replayed.outcome.difference);
    EXPECT_TRUE(replayed.outcome.ended);
    EXPECT_EQ(replayed.outcome.steps, 67U);
    EXPECT_EQ(replayed.looked, 67U);
    EXPECT_EQ(replayed.leaps, 3U) << "a reset; a restored state, which resets first";
    EXPECT_EQ(replayed.outcome.compared, 5U) << "two first states, a restored one, two ends";
  }
}

TEST_F(RecordingTest, BeginsAtTheLastStateBeforeAndEndsWhereRequested) {
  live(file_, folder_.file("state"));
  const double tick_s = 1 / recordedScene().solver.tick_hz;
  const Replayed whole = again(file_, 0, 50 * tick_s), late = again(file_, 45 * tick_s, 50 * tick_s);
  EXPECT_EQ(whole.hash, late.hash);
  EXPECT_EQ(whole.outcome.steps, 50U);
  EXPECT_EQ(late.outcome.steps, 10U) << "from the state that was restored after 40 ticks";
  EXPECT_EQ(late.looked, 5U);
}

TEST_F(RecordingTest, SaysWhereStatesBeginToDiffer) {
  Session session(recordedScene());
  {
    SessionRecorder recorder(file_);
    recorder.follow(session);
    for (int t = 1; t <= 20; ++t) {
      if (t == 12) session.removeLog(recorder);
      if (t == 12) session.setToolMode(1, ToolSwitch::kButton1, ToolMode::kGrab);  // the recorder does not know of it
      if (t == 12) session.addLog(recorder);
      session.step(samplesAt(t), {});
    }
    recorder.leave();
  }
  const SessionReplay::Outcome outcome = again(file_).outcome;
  ASSERT_TRUE(outcome.difference);
  EXPECT_EQ(outcome.difference->tick, 20U);
  EXPECT_EQ(outcome.difference->last_same_tick, 0U);
  EXPECT_NE(outcome.difference->recorded_hash, outcome.difference->replayed_hash);
  ASSERT_TRUE(outcome.difference->measured_tick);
  EXPECT_GE(*outcome.difference->measured_tick, 12U);
  EXPECT_LE(*outcome.difference->measured_tick, 20U);
}

TEST_F(RecordingTest, OtherCamerasAndColoursAreTakenOtherTissueIsNot) {
  const uint64_t hash = live(file_, folder_.file("state"));
  EXPECT_EQ(again(file_, 0, 1e9, {"bodies[0].color=[0, 1, 0]", "cameras=[{name: other}]"}).hash, hash);
  try {
    again(file_, 0, 1e9, {"bodies[0].material.young_modulus_pa=4321"});
    ADD_FAILURE() << "other tissue was taken";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("young_modulus_pa=4321"), std::string::npos) << error.what();
  }
}

TEST_F(RecordingTest, IsOnTheDiskWithinASecond) {
  RecordFileWriter writer(file_);
  writer.put(ChunkKind::kEvents, {'a', 'b'});
  std::this_thread::sleep_for(std::chrono::seconds(1));
  RecordFileReader reader(file_);
  ASSERT_TRUE(reader.next());
  EXPECT_EQ(reader.bytes(), (std::vector<char>{'a', 'b'}));
}

TEST_F(RecordingTest, IsNeverOverwritten) {
  folder_.write("recording", "precious");
  EXPECT_THROW(RecordFileWriter writer(file_), Error);
  EXPECT_EQ(readFile(file_), "precious");
  EXPECT_THROW(RecordFileWriter writer(folder_.file("none/such")), Error);
}

TEST_F(RecordingTest, EndsWithItsLastWholeChunkWhereItsLimitIs) {
  {
    RecordFileWriter writer(file_, 2000);
    std::mt19937 random(4);
    for (int chunk = 0; chunk < 20 && writer.fault().empty(); ++chunk) {
      std::vector<char> bytes(300);
      for (char& byte : bytes) byte = static_cast<char>(random());
      writer.put(ChunkKind::kScene, bytes);
    }
    writer.finish();
    EXPECT_NE(writer.fault().find("has reached its limit of 2000 bytes"), std::string::npos) << writer.fault();
  }
  EXPECT_LE(readFile(file_).size(), 2000U);
  RecordFileReader reader(file_);
  int chunks = 0;
  while (reader.next()) ++chunks;
  EXPECT_GT(chunks, 3);
  EXPECT_EQ(reader.damage(), "");
}

TEST_F(RecordingTest, OfAFullDiskLeavesNoEmptyFile) {
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit small = before;
  small.rlim_cur = 100;  // room for the head of the file, and no chunk
  setrlimit(RLIMIT_FSIZE, &small);
  auto* const handler = std::signal(SIGXFSZ, SIG_IGN);
  std::string fault;
  {
    RecordFileWriter writer(file_);
    writer.put(ChunkKind::kScene, std::vector<char>(1000, 'a'));
    std::vector<char> bytes(1000);
    std::mt19937 random(5);
    for (char& byte : bytes) byte = static_cast<char>(random());
    writer.put(ChunkKind::kScene, bytes);
    writer.finish();
    fault = writer.fault();
  }
  const bool is_there = std::filesystem::exists(file_);
  const bool holds_one = is_there && RecordFileReader(file_).next().has_value();
  {
    const std::string other = folder_.file("other");
    RecordFileWriter writer(other);
    std::vector<char> bytes(1000);
    std::mt19937 random(5);
    for (char& byte : bytes) byte = static_cast<char>(random());
    writer.put(ChunkKind::kScene, bytes);
    writer.finish();
    EXPECT_FALSE(std::filesystem::exists(other)) << "an empty recording blocks its name";
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(fault.find("File too large"), std::string::npos) << fault;
  EXPECT_TRUE(holds_one) << "what found room stays";
}

TEST_F(RecordingTest, FromElsewhereAsksForNoThousandTimesItsSize) {
  const std::pair<ChunkKind, uint64_t> bombs[] = {{ChunkKind::kScene, kMostSceneBytes + 1},
                                                  {ChunkKind::kEvents, kMostEventBytes + 1},
                                                  {ChunkKind::kState, uint64_t{100} << 20}};
  for (const auto& [kind, bytes] : bombs) {
    const std::string file = folder_.file("bomb_" + std::to_string(bytes));
    {
      RecordFileWriter writer(file);
      Session session(recordedScene());
      if (kind != ChunkKind::kScene) writer.put(ChunkKind::kScene, RecordedScene::of(session.scene(), "cpu").bytes());
      if (kind == ChunkKind::kState) writer.put(kind, RecordedState{true, 0, 0, {}}.bytes());
      writer.put(kind, std::vector<char>(bytes));
      if (kind == ChunkKind::kEvents) writer.put(ChunkKind::kState, RecordedState{true, 0, 0, {}}.bytes());
    }
    try {
      again(file);
      ADD_FAILURE() << "chunk of " << bytes;
    } catch (const Error& error) {
      if (kind != ChunkKind::kState) {
        EXPECT_NE(std::string(error.what()).find("unpacks to " + std::to_string(bytes)), std::string::npos)
            << error.what();
      }
    }
  }
}

TEST_F(RecordingTest, CutAnywhereItIsReplayedUpToThere) {
  live(file_, folder_.file("state"));
  const std::string whole = readFile(file_);
  const SessionReplay replay(file_);
  std::mt19937 random(1);
  for (int time = 0; time < 60; ++time) {
    const std::string cut = folder_.write("cut", whole.substr(0, random() % whole.size()));
    try {
      SessionReplay part(cut);
      EXPECT_LE(part.duration_s(), replay.duration_s());
      EXPECT_NE(part.damage(), "");
      if (time % 10 == 0) {
        EXPECT_FALSE(again(cut).outcome.difference);
      }
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(cut), std::string::npos) << error.what();
    }
  }
}

TEST_F(RecordingTest, TurnedBitsAreFound) {
  live(file_, folder_.file("state"));
  const std::string whole = readFile(file_);
  std::mt19937 random(2);
  for (int time = 0; time < 200; ++time) {
    std::string spoilt = whole;
    const size_t bit = random() % (8 * whole.size());
    spoilt[bit / 8] = static_cast<char>(spoilt[bit / 8] ^ 1 << bit % 8);
    const std::string file = folder_.write("spoilt", spoilt);
    try {
      EXPECT_NE(SessionReplay(file).damage(), "") << "bit " << bit;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(file), std::string::npos) << error.what();
    }
  }
}

/// Errors that checksums do not detect: files that were written so.
TEST_F(RecordingTest, SpoiltChunksWithRightSumsAreRefusedOrReplayed) {
  live(file_, folder_.file("state"));
  std::mt19937 random(3);
  for (int time = 0; time < 60; ++time) {
    const std::string file = folder_.file("made_" + std::to_string(time));
    {
      RecordFileReader reader(file_);
      RecordFileWriter writer(file);
      while (const std::optional<ChunkKind> kind = reader.next()) {
        std::vector<char> bytes = reader.bytes();
        const bool states = *kind == ChunkKind::kState && time % 3 != 0;  // Saved.SpoiltBytes... tests more of them
        for (unsigned n = random() % 4; n > 0 && !bytes.empty() && !states; --n)
          bytes[random() % bytes.size()] = static_cast<char>(random());
        if (random() % 8 == 0) bytes.resize(bytes.size() - std::min<size_t>(bytes.size(), random() % 40));
        writer.put(random() % 30 == 0 ? ChunkKind::kState : *kind, bytes);
      }
    }
    try {
      again(file, 0, 1);
    } catch (const Error&) {
    }
  }
}

TEST_F(RecordingTest, OtherFilesAndVersionsAreRefused) {
  for (const char* bytes : {"", "viscera", "viscera session", "a file of something else altogether"})
    EXPECT_THROW(SessionReplay(folder_.write("other", bytes)), Error) << bytes;
  EXPECT_THROW(SessionReplay(folder_.file("none")), Error);
  EXPECT_THROW(SessionReplay(folder_.path()), Error);
  { RecordFileWriter writer(file_); }
  std::string newer = readFile(file_);
  newer[16] = 9;
  try {
    SessionReplay replay(folder_.write("newer", newer));
    ADD_FAILURE() << "another version was taken";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("version 9; this program reads version 1"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace viscera
