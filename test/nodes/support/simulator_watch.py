# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Shared code of the rostests: the simulator by its /diagnostics, and waiting with a limit."""
import threading
import time

import rospy
from diagnostic_msgs.msg import DiagnosticArray

READY_LIMIT_S = 60  # a software GPU on a busy machine
MADE_S = 0.05       # largest delay from the reported moment of diagnostics to their stamp


def wait_until(condition, limit_s, what):
    """Polls until condition() is true and returns its value; fails after limit_s and names `what`."""
    end = time.monotonic() + limit_s
    while time.monotonic() < end:
        found = condition()
        if found:
            return found
        time.sleep(0.05)
    raise AssertionError("no %s within %g s" % (what, limit_s))


class Latest:
    """Keeps the newest message of a topic and counts messages."""

    def __init__(self, topic, message_type, on_message=None, queue_size=1):
        self.message = None
        self.count = 0
        self._on_message = on_message
        self._subscriber = rospy.Subscriber(topic, message_type, self._receive, queue_size=queue_size,
                                            buff_size=2**24)

    def _receive(self, message):
        self.message = message
        self.count += 1
        if self._on_message:
            self._on_message(message)

    def connect(self, limit_s=20):
        """Waits until messages that are published from now on arrive."""
        wait_until(lambda: self._subscriber.get_num_connections() > 0, limit_s, "publisher of " + self._subscriber.name)
        return self

    def stop(self):
        self._subscriber.unregister()


class SimulatorWatch:
    """The newest /diagnostics of a node, by its full name without the first slash."""

    def __init__(self, node="simulator"):
        self._node = node
        self._lock = threading.Lock()
        self._statuses = {}
        self._stamp_s = 0.0
        self._subscriber = rospy.Subscriber("/diagnostics", DiagnosticArray, self._receive, queue_size=10)

    def _receive(self, array):
        with self._lock:
            for status in array.status:
                self._statuses[status.name] = status
                if status.name.startswith(self._node + ": "):
                    self._stamp_s = array.header.stamp.to_sec()

    def status(self, part):
        with self._lock:
            return self._statuses.get(self._node + ": " + part)

    def value(self, part, key):
        """Returns a value of the diagnostics as a number, or as text if it is not one; None if it is not there yet."""
        status = self.status(part)
        for item in status.values if status else []:
            if item.key == key:
                try:
                    return float(item.value)
                except ValueError:
                    return item.value
        return None

    def wait_ready(self):
        wait_until(lambda: self.value("simulation", "tick"), READY_LIMIT_S, "first tick")

    def wait_news(self):
        """Waits for diagnostics of a moment after this call. ROS time must advance."""
        after_s = rospy.get_time() + MADE_S
        wait_until(lambda: self._stamp_s > after_s, 10, "diagnostics")
