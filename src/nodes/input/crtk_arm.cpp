// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/input/crtk_arm.h"

#include <ros/console.h>
#include <std_msgs/Empty.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "nodes/input/device_messages.h"
#include "nodes/ros/conversions.h"

namespace viscera::nodes {
namespace {

constexpr uint32_t kNewest = 1, kEvents = 16;
constexpr double kSetpoints_s = 0.005;  ///< period of setpoints [s]; crtk_python_client waits for data newer than 10 ms

bool isReceived(const ros::Publisher& publisher) {
  return publisher.getNumSubscribers() > 0;
}

geometry_msgs::PoseStamped stamped(const Pose& pose, const std::string& frame, const ros::Time& stamp) {
  geometry_msgs::PoseStamped message;
  message.header.frame_id = frame;
  message.header.stamp = stamp;
  message.pose = toMessage(pose);
  return message;
}

/// Returns the twist of a motion between two poses in span_s, in the frame of both.
geometry_msgs::TwistStamped twist(const Pose& from, const Pose& to, double span_s, const std::string& frame,
                                  const ros::Time& stamp) {
  geometry_msgs::TwistStamped message;
  message.header.frame_id = frame;
  message.header.stamp = stamp;
  if (!(span_s > 0)) return message;
  const Vector3d speed = (to.position_m - from.position_m) / span_s;
  const Eigen::AngleAxisd turned(to.orientation * from.orientation.conjugate());
  const Vector3d turn = turned.axis() * (turned.angle() > M_PI ? turned.angle() - 2 * M_PI : turned.angle()) / span_s;
  message.twist.linear = toVector(speed);
  message.twist.angular = toVector(turn);
  return message;
}

}  // namespace

CrtkArm::CrtkArm(StylusMailbox& mailbox)
    : mailbox_(mailbox),
      base_(mailbox.device().pose.topic),
      motion_(mailbox.device().arm),
      frame_(mailbox.device().pose.frame),
      last_measured_(motion_.setpoint()) {
  if (mailbox.device().arm.joints == ArmJoints::kNone) return;
  arm_.emplace(mailbox.device().arm.joints);
  joints_ = measured_joints_ = arm_->reach(motion_.setpoint(), DaVinciArm::Joints(arm_->count())).value();
}

void CrtkArm::subscribe(ros::NodeHandle& node, FrameLookup lookup) {
  lookup_ = std::move(lookup);
  const std::string at = base_ + "/";
  measured_cp_ = node.advertise<geometry_msgs::PoseStamped>(at + "measured_cp", kNewest);
  setpoint_cp_ = node.advertise<geometry_msgs::PoseStamped>(at + "setpoint_cp", kNewest);
  goal_cp_ = node.advertise<geometry_msgs::PoseStamped>(at + "goal_cp", kNewest);
  measured_cv_ = node.advertise<geometry_msgs::TwistStamped>(at + "measured_cv", kNewest);
  operating_state_ = node.advertise<crtk_msgs::OperatingState>(at + "operating_state", kEvents, true);
  measured_js_ = node.advertise<sensor_msgs::JointState>(at + "jaw/measured_js", kNewest);
  setpoint_js_ = node.advertise<sensor_msgs::JointState>(at + "jaw/setpoint_js", kNewest);
  const auto hints = ros::TransportHints().tcpNoDelay();
  commands_ = {
      node.subscribe(at + "servo_cp", kNewest, &CrtkArm::onServo, this, hints),
      node.subscribe(at + "move_cp", kNewest, &CrtkArm::onMove, this, hints),
      node.subscribe(at + "servo_cv", kNewest, &CrtkArm::onVelocity, this, hints),
      node.subscribe<std_msgs::Empty>(
          at + "hold", kEvents, [this](const std_msgs::EmptyConstPtr&) { onHold(); }, ros::VoidConstPtr(), hints),
      node.subscribe<sensor_msgs::JointState>(
          at + "jaw/servo_jp", kNewest, [this](const auto& received) { onJaw(*received, false); }, ros::VoidConstPtr(),
          hints),
      node.subscribe<sensor_msgs::JointState>(
          at + "jaw/move_jp", kNewest, [this](const auto& received) { onJaw(*received, true); }, ros::VoidConstPtr(),
          hints),
      node.subscribe(at + "state_command", kEvents, &CrtkArm::onState, this, hints)};
  if (arm_) {
    measured_joints_js_ = node.advertise<sensor_msgs::JointState>(at + "measured_js", kNewest);
    setpoint_joints_js_ = node.advertise<sensor_msgs::JointState>(at + "setpoint_js", kNewest);
    for (const bool moves : {false, true})
      commands_.push_back(node.subscribe<sensor_msgs::JointState>(
          at + (moves ? "move_jp" : "servo_jp"), kNewest,
          [this, moves](const auto& received) { onJoints(*received, moves); }, ros::VoidConstPtr(), hints));
  }
  setpoints_ = node.createSteadyTimer(ros::WallDuration(kSetpoints_s),
                                      [this](const ros::SteadyTimerEvent&) { tellSetpoints(); });
  const std::lock_guard<std::mutex> lock(mutex_);
  mailbox_.hold(true);
  place();
  mailbox_.grip({motion_.jaw_rad()}, 0, std::chrono::steady_clock::now());
  tellState();
}

/// Returns whether a command is in the frame of the arm's base. CRTK clients send neither stamp nor frame: a command
/// without a frame is.
bool CrtkArm::isOfBase(const std::string& frame) const {
  return frame.empty() || frame == (frame_.empty() ? mailbox_.deviceFrame().name : tf2Name(frame_));
}

/// Looks up another frame. @returns nothing if tf does not connect it to the tissue frame: the command is refused
std::optional<Pose> CrtkArm::poseOfFrame(const std::string& frame, const std::string& topic) {
  const FramePose frame_pose = lookup_(frame);
  if (!frame_pose.in_tissue)
    refuse(topic, frame_pose.too_old ? Drop::kOldTransform : Drop::kNoTransform,
           ": '" + frame + "' to the tissue frame; a command without a frame is in the frame of the arm's base");
  return frame_pose.in_tissue;
}

/// Converts a pose to the arm's base. @returns nothing if it is refused
std::optional<Pose> CrtkArm::inBase(const geometry_msgs::PoseStamped& message, const std::string& topic) {
  Pose pose = fromMessage(message.pose);
  if (!isFinite(pose)) return refuse(topic, Drop::kNotFinite), std::nullopt;
  if (!isUnit(pose.orientation)) return refuse(topic, Drop::kBadQuaternion), std::nullopt;
  pose.orientation.normalize();
  const std::string frame = tf2Name(message.header.frame_id);
  if (isOfBase(frame)) return pose;
  const std::optional<Pose> frame_pose = poseOfFrame(frame, topic);
  if (!frame_pose) return std::nullopt;
  const Pose received = mailbox_.inDevice(*frame_pose * pose * mailbox_.device().tip.pose());
  if (!isFinite(received)) return refuse(topic, Drop::kNotFinite), std::nullopt;
  return received;
}

void CrtkArm::refuse(const std::string& topic, Drop reason, const std::string& detail) {
  mailbox_.drop(reason);
  if (std::exchange(warned_, true)) return;
  ROS_WARN("%s/%s: a command was dropped (%s%s); later ones are counted in /diagnostics", base_.c_str(), topic.c_str(),
           nodes::text(reason), detail.c_str());
}

void CrtkArm::onServo(const geometry_msgs::PoseStamped& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::optional<Pose> pose = inBase(message, "servo_cp");
  if (pose && isReached(*pose, "servo_cp") && motion_.servo(*pose)) place();
}

void CrtkArm::onMove(const geometry_msgs::PoseStamped& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::optional<Pose> pose = inBase(message, "move_cp");
  if (pose && isReached(*pose, "move_cp") && motion_.move(*pose)) tellState();
}

void CrtkArm::onJoints(const sensor_msgs::JointState& message, bool moves) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const char* const topic = moves ? "move_jp" : "servo_jp";
  const DaVinciArm::Joints& goal = message.position;
  if (goal.size() != arm_->count())
    return refuse(topic, Drop::kJointCount,
                  ": " + std::to_string(goal.size()) + " positions, not " + std::to_string(arm_->count()));
  for (const double joint : goal)
    if (!std::isfinite(joint)) return refuse(topic, Drop::kNotFinite);
  if (!arm_->isWithin(goal)) return refuse(topic, Drop::kOutsideWorkspace, "; its joints are " + arm_->limitsText());
  if (!moves) {
    if (!motion_.servo(arm_->tip(goal))) return;
    joints_ = goal;  // the roll is that of the command, not the nearest one
    return place();
  }
  double turn_rad = 0;
  for (size_t i = 0; i < goal.size(); ++i)
    if (i != DaVinciArm::kInsertion) turn_rad = std::max(turn_rad, std::abs(goal[i] - joints_[i]));
  const double slide_m = std::abs(goal[DaVinciArm::kInsertion] - joints_[DaVinciArm::kInsertion]);
  const auto path = [this, from = joints_, goal](double share) { return arm_->tip(between(from, goal, share)); };
  if (motion_.moveAlong(path, turn_rad, slide_m)) tellState();
}

/// Returns whether the joints reach a pose; refuses the command if not.
bool CrtkArm::isReached(const Pose& pose, const std::string& topic) {
  if (!arm_) return true;
  if (arm_->reach(pose, joints_)) return true;
  refuse(topic, Drop::kOutsideWorkspace, "; its joints are " + arm_->limitsText());
  return false;
}

/// Returns a pose as its joints reach it: the scope of an ECM has no wrist. Out of reach: that of the present joints.
Pose CrtkArm::reached(const Pose& pose) const {
  return arm_ ? arm_->tip(arm_->reach(pose, joints_).value_or(joints_)) : pose;
}

/// Stops the arm at the end of its reach.
void CrtkArm::stayWithinReach() {
  if (arm_ && !isReached(motion_.setpoint(), "a move or velocity")) motion_.servo(arm_->tip(joints_));
}

sensor_msgs::JointState CrtkArm::toJoints(const DaVinciArm::Joints& joints, const ros::Time& stamp) const {
  sensor_msgs::JointState message;
  message.header.stamp = stamp;
  message.name = arm_->names();
  message.position = joints;
  return message;
}

void CrtkArm::onVelocity(const geometry_msgs::TwistStamped& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const geometry_msgs::Vector3 &linear = message.twist.linear, &angular = message.twist.angular;
  Vector3d along(linear.x, linear.y, linear.z), about(angular.x, angular.y, angular.z);
  if (!along.allFinite() || !about.allFinite()) return refuse("servo_cv", Drop::kNotFinite);
  const std::string frame = tf2Name(message.header.frame_id);
  if (!isOfBase(frame)) {
    const std::optional<Pose> frame_pose = poseOfFrame(frame, "servo_cv");
    if (!frame_pose) return;
    const Quaterniond turn = mailbox_.deviceFrame().from_tissue * frame_pose->orientation;
    along = turn * along / (mailbox_.device().pose.unit_m * mailbox_.device().scale);
    about = turn * about;
    if (!along.allFinite() || !about.allFinite()) return refuse("servo_cv", Drop::kNotFinite);
  }
  motion_.servoVelocity(along, about);
}

void CrtkArm::onHold() {
  const std::lock_guard<std::mutex> lock(mutex_);
  motion_.hold();
}

void CrtkArm::onJaw(const sensor_msgs::JointState& message, bool moves) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const char* const topic = moves ? "jaw/move_jp" : "jaw/servo_jp";
  if (message.position.empty()) return refuse(topic, Drop::kNoButtons);
  const double angle_rad = message.position.front();
  if (!std::isfinite(angle_rad)) return refuse(topic, Drop::kNotFinite);
  if (std::abs(angle_rad) > kWidestJaw_rad) return refuse(topic, Drop::kJawAngle);
  if (moves) {
    if (motion_.moveJaw(angle_rad)) tellState();
  } else if (motion_.servoJaw(angle_rad)) {
    mailbox_.grip({angle_rad}, 0, std::chrono::steady_clock::now());
  }
}

void CrtkArm::onState(const crtk_msgs::StringStamped& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const ArmMotion before = motion_;
  if (const std::optional<std::string> wrong = motion_.command(message.string))
    ROS_WARN("%s/state_command: %s", base_.c_str(), wrong->c_str());
  mailbox_.hold(motion_.state() != ArmMotion::State::kDisabled);
  if (motion_.state() == before.state() && motion_.homed() == before.homed()) return;
  if (motion_.state() != ArmMotion::State::kDisabled) place();
  // Publishes only changes: a client that waits for the end of its move takes any state that is not busy for it.
  tellState();
}

/// Moves the tool to the arm's setpoint.
void CrtkArm::place() {
  Pose setpoint = motion_.setpoint();
  if (arm_) {
    if (const auto joints = arm_->reach(setpoint, joints_)) joints_ = *joints;
    setpoint = arm_->tip(joints_);  // the scope of an ECM has no wrist
  }
  const ros::Time now = ros::Time::now();
  const std::optional<Drop> reason =
      mailbox_.put({setpoint, frame_, now}, lookup_, {std::chrono::steady_clock::now(), now});
  if (reason) refuse("servo_cp", *reason);
}

void CrtkArm::beginTick() {
  const std::lock_guard<std::mutex> lock(mutex_);
  const SteadyTime now = std::chrono::steady_clock::now();
  const double span_s = ticked_ == SteadyTime{} ? 0 : std::chrono::duration<double>(now - ticked_).count();
  ticked_ = now;
  if (!motion_.moves()) return;
  const double jaw_rad = motion_.jaw_rad();
  motion_.advance(span_s);
  stayWithinReach();
  if (motion_.jaw_rad() != jaw_rad) mailbox_.grip({motion_.jaw_rad()}, 0, now);
  place();
}

void CrtkArm::endTick(const StylusMotion& tool, double jaw_moment_nm, const ros::Time& stamp) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const Pose measured = mailbox_.inDevice(tool.to);
  measured_jaw_.reset();
  if (hasJaws(tool)) measured_jaw_ = toJaw(tool, jaw_moment_nm, stamp);
  const std::string frame = mailbox_.deviceFrame().name;
  if (isReceived(measured_cp_)) measured_cp_.publish(stamped(measured, frame, stamp));
  if (isReceived(measured_cv_))
    measured_cv_.publish(twist(last_measured_, measured, (stamp - last_sent_).toSec(), frame, stamp));
  if (arm_ && isReceived(measured_joints_js_)) {
    // A tool that lags behind may be beyond the limits: the joints of before are sent again.
    const auto joints = arm_->reach(measured, measured_joints_);
    if (joints) measured_joints_ = *joints;
    measured_joints_js_.publish(toJoints(measured_joints_, stamp));
  }
  last_measured_ = measured;
  last_sent_ = stamp;
  if (motion_.busy() != sent_busy_) tellState();
}

/// Publishes setpoints and goals of the arm and its jaws.
void CrtkArm::tellSetpoints() {
  const std::lock_guard<std::mutex> lock(mutex_);
  const ros::Time stamp = ros::Time::now();
  const std::string frame = mailbox_.deviceFrame().name;
  if (isReceived(setpoint_cp_)) setpoint_cp_.publish(stamped(reached(motion_.setpoint()), frame, stamp));
  if (isReceived(goal_cp_)) goal_cp_.publish(stamped(reached(motion_.goal()), frame, stamp));
  if (arm_ && isReceived(setpoint_joints_js_)) setpoint_joints_js_.publish(toJoints(joints_, stamp));
  if (!isReceived(measured_js_) && !isReceived(setpoint_js_)) return;
  sensor_msgs::JointState jaw;
  jaw.header.stamp = stamp;
  jaw.name = {"jaw"};
  jaw.position = {motion_.jaw_rad()};
  setpoint_js_.publish(jaw);
  sensor_msgs::JointState& measured = measured_jaw_ ? *measured_jaw_ : jaw;
  measured.header.stamp = stamp;
  measured_js_.publish(measured);
}

void CrtkArm::tellState() {
  sent_busy_ = motion_.busy();
  crtk_msgs::OperatingState message;
  message.header.stamp = ros::Time::now();
  message.state = viscera::text(motion_.state());
  message.is_homed = motion_.homed();
  message.is_busy = sent_busy_;
  operating_state_.publish(message);
}

bool CrtkArm::hasClient() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const ros::Subscriber& command : commands_)
    if (command.getNumPublishers() > 0) return true;
  return false;
}

}  // namespace viscera::nodes
