# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""A program that a rostest starts and reads from."""
import os
import signal
import subprocess
import threading

import roslib.packages
from simulator_watch import wait_until

START_LIMIT_S = 30
END_LIMIT_S = 30


def node(name):
    """Returns the path of one of our nodes, without rosrun, which takes half a second to find it."""
    return roslib.packages.find_node("viscera", name)[0]


class Program:
    """A program with output that is read as it comes."""

    def __init__(self, arguments, uri=None):
        self.output = ""
        environment = dict(os.environ, ROSCONSOLE_STDOUT_LINE_BUFFERED="1", PYTHONUNBUFFERED="1")
        if uri:
            environment["ROS_MASTER_URI"] = uri
        self.process = subprocess.Popen(arguments, env=environment, text=True, stdout=subprocess.PIPE,
                                        stderr=subprocess.STDOUT, start_new_session=True)
        threading.Thread(target=self.read, daemon=True).start()

    def read(self):
        for line in self.process.stdout:
            self.output += line

    def said(self, text, count=1):
        wait_until(lambda: self.output.count(text) >= count, START_LIMIT_S, "'%s' in: %s" % (text, self.output))

    def end(self):
        if self.process.poll() is None:
            os.killpg(self.process.pid, signal.SIGINT)
            try:
                self.process.wait(END_LIMIT_S)
            except subprocess.TimeoutExpired:
                os.killpg(self.process.pid, signal.SIGKILL)
                self.process.wait()
