#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""A tool as a CRTK arm: clients servo and move it, wait for its state, close its jaws and read its forces."""
import sys
import time
import unittest

import rospy
import rostest
from drivers import JAWS, fill, foreign, vector
from geometry_msgs.msg import PoseStamped, TransformStamped, TwistStamped, WrenchStamped
from sensor_msgs.msg import JointState
from simulator_watch import Latest, SimulatorWatch, wait_until
from std_msgs.msg import Empty
from tf2_msgs.msg import TFMessage
from tries import Late, in_one_of_several_tries
from turns import length, plus, rotation, times

HEADER = "=" * 80 + "\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"
OperatingState = foreign("crtk_msgs/OperatingState",
                         "std_msgs/Header header\nstring state\nbool is_homed\nbool is_busy\n" + HEADER)
StringStamped = foreign("crtk_msgs/StringStamped", "std_msgs/Header header\nstring string\n" + HEADER)
LIMIT_S = 20
START = (-0.03, 0, 0.05)  # of crtk_arm.test
DEEP_M = 0.012            # centre of the probe, 6 mm in the block
PLACE_M = 1e-6            # rounding
TURN = 1e-6               # rounding of a rotation's nine components
JOINTS = 1e-5             # rounding of positions, over the 9 mm of a wrist
SPEED = 0.05              # relative tolerance for a mean of a few ticks
FELT_N = 0.05
HOLDS_S = 0.1             # time for which a velocity is followed without a new command
LATE_M = 0.003            # a tick or two at 5 cm/s, on a busy machine
FRESH_HZ = 120            # crtk_python_client waits for data older than 10 ms; 200 are sent, a busy machine is late


def turn_of(orientation):
    return rotation(orientation.x, orientation.y, orientation.z, orientation.w)


def is_turned(orientation, wanted):
    return length([a - b for rows in zip(turn_of(orientation), wanted) for a, b in zip(*rows)]) < TURN


class CrtkArmTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("crtk_arm_test")
        cls.watch = SimulatorWatch()
        cls.states = []
        cls.at = Latest("PSM1/measured_cp", PoseStamped)
        cls.setpoint = Latest("PSM1/setpoint_cp", PoseStamped, queue_size=100)
        cls.speed = Latest("PSM1/measured_cv", TwistStamped)
        cls.force = Latest("PSM1/measured_cf", WrenchStamped)
        cls.jaw = Latest("PSM1/jaw/measured_js", JointState)
        cls.state = Latest("PSM1/operating_state", OperatingState, cls.states.append, queue_size=10)
        cls.tool = None
        cls.tf = Latest("/tf", TFMessage, cls.on_tf)
        cls.servo = rospy.Publisher("PSM1/servo_cp", PoseStamped, queue_size=1, latch=True)
        cls.move = rospy.Publisher("PSM1/move_cp", PoseStamped, queue_size=1, latch=True)
        cls.velocity = rospy.Publisher("PSM1/servo_cv", TwistStamped, queue_size=1)
        cls.hold = rospy.Publisher("PSM1/hold", Empty, queue_size=1)
        cls.move_jaws = rospy.Publisher("PSM1/jaw/move_jp", JointState, queue_size=1)
        cls.goal = Latest("PSM1/goal_cp", PoseStamped, queue_size=100)
        cls.jaw_setpoint = Latest("PSM1/jaw/setpoint_js", JointState, queue_size=100)
        cls.jaws = rospy.Publisher("PSM1/jaw/servo_jp", JointState, queue_size=1, latch=True)
        cls.command = rospy.Publisher("PSM1/state_command", StringStamped, queue_size=1, latch=True)
        wait_until(lambda: cls.at.message, 60, "measured_cp")
        wait_until(lambda: all(p.get_num_connections() for p in (cls.servo, cls.move, cls.jaws, cls.command,
                                                                         cls.velocity, cls.hold, cls.move_jaws)), LIMIT_S,
                   "subscribers of commands")

    @classmethod
    def on_tf(cls, message):
        for transform in message.transforms:
            if transform.child_frame_id == "left_tool":
                cls.tool = transform.transform

    def tell(self, publisher, at, jaws=JAWS, frame=""):
        """Publishes as crtk_python_client does: without a stamp and a frame. The jaws point down."""
        message = PoseStamped()
        message.header.frame_id = frame
        fill(message.pose, at, jaws)
        publisher.publish(message)

    def is_at(self, at):
        return length(plus(vector(self.at.message.pose.position), at, -1)) < PLACE_M

    def go(self, goal, steps=50):
        start = vector(self.at.message.pose.position)
        for step in range(1, steps + 1):
            self.tell(self.servo, plus(start, plus(goal, start, -1), step / steps))
            time.sleep(0.01)
        wait_until(lambda: self.is_at(goal), LIMIT_S, "arm at %s" % (goal,))

    def test_0_it_waits_where_its_profile_says_enabled_and_homed(self):
        self.assertTrue(self.is_at(START))
        state = wait_until(lambda: self.state.message, LIMIT_S, "operating state")
        self.assertEqual((state.state, state.is_homed, state.is_busy), ("ENABLED", True, False))
        self.assertEqual(self.at.message.header.frame_id, "tissue")

    def test_1_servo_is_followed_at_once_and_stays(self):
        self.go((-0.03, 0.01, 0.05))
        time.sleep(1)  # longer than the largest age of a device's poses
        self.assertTrue(self.is_at((-0.03, 0.01, 0.05)))

    def test_1b_jaws_point_along_z_of_its_poses_as_those_of_a_dvrk_do(self):
        self.assertTrue(is_turned(self.at.message.pose.orientation, JAWS))
        at = vector(self.at.message.pose.position)
        for jaws in (rotation(0.5, -0.5, 0.1, 0.7), JAWS):
            self.tell(self.servo, at, jaws)
            # the tool points along -z: its shaft is behind the jaws
            wait_until(lambda: self.tool and is_turned(self.tool.rotation, times(jaws, JAWS)), LIMIT_S, "tool turned")
            wait_until(lambda: is_turned(self.at.message.pose.orientation, jaws) and self.is_at(at), LIMIT_S, "measured_cp")
            wait_until(lambda: is_turned(self.setpoint.message.pose.orientation, jaws), LIMIT_S, "setpoint_cp")

    def waitBusy(self):
        wait_until(lambda: any(s.is_busy for s in self.states), LIMIT_S, "begun move")

    def test_2_move_takes_its_time_and_its_end_can_be_waited_for(self):
        goal = (0.01, 0.01, 0.05)
        speeds = []
        watched = Latest("PSM1/measured_cv", TwistStamped, lambda m: speeds.append(m.twist.linear.x), queue_size=100)
        wait_until(lambda: speeds, LIMIT_S, "speed at rest")
        del self.states[:]
        begun = rospy.Time.now()
        self.tell(self.move, goal)
        wait_until(lambda: self.states and not self.states[-1].is_busy and self.states[-1].header.stamp > begun, LIMIT_S,
                   "end of the move")
        self.assertTrue([s for s in self.states if s.is_busy])
        wait_until(lambda: self.is_at(goal), LIMIT_S, "arm at its goal")
        took_s = (self.states[-1].header.stamp - begun).to_sec()
        self.assertGreater(took_s, (1 - SPEED) * 15 / 8 * 0.04 / 0.2)  # least jerk: the peak is 15/8 of the mean speed
        self.assertGreater(max(speeds), 0.1)
        wait_until(lambda: abs(self.speed.message.twist.linear.x) < PLACE_M, LIMIT_S, "rest")
        watched.stop()

    def test_2b_a_state_that_is_no_news_is_not_told(self):
        count = self.state.count
        self.command.publish(StringStamped(string="enable"))
        time.sleep(0.5)
        self.assertEqual(self.state.count, count)

    def test_3_it_feels_and_its_jaws_hold(self):
        self.go((0.01, 0.01, DEEP_M))
        wait_until(lambda: self.force.message.wrench.force.z > FELT_N, LIMIT_S, "force upwards")
        self.jaws.publish(JointState(position=[0.0]))
        wait_until(lambda: (self.watch.value("left", "nodes_held") or 0) > 0, LIMIT_S, "tissue in the jaws")
        wait_until(lambda: list(self.jaw.message.position) == [0.0], LIMIT_S, "closed jaws")
        self.jaws.publish(JointState(position=[0.5]))
        wait_until(lambda: self.watch.value("left", "nodes_held") == 0, LIMIT_S, "open jaws")
        self.go((0.01, 0.01, 0.05))

    def test_4_disabled_it_is_not_there_and_paused_it_stays(self):
        self.command.publish(StringStamped(string="pause"))
        wait_until(lambda: self.state.message.state == "PAUSED", LIMIT_S, "pause")
        self.tell(self.servo, (0, 0, 0.06))
        time.sleep(0.5)
        self.assertTrue(self.is_at((0.01, 0.01, 0.05)))
        self.command.publish(StringStamped(string="disable"))
        wait_until(lambda: self.state.message.state == "DISABLED", LIMIT_S, "disabled arm")
        self.tell(self.move, (0, 0, 0.06))
        time.sleep(0.5)
        self.assertFalse(self.state.message.is_busy)
        self.command.publish(StringStamped(string="enable"))
        wait_until(lambda: self.state.message.state == "ENABLED", LIMIT_S, "enabled arm")
        self.go((0, 0, 0.06))

    def test_5_a_command_that_is_none_is_dropped(self):
        before = self.watch.value("left", "dropped_not_finite") or 0
        self.tell(self.servo, (float("nan"), 0, 0))
        wait_until(lambda: self.watch.value("left", "dropped_not_finite") == before + 1, LIMIT_S, "count")
        self.assertTrue(self.is_at((0, 0, 0.06)))

    def test_5b_a_command_of_another_frame_is_brought_to_the_base_or_refused(self):
        at = (0, 0, 0.06)
        dropped = self.watch.value("left", "dropped_no_transform") or 0
        for publisher in (self.servo, self.move):
            self.tell(publisher, (0.01, 0, 0.05), frame="nowhere")
        wait_until(lambda: self.watch.value("left", "dropped_no_transform") == dropped + 2, LIMIT_S, "count")
        self.assertTrue(self.is_at(at))
        self.tell(self.servo, (0.001, 0, 0.06), frame="/tissue")
        wait_until(lambda: self.is_at((0.001, 0, 0.06)), LIMIT_S, "arm at a place of its base")
        table = TransformStamped()
        table.header.frame_id, table.child_frame_id, table.header.stamp = "tissue", "table", rospy.Time.now()
        fill(table.transform, (0.004, 0, 0.06), ((0, -1, 0), (1, 0, 0), (0, 0, 1)))  # a quarter turn to the left
        frames = rospy.Publisher("/tf_static", TFMessage, queue_size=1, latch=True)
        frames.publish(TFMessage([table]))

        def arrives():
            self.tell(self.servo, (0, 0.002, 0), frame="table")
            return self.is_at((0.002, 0, 0.06))
        wait_until(arrives, LIMIT_S, "arm at a place of the table")
        message = TwistStamped()
        message.header.frame_id = "table"
        message.twist.linear.y = 0.01  # y of the table is -x of the tissue frame

        def goes():
            self.velocity.publish(message)
            return self.at.message.pose.position.x < 0.001
        wait_until(goes, LIMIT_S, "arm that goes as the table has it")
        self.assertLess(abs(self.at.message.pose.position.y), PLACE_M)
        time.sleep(HOLDS_S + 0.1)
        self.go(at)

    def wait_rest(self):
        wait_until(lambda: not self.state.message.is_busy, LIMIT_S, "end of the move")

    @in_one_of_several_tries
    def test_6_velocity_is_followed_while_it_is_told(self):
        self.go((-0.02, 0.01, 0.05))
        begun = last = time.monotonic()
        longest_s = 0
        for _ in range(50):  # 200 Hz, as in crtk_servo_cv_example
            message = TwistStamped()
            message.twist.linear.x = 0.05
            self.velocity.publish(message)
            time.sleep(0.005)
            longest_s, last = max(longest_s, time.monotonic() - last), time.monotonic()
        took_s = time.monotonic() - begun
        self.assertFalse(self.state.message.is_busy)
        time.sleep(HOLDS_S + 0.3)
        way = self.at.message.pose.position.x + 0.02
        if longest_s > HOLDS_S / 2:
            raise Late("one velocity came %.3f s after another" % longest_s)
        self.assertGreater(way, 0.8 * 0.05 * took_s)
        self.assertLess(way, 0.05 * (took_s + HOLDS_S) + LATE_M)
        there = vector(self.at.message.pose.position)
        time.sleep(0.3)
        self.assertTrue(self.is_at(there))  # the command is not repeated
        message.twist.linear.x = float("nan")
        self.velocity.publish(message)
        time.sleep(0.3)
        self.assertTrue(self.is_at(there))

    @in_one_of_several_tries
    def test_7_hold_stops_a_move_whose_goal_was_told(self):
        self.go((-0.02, 0.01, 0.05))
        goal = (0.03, 0.01, 0.05)
        del self.states[:]
        self.tell(self.move, goal)
        wait_until(lambda: self.at.message.pose.position.x > -0.01, LIMIT_S, "move")
        wait_until(lambda: length(plus(vector(self.goal.message.pose.position), goal, -1)) < PLACE_M, LIMIT_S, "goal_cp")
        self.hold.publish(Empty())
        self.waitBusy()
        self.wait_rest()
        wait_until(lambda: self.is_at(vector(self.setpoint.message.pose.position)) and
                   self.is_at(vector(self.goal.message.pose.position)), LIMIT_S, "setpoint and goal where the arm is")
        there = vector(self.at.message.pose.position)
        time.sleep(0.5)
        self.assertTrue(self.is_at(there))
        if there[0] >= goal[0] - 0.005:
            raise Late("the arm was there before it was held")

    def test_8_jaws_move_and_their_end_can_be_waited_for(self):
        self.go((0.01, 0.01, DEEP_M))
        self.jaws.publish(JointState(position=[0.5]))
        wait_until(lambda: list(self.jaw.message.position) == [0.5], LIMIT_S, "open jaws")
        angles = []
        watched = Latest("PSM1/jaw/setpoint_js", JointState, lambda m: angles.append(m.position[0]), queue_size=100)
        wait_until(lambda: angles, LIMIT_S, "angles of jaws at rest")
        del self.states[:]
        self.move_jaws.publish(JointState(position=[0.0]))
        self.waitBusy()
        self.wait_rest()
        watched.stop()
        self.assertTrue([a for a in angles if 0.1 < a < 0.4], angles)
        wait_until(lambda: (self.watch.value("left", "nodes_held") or 0) > 0, LIMIT_S, "tissue in the jaws")
        self.move_jaws.publish(JointState(position=[0.5]))
        wait_until(lambda: self.watch.value("left", "nodes_held") == 0, LIMIT_S, "open jaws")
        self.go((0.01, 0.01, 0.05))

    @in_one_of_several_tries
    def test_9_setpoints_come_so_often_that_clients_need_not_wait(self):
        counts = {}
        for name, latest in (("setpoint_cp", self.setpoint), ("goal_cp", self.goal), ("jaw/setpoint_js", self.jaw_setpoint)):
            before = latest.count
            time.sleep(2)
            counts[name] = (latest.count - before) / 2
        if min(counts.values()) <= FRESH_HZ:
            raise Late("%s Hz, wanted %g" % (counts, FRESH_HZ))

    def test_a_psm_has_joints_about_a_remote_centre(self):
        sent = {name: rospy.Publisher("PSM2/" + name, JointState, queue_size=1) for name in ("servo_jp", "move_jp")}
        poses = rospy.Publisher("PSM2/servo_cp", PoseStamped, queue_size=1)
        joints, setpoint = Latest("PSM2/measured_js", JointState), Latest("PSM2/setpoint_js", JointState, queue_size=100)
        states = []
        state = Latest("PSM2/operating_state", OperatingState, states.append, queue_size=10)
        pose = Latest("PSM2/measured_cp", PoseStamped)
        wait_until(lambda: all(p.get_num_connections() for p in (poses, *sent.values())), LIMIT_S, "PSM2")

        def has(latest, goal):
            return lambda: latest.message and length(plus(latest.message.position, goal, -1)) < JOINTS
        wait_until(has(joints, (0, 0, 0.1, 0, 0, 0)), LIMIT_S, "joints of the start")
        self.assertEqual(joints.message.name, ["yaw", "pitch", "insertion", "roll", "wrist_pitch", "wrist_yaw"])
        goal = (0.3, -0.2, 0.12, 0.5, -0.4, 0.2)
        sent["servo_jp"].publish(JointState(position=goal))
        wait_until(has(joints, goal), LIMIT_S, "joints that were servoed")
        wait_until(has(setpoint, goal), LIMIT_S, "setpoint_js")
        there = pose.message.pose
        goal = (-0.2, 0.1, 0.1, 0, 0, 0)
        del states[:]
        sent["move_jp"].publish(JointState(position=goal))
        wait_until(lambda: any(s.is_busy for s in states) and not states[-1].is_busy, LIMIT_S, "a move and its end")
        wait_until(has(joints, goal), LIMIT_S, "joints that were moved")
        above = PoseStamped()
        fill(above.pose, (0, 0, 0.1), JAWS)  # above the remote centre
        outside = "dropped_outside_workspace"
        for publisher, command, count in ((sent["servo_jp"], JointState(position=(0, 0, 0.3, 0, 0, 0)), outside),
                                          (sent["move_jp"], JointState(position=(0, 0, 0, 0, 0, 0)), outside),
                                          (poses, above, outside),
                                          (sent["servo_jp"], JointState(position=(*goal, 0)), "dropped_joint_count"),
                                          (sent["move_jp"], JointState(position=goal[:5]), "dropped_joint_count")):
            before = self.watch.value("right", count) or 0
            publisher.publish(command)
            wait_until(lambda: self.watch.value("right", count) == before + 1, LIMIT_S, "a refused command")
        self.assertTrue(has(joints, goal)())
        command = PoseStamped()
        command.pose = there
        poses.publish(command)
        wait_until(has(joints, (0.3, -0.2, 0.12, 0.5, -0.4, 0.2)), LIMIT_S, "joints of a pose")
        for latest in (joints, setpoint, state, pose):
            latest.stop()


if __name__ == "__main__":
    rostest.rosrun("viscera", "crtk_arm", CrtkArmTest, sys.argv)
