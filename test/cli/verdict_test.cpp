// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// What `viscera task` says to a person, and `viscera report` of many attempts.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>

#include "cli/small_scene.h"
#include "support/source_folder.h"
#include "support/temporary_folder.h"

namespace viscera {
namespace {

using namespace test;

/// Runs the task `touch_targets`. @param performance  good or clumsy
Ending touched(const std::string& performance, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {"task",
                                        "touch_targets",
                                        "--strokes",
                                        sourceFolder() + "/config/strokes/touch_targets_" + performance + ".yaml",
                                        "--no-view",
                                        "--set",
                                        "solver.threads=1"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return viscera(arguments);
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Verdict, IsSentencesBeforeTheJson) {
  const TemporaryFolder folder;
  const std::string out = folder.file("out");
  const Ending ending = touched("good", {"--out", out, "--name", "Zo\xc3\xab O'Neill, \"Z\""});
  ASSERT_EQ(ending.status, 0) << ending.err;
  const std::vector<std::string> lines = linesOf(ending.out);
  ASSERT_GE(lines.size(), 4u);
  const std::string &verdict = lines[lines.size() - 4], &mistakes = lines[lines.size() - 3];
  EXPECT_EQ(verdict.find("Passed: reached the goal (touch 5 targets in order) in "), 0u) << verdict;
  EXPECT_TRUE(has(verdict, "; 50 or more passes.")) << verdict;
  EXPECT_TRUE(has(mistakes, "mistake")) << mistakes;
  EXPECT_EQ(lines[lines.size() - 2], "Report: " + out + "/report/report.html");
  const nlohmann::json result = nlohmann::json::parse(lines.back())["tasks"][0];
  EXPECT_EQ(result["verdict"], verdict);
  EXPECT_EQ(result["failed_limit"], "");

  const nlohmann::json& attempt = result["attempt"];
  EXPECT_EQ(attempt["name"], "Zo\xc3\xab O'Neill, \"Z\"");
  EXPECT_TRUE(std::regex_match(attempt["date"].get<std::string>(),
                               std::regex("20[0-9]{2}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}Z")));
  EXPECT_EQ(attempt["state_hash"], nlohmann::json::parse(lines.back())["state_hash"]);
  EXPECT_TRUE(has(viscera({"--version"}).out, attempt["version"])) << attempt["version"];
  EXPECT_TRUE(has(readFile(out + "/report/report.csv"), "attempt,name,\"Zo\xc3\xab O'Neill, \"\"Z\"\"\"\n"));
}

TEST(Verdict, ReportsHaveOnlyTheMeasuresOfTheirKindWithUnitsAndLimits) {
  const TemporaryFolder folder;
  const std::string out = folder.file("out");
  const Ending ending = touched("clumsy", {"--out", out, "--name", "<b>Ann</b>"});
  EXPECT_EQ(ending.status, 1) << "a name begins with a letter or a digit";
  ASSERT_EQ(touched("clumsy", {"--out", out, "--name", "A<b>nn"}).status, 0);
  const nlohmann::json report = nlohmann::json::parse(readFile(out + "/report/report.json"));
  EXPECT_EQ(report["state"], "failed");
  EXPECT_NE(report["failed_limit"], "");
  EXPECT_EQ(report["verdict"].get<std::string>().find("Failed: "), 0u);
  EXPECT_FALSE(report["measures"].contains("gap_mm"));
  EXPECT_EQ(report["measures"]["peak_force_n"]["unit"], "N");
  EXPECT_EQ(report["measures"]["wrong_touches"]["most"], 0);
  const std::string page = readFile(out + "/report/report.html");
  for (const char* text : {"A&lt;b&gt;nn", "wrong_touches", "class='exceeded'", "time, s", "speed of the tip, m/s",
                           "force, N", "x, mm", "y, mm", "state hash"})
    EXPECT_TRUE(has(page, text)) << text;
  EXPECT_FALSE(has(page, "gap_mm"));
  EXPECT_FALSE(has(page, "<a href"));
}

TEST(Verdict, ReportLinksThePageOfTheSession) {
  const TemporaryFolder folder;
  ASSERT_EQ(touched("good", {"--out", folder.file("out"), "--page", folder.file("session's.html")}).status, 0);
  const std::string report = readFile(folder.file("out") + "/report/report.html");
  const std::string link = "href='../../session&#39;s.html'";
  EXPECT_TRUE(has(report, link)) << report.substr(0, 2000);
  EXPECT_TRUE(std::filesystem::exists(folder.file("out") + "/report/../../session's.html"));
}

TEST(Verdict, NamesAreChecked) {
  for (const std::string& name : {std::string(), std::string("a\nb"), std::string(65, 'a'), std::string("=1+1")}) {
    const std::vector<std::string> errors = complaints(touched("good", {"--name", name}));
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_TRUE(has(errors[0], "--name: a trainee's name must have 1 to 64 printable characters")) << errors[0];
  }
}

/// Returns the text of a report.json.
std::string attempt(const std::string& name, const std::string& date, double score) {
  return R"({"task": "incision", "title": "Incision", "state": ")" + std::string(score > 30 ? "passed" : "failed") +
         R"(", "score": )" + std::to_string(score) + R"(, "pass_score": 30, "time_s": 20, "attempt": {"name": ")" +
         name + R"(", "date": ")" + date + R"(", "version": "0.1.0", "state_hash": ""}})";
}

TEST(Report, HasATableAndCurvesOfAllAttempts) {
  const TemporaryFolder folder;
  const auto put = [&](const std::string& name, const std::string& text) {
    std::filesystem::create_directories(folder.file(name));
    folder.write(name + "/report.json", text);
  };
  put("a/report", attempt("Ann", "2026-02-01T10:00:00Z", 41));
  put("b/report", attempt("Ann", "2026-01-01T10:00:00Z", 22));
  put("c/report", attempt("Ben", "2026-01-15T10:00:00Z", 35));
  put("bad", "{");
  put("foreign", R"({"task": 3})");
  folder.write("a/report/report.html", "<!doctype html>");
  const Ending ending = viscera({"report", folder.path()});
  ASSERT_EQ(ending.status, 0) << ending.err;
  EXPECT_TRUE(has(ending.out, "skipped: " + folder.file("bad/report.json") + ": is not JSON")) << ending.out;
  EXPECT_TRUE(has(ending.out, "foreign/report.json: 'task' must be a text")) << ending.out;
  EXPECT_TRUE(has(ending.out, "attempts: 3, tasks: 1, trainees: 2, skipped files: 2")) << ending.out;
  const std::string page = readFile(folder.file("progress.html"));
  EXPECT_LT(page.find("2026-01-01T10:00:00Z"), page.find("2026-01-15T10:00:00Z")) << "by date";
  EXPECT_LT(page.find("2026-01-15T10:00:00Z"), page.find("2026-02-01T10:00:00Z"));
  for (const char* text :
       {"3 attempts; 2 files skipped", "Ann", "Ben", "score, points", "href='./a/report/report.html'"})
    EXPECT_TRUE(has(page, text)) << text;
  const std::string elsewhere = folder.file("page.html");
  EXPECT_EQ(viscera({"report", folder.path(), "--out", elsewhere}).status, 0);
  EXPECT_TRUE(has(readFile(elsewhere), "Progress"));
}

TEST(Report, ErrorsNameTheFolder) {
  const TemporaryFolder folder;
  for (const std::string& wrong : {folder.path(), folder.file("nowhere")}) {
    const std::vector<std::string> errors = complaints(viscera({"report", wrong}));
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_TRUE(has(errors[0], wrong)) << errors[0];
  }
  EXPECT_TRUE(has(viscera({"--help"}).out, "report"));
}

}  // namespace
}  // namespace viscera
