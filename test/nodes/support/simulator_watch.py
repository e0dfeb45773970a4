# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the rostests share: the simulator as seen through /diagnostics, and waiting with a limit."""
import threading
import time

import rospy
from diagnostic_msgs.msg import DiagnosticArray

READY_LIMIT_S = 60  # a software GPU on a busy machine
MADE_S = 0.05       # at most, from the moment of which diagnostics tell to their stamp


def wait_until(condition, limit_s, what):
    """Polls until condition() is true and returns what it gave; fails naming `what` after limit_s."""
    end = time.monotonic() + limit_s
    while time.monotonic() < end:
        found = condition()
        if found:
            return found
        time.sleep(0.05)
    raise AssertionError("no %s within %g s" % (what, limit_s))


class Latest:
    """Keeps the newest message of a topic and counts them."""

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
        """Waits until what is published from now on comes."""
        wait_until(lambda: self._subscriber.get_num_connections() > 0, limit_s, "publisher of " + self._subscriber.name)
        return self

    def stop(self):
        self._subscriber.unregister()


class SimulatorWatch:
    """The newest /diagnostics of a node, by its name in full without the first slash."""

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
        """A value of the diagnostics as a number, or as text where it is none; nothing if it is not there yet."""
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
        """Waits for diagnostics that tell of a moment after this call. ROS time must go on."""
        after_s = rospy.get_time() + MADE_S
        wait_until(lambda: self._stamp_s > after_s, 10, "diagnostics")
