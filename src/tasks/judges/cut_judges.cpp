// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>

#include "model/body/body_nodes.h"
#include "model/scene/tool_kinds.h"
#include "tasks/cut_watch.h"
#include "tasks/task_kinds.h"
#include "viscera/session/session.h"

namespace viscera {

namespace {

constexpr double kPositionsPerSpacing =
    0.5;  // positions on a line that must be cut: two spacings each, so that springs end in all
constexpr double kMillimetres = 1000;
constexpr double kTurn = 6.28318530717958647692;

/// Record of which positions of a line are cut, and of cuts elsewhere.
class CoveredLine {
 public:
  CoveredLine(double length_m, double spacing_m, double corridor_m)
      : corridor_m_(corridor_m),
        length_m_(length_m),
        done_(static_cast<size_t>(std::max(1.0, std::floor(kPositionsPerSpacing * length_m / spacing_m)))),
        strayed_(done_.size()) {}

  /// @param at_m, off_m  distance of each cut point along the line, and from it
  void add(const std::vector<std::pair<double, double>>& at_m_off_m, double travel_m, TaskTally& tally) {
    size_t outside = 0;
    for (const auto& [at_m, off_m] : at_m_off_m) {
      tally.deviation_mm = std::max(tally.deviation_mm, kMillimetres * off_m);
      outside += off_m > corridor_m_;
      const double position = std::clamp(at_m / length_m_, 0.0, 1.0) * static_cast<double>(done_.size());
      (off_m <= corridor_m_ ? done_ : strayed_)[std::min(done_.size() - 1, static_cast<size_t>(position))] = true;
    }
    if (!at_m_off_m.empty())
      tally.off_path_mm +=
          kMillimetres * travel_m * static_cast<double>(outside) / static_cast<double>(at_m_off_m.size());
  }
  double share() const {
    return static_cast<double>(std::count(done_.begin(), done_.end(), true)) / static_cast<double>(done_.size());
  }
  size_t positions() const { return done_.size(); }
  /// Returns the state of each place; one next to which something was cut outside the corridor stays wrong.
  std::vector<MarkState> states() const {
    std::vector<MarkState> out;
    for (size_t i = 0; i < done_.size(); ++i)
      out.push_back(strayed_[i] ? MarkState::kWrong : done_[i] ? MarkState::kDone : MarkState::kNext);
    return out;
  }

 private:
  double corridor_m_, length_m_;
  std::vector<bool> done_, strayed_;
};

Vector3d across(const Vector3d& direction, const Vector3d& normal) {
  return direction - normal * normal.dot(direction);
}

double lengthOf(const LineGoal& line) {
  double out = 0;
  for (size_t i = 1; i < line.path.size(); ++i)
    out += across(line.path[i].position_m - line.path[i - 1].position_m, line.normal.normalized()).norm();
  return out;
}

/// Returns the width of the mark along which to cut.
double lineWidth_m(double corridor_m) {
  constexpr double kOfCorridor = 0.4, kWidest_m = 0.0008;
  return std::min(kOfCorridor * corridor_m, kWidest_m);
}

class LineJudge : public TaskJudge {
 public:
  LineJudge(const LineGoal& line, double spacing_m)
      : line_(line), normal_(line.normal.normalized()), covered_(lengthOf(line), spacing_m, line.corridor_m) {}
  bool usesCuts() const override { return true; }
  void judge(const TaskTick& tick, TaskTally& tally) override {
    std::vector<std::pair<double, double>> points;
    for (const Vector3d& cut : tick.cuts_m) points.push_back(nearest(cut));
    covered_.add(points, bladeTravel(tick, normal_), tally);
  }
  double progress() const override { return std::min(1.0, covered_.share() / line_.share); }
  bool reached() const override { return covered_.share() >= line_.share; }
  std::string step() const override { return "cut along the line"; }
  std::vector<MarkConfig> marks() const override {
    return lineInPieces(shapesOfLine(line_).lines_m[0], normal_, covered_.positions(), lineWidth_m(line_.corridor_m));
  }
  std::vector<MarkState> markStates() const override { return covered_.states(); }

 private:
  std::pair<double, double> nearest(const Vector3d& point) const {
    double before_m = 0, at_m = 0, off_m = std::numeric_limits<double>::infinity();
    for (size_t i = 1; i < line_.path.size(); ++i) {
      const Vector3d from = line_.path[i - 1].position_m;
      const Vector3d direction = across(line_.path[i].position_m - from, normal_), to = across(point - from, normal_);
      const double length_m = direction.norm();
      const double share = length_m > 0 ? std::clamp(direction.dot(to) / (length_m * length_m), 0.0, 1.0) : 0;
      const double distance_m = (to - share * direction).norm();
      if (distance_m < off_m) {
        off_m = distance_m;
        at_m = before_m + share * length_m;
      }
      before_m += length_m;
    }
    return {at_m, off_m};
  }

  const LineGoal line_;
  const Vector3d normal_;
  CoveredLine covered_;
};

class DiscJudge : public TaskJudge {
 public:
  DiscJudge(const DiscGoal& disc, const Model& model, double spacing_m)
      : disc_(disc),
        normal_(disc.normal.normalized()),
        side_(normal_.unitOrthogonal()),
        covered_(kTurn * disc.radius_m, spacing_m, disc.corridor_m),
        piece_(model, disc.center_m, normal_, disc.radius_m, disc.radius_m + disc.corridor_m + spacing_m) {}
  bool usesCuts() const override { return true; }
  uint32_t piecesApart(const CutState& cuts, const std::vector<FibreState>&) const override {
    return piece_.isApart(cuts) ? 1 : 0;
  }
  void judge(const TaskTick& tick, TaskTally& tally) override {
    std::vector<std::pair<double, double>> points;
    for (const Vector3d& cut : tick.cuts_m) {
      const Vector3d direction = across(cut - disc_.center_m, normal_);
      const double angle = std::atan2(direction.dot(normal_.cross(side_)), direction.dot(side_));
      points.emplace_back((angle < 0 ? angle + kTurn : angle) * disc_.radius_m,
                          std::abs(direction.norm() - disc_.radius_m));
    }
    covered_.add(points, bladeTravel(tick, normal_), tally);
    apart_ = apart_ || tick.apart != 0;
  }
  double progress() const override { return apart_ ? 1 : kNearlyAll * covered_.share(); }
  bool reached() const override { return apart_; }
  std::string step() const override {
    return covered_.share() < 1 ? "cut along the circle" : "free the disc where it still holds";
  }
  std::vector<MarkConfig> marks() const override {
    std::vector<Vector3d> circle;  // from the place where judge() begins to count
    const size_t corners = kCornersOfPosition * covered_.positions();
    for (size_t i = 0; i <= corners; ++i) {
      const double angle = kTurn * static_cast<double>(i) / static_cast<double>(corners);
      circle.emplace_back(disc_.center_m +
                          disc_.radius_m * (std::cos(angle) * side_ + std::sin(angle) * normal_.cross(side_)));
    }
    return lineInPieces(circle, normal_, covered_.positions(), lineWidth_m(disc_.corridor_m));
  }
  std::vector<MarkState> markStates() const override { return covered_.states(); }

 private:
  static constexpr size_t kCornersOfPosition = 4;
  static constexpr double kNearlyAll = 0.99;  // the whole circle is cut, but something still holds the disc
  const DiscGoal disc_;
  const Vector3d normal_, side_;
  CoveredLine covered_;
  const DiscPiece piece_;
  bool apart_ = false;
};

}  // namespace

double bladeTravel(const TaskTick& tick, const Vector3d& normal) {
  double out = 0;
  for (const StylusMotion& motion : tick.motions) {
    const ToolKind& kind = kindOf(motion.mode);
    if (motion.present && (kind.severs() || kind.burns))
      out = std::max(out, across(motion.to.position_m - motion.from.position_m, normal).norm());
  }
  return out;
}

std::string directionFault(const Vector3d& direction, const char* key) {
  return direction.norm() > 0 ? ""
                              : std::string("'") + key + "' must be a direction, so not all of its numbers may be 0";
}

std::string groupFault(bool given, const char* name) {
  return given ? "" : std::string("'") + name + "' is missing; a task of this kind needs it";
}

std::vector<Vector3d> circleOf(const Vector3d& center_m, const Vector3d& normal, double radius_m) {
  constexpr int kCorners = 72;
  const Vector3d up = normal.normalized(), side = up.unitOrthogonal(), other = up.cross(side);
  std::vector<Vector3d> out;
  for (int i = 0; i <= kCorners; ++i) {
    const double angle = kTurn * i / kCorners;
    out.emplace_back(center_m + radius_m * (std::cos(angle) * side + std::sin(angle) * other));
  }
  return out;
}

std::string faultOfLine(const LineGoal& line, const std::string& group) {
  const std::string normal = directionFault(line.normal, (group + ".normal").c_str());
  if (!normal.empty()) return normal;
  return line.path.size() > 1 && lengthOf(line) > 0
             ? ""
             : "'" + group + ".path' must be a list of two or more positions that are not above each other; found " +
                   std::to_string(line.path.size());
}

std::unique_ptr<TaskJudge> judgeOfLine(const LineGoal& line, double spacing_m) {
  return std::make_unique<LineJudge>(line, spacing_m);
}

TaskShapes shapesOfLine(const LineGoal& line) {
  TaskShapes out{{{}}, line.normal};
  for (const TaskPosition& position : line.path) out.lines_m[0].push_back(position.position_m);
  return out;
}

std::string lineFault(const TaskConfig& task) {
  return task.line.given ? faultOfLine(task.line, "follow_line") : groupFault(false, "follow_line");
}

std::unique_ptr<TaskJudge> lineJudge(const TaskConfig& task, const Session& session) {
  return judgeOfLine(task.line, longestSpacing(session.model()));
}

TaskShapes lineShapes(const TaskConfig& task) {
  return shapesOfLine(task.line);
}

std::string discFault(const TaskConfig& task) {
  return task.disc.given ? directionFault(task.disc.normal, "cut_disc.normal") : groupFault(false, "cut_disc");
}

std::unique_ptr<TaskJudge> discJudge(const TaskConfig& task, const Session& session) {
  return std::make_unique<DiscJudge>(task.disc, session.model(), longestSpacing(session.model()));
}

TaskShapes discShapes(const TaskConfig& task) {
  return {{circleOf(task.disc.center_m, task.disc.normal, task.disc.radius_m)}, task.disc.normal};
}

}  // namespace viscera
