#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""The panel viscera/Session in rviz: clicks on its buttons have the labelled effect on a simulator, and none without
one."""
import os
import subprocess
import sys
import time
import unittest

import rospy
import rostest
from rviz_screen import Screen, rviz
from simulator_watch import Latest, SimulatorWatch, wait_until
from std_srvs.srv import Trigger

from viscera.msg import TaskState, Tick

CONFIG = os.path.join(subprocess.check_output(["rospack", "find", "viscera"], text=True).strip(),
                      "config", "viscera_plugin.rviz")
LIMIT_S = 40  # software rendering on a busy machine
STILL = 5     # messages of `tick`, 20 ms apart while paused
# Icons on buttons, by their colours (src/rviz/panel_style.cpp)
RESET, PAUSE, RESUME, STEP = (230, 159, 0), (0, 114, 178), (0, 158, 115), (86, 180, 233)
RECORD, STOP, START = (213, 94, 0), (150, 60, 0), (0, 130, 90)
AWAY = (5, 5)     # no button is there
TASK_BOX_PX = 30  # from the icon on Start to the box of tasks, above it


class RvizSessionTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.ticks = []
        cls.task = Latest("task_state", TaskState)
        cls.tick = Latest("tick", Tick, lambda message: cls.ticks.append(message.tick))
        cls.watch = SimulatorWatch()
        cls.screen = Screen()
        cls.rviz = rviz(CONFIG, lambda: cls.screen.find(PAUSE))

    @classmethod
    def tearDownClass(cls):
        cls.rviz.end()
        cls.screen.end()

    def stands(self):
        return len(self.ticks) > STILL and len(set(self.ticks[-STILL:])) == 1

    def shown(self, color):
        self.assertIsNone(self.rviz.process.poll(), "rviz has ended: " + self.rviz.output)
        return self.screen.find(color)

    def places(self, colors):
        """Returns the exact positions of these icons. The pointer, which covers the icon that it has clicked, is moved
        away."""
        self.screen.do("mousemove", *AWAY)
        def steady():
            first = [self.shown(color) for color in colors]
            time.sleep(0.3)  # a button is redrawn after its release
            return first if None not in first and first == [self.shown(color) for color in colors] else None
        return wait_until(steady, LIMIT_S, "signs of all buttons")

    def click(self, color, condition, what):
        """Clicks the button with the icon of this colour, as soon as it is enabled."""
        place = wait_until(lambda: self.shown(color), LIMIT_S, "button: " + what)
        self.screen.click(*place)
        try:
            wait_until(condition, LIMIT_S, what)
        except AssertionError:
            self.screen.keep("no_%s.ppm" % what.replace(" ", "_"))
            raise

    def test_buttons(self):
        wait_until(lambda: self.ticks, LIMIT_S, "tick")
        self.click(PAUSE, self.stands, "pause")
        paused_at = self.ticks[-1]
        self.click(STEP, lambda: self.ticks[-1] == paused_at + 1, "step")
        self.click(RESET, lambda: self.ticks[-1] == 0, "reset")
        signs = (RESET, RESUME, STEP, START)
        before = self.places((*signs, RECORD))
        self.click(RECORD, lambda: self.watch.value("simulation", "recording"), "recording")
        file = self.watch.value("simulation", "recording")
        wait_until(lambda: self.shown(STOP), LIMIT_S, "button that stops the recording")
        self.screen.keep("session.ppm")
        self.assertEqual(self.places(signs), before[:-1], "buttons move as a recording begins")
        self.click(RESUME, lambda: self.ticks[-1] > 10, "resume")
        self.screen.click(*before[-1])  # the button is where it was, its icon next to another text
        wait_until(lambda: self.watch.value("simulation", "recording") == "", LIMIT_S, "end of the recording")
        self.assertGreater(os.path.getsize(file), 0)
        for is_recording in (True, False):  # the same key starts and stops it
            wait_until(lambda: self.shown(RECORD if is_recording else STOP), LIMIT_S, "button of the recording")
            self.screen.do("key", "alt+c")
            wait_until(lambda: bool(self.watch.value("simulation", "recording")) == is_recording, LIMIT_S, "Alt+C")

        # Changes by others are displayed: the button pauses again after another node has resumed.
        rospy.ServiceProxy("pause", Trigger)()
        wait_until(lambda: self.shown(RESUME), LIMIT_S, "pause of another node")

        rospy.ServiceProxy("resume", Trigger)()
        self.click(PAUSE, self.stands, "pause")
        subprocess.run(["rosnode", "kill", "/simulator"], check=True, capture_output=True)
        wait_until(lambda: not self.shown(STEP) and not self.shown(RESET), LIMIT_S, "buttons of no simulator")
        self.screen.keep("no_simulator.ppm")
        wait_until(lambda: self.shown(PAUSE), LIMIT_S, "simulator that was started again")  # respawned

        # A task of another scene loads its scene.
        x, y = wait_until(lambda: self.shown(START), LIMIT_S, "button: start")
        self.screen.click(x, y - TASK_BOX_PX)
        self.screen.do("key", "ctrl+a")
        self.screen.do("type", "gentle_lift")
        self.click(START, lambda: self.task.message and self.task.message.task == "gentle_lift", "task")
        self.assertEqual(self.task.message.state, TaskState.WAITING)
        wait_until(lambda: self.watch.value("simulation", "scene") == "practice_pad", LIMIT_S, "scene of the task")
        self.screen.keep("task.ppm")

        # During a call: a step of a simulator that is stopped.
        self.click(PAUSE, self.stands, "pause")
        self.screen.click(*wait_until(lambda: self.shown(STEP), LIMIT_S, "step"))
        self.rviz.process.send_signal(2)
        self.assertEqual(self.rviz.process.wait(LIMIT_S), 0, self.rviz.output)


if __name__ == "__main__":
    rospy.init_node("rviz_session_test")
    rostest.rosrun("viscera", "rviz_session", RvizSessionTest, sys.argv)
