#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""What a plain user does with the installed packages: as_a_user.py FOLDER, to which rviz.png is written.

Runs a scene by the command and in Python, whose states must be the same; launches a session, and looks at it in rviz.
"""
import json
import mmap
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import time
import zlib

import numpy
import rosgraph

WIDTH, HEIGHT = 1280, 900
SECONDS = "0.1"
START_LIMIT_S = 120  # software rendering on a busy machine
TISSUE_PIXELS = 3000  # of the scene's, where the heart is seen
CHANGED_PIXELS = 100  # between two pictures of a heart that moves
REMOVED = {key for key in os.environ if key.startswith("ROS_") or key in ("PYTHONPATH", "CMAKE_PREFIX_PATH")}


def command_hash():
    """Returns the state hash of the command, and prints what it says of the machine."""
    ran = subprocess.run(["viscera", "run", "heart", "--no-view", "--seconds", SECONDS], capture_output=True, text=True, check=True)
    report = json.loads(ran.stdout.strip().split("\n")[-1])
    print(f"viscera run heart: {report['backend']}, state_hash {report['state_hash']}")
    return report["state_hash"]


def module_hash():
    """Returns the state hash of the Python module after the same time."""
    import viscera
    assert viscera.__file__.startswith("/usr/lib/python3/dist-packages/"), viscera.__file__
    with viscera.Session(viscera.Scene("heart")) as session:
        session.step(n=round(float(SECONDS) / session.tick_s))
        print(f"import viscera {viscera.__version__}: state_hash {session.hash}")
        return session.hash


def wait_until(condition, what):
    """Waits until condition() is true, and returns it. Fails after START_LIMIT_S."""
    end = time.monotonic() + START_LIMIT_S
    while time.monotonic() < end:
        try:
            value = condition()
        except (rosgraph.MasterException, OSError):  # no master yet
            value = None
        if value:
            return value
        time.sleep(0.2)
    raise AssertionError(f"not within {START_LIMIT_S} s: {what}")


def subscribers(topic):
    return dict(rosgraph.Master("/as_a_user").getSystemState()[1]).get(topic, [])


def publishers(topic):
    return dict(rosgraph.Master("/as_a_user").getSystemState()[0]).get(topic, [])


class Screen:
    """Xvfb, which keeps what it shows in a file."""

    def __init__(self):
        self.folder = tempfile.mkdtemp()
        self.process = subprocess.Popen(["Xvfb", ":7", "-screen", "0", f"{WIDTH}x{HEIGHT}x24", "-fbdir", self.folder],
                                        stderr=subprocess.DEVNULL)
        self.file = pathlib.Path(self.folder, "Xvfb_screen0")

    def picture(self):
        """Returns red, green, blue, 0..255: [height, width, 3]."""
        with open(self.file, "rb") as file:
            dump = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)  # xwd: its header has big-endian words
            words = struct.unpack(">25I", dump[:100])
            pixels = numpy.frombuffer(dump[:], numpy.uint8, HEIGHT * words[12], words[0] + 12 * words[19])
        return pixels.reshape(HEIGHT, words[12] // 4, 4)[:, :WIDTH, 2::-1].astype(int)


def write_png(path, picture):
    rows = b"".join(b"\0" + row.tobytes() for row in picture.astype(numpy.uint8))
    chunk = lambda name, data: struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    pathlib.Path(path).write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", WIDTH, HEIGHT, 8, 2, 0, 0, 0)) +
                                   chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def tissue(picture):
    """Returns which pixels are of tissue: redder than anything else in rviz's window."""
    return (picture[..., 0] > 1.5 * picture[..., 1]) & (picture[..., 0] > 60)


def watch_in_rviz(folder):
    """Starts rviz beside a session, and waits for a heart that moves."""
    screen = Screen()
    time.sleep(2)
    begin = time.monotonic()
    look = dict(os.environ, DISPLAY=":7", QT_X11_NO_MITSHM="1")
    with open(folder / "rviz.log", "w") as log:
        rviz = subprocess.Popen(["rviz", "-d", "/usr/share/viscera/config/viscera_plugin.rviz", "-f", "tissue"], env=look,
                                stdout=log, stderr=subprocess.STDOUT)
    try:
        wait_until(lambda: any("rviz" in name for name in subscribers("/surface")), "rviz subscribes to /surface by the plugin")
        wait_until(lambda: tissue(screen.picture()).sum() > TISSUE_PIXELS, "a heart in rviz's window")
        first = screen.picture()
        wait_until(lambda: (tissue(first) != tissue(screen.picture())).sum() > CHANGED_PIXELS, "a heart that moves")
        print(f"rviz shows a moving heart {time.monotonic() - begin:.0f} s after its start")
        write_png(folder / "rviz.png", screen.picture())
    except AssertionError:
        write_png(folder / "rviz.png", screen.picture())
        print((folder / "rviz.log").read_text())
        raise
    finally:
        for process in (rviz, screen.process):
            process.terminate()
            process.wait()
    assert "failed to load" not in (folder / "rviz.log").read_text(), (folder / "rviz.log").read_text()


def main():
    folder = pathlib.Path(sys.argv[1])
    for key in REMOVED:
        del os.environ[key]
    assert command_hash() == module_hash()
    begin = time.monotonic()
    with open(folder / "launch.log", "w") as log:
        session = subprocess.Popen(["roslaunch", "viscera", "training.launch", "strokes:=demo", "loop:=true"], stdout=log,
                                   stderr=subprocess.STDOUT)
    try:
        wait_until(lambda: publishers("/surface"), "the simulator publishes /surface")
        wait_until(lambda: "playing" in (folder / "launch.log").read_text(), "strokes are played")
        print(f"roslaunch viscera training.launch strokes:=demo: plays {time.monotonic() - begin:.0f} s after its start")
        told = subprocess.run(["/usr/lib/viscera/status", "_once:=true"], capture_output=True, text=True, timeout=30)
        assert "running" in told.stdout, told.stdout + told.stderr
        print(told.stdout)
        if (pathlib.Path.home() / "catkin_ws/devel").exists():
            ran = subprocess.run([str(pathlib.Path.home() / "catkin_ws/devel/lib/viscera_user/watcher")], capture_output=True,
                                 text=True, timeout=60)
            assert ran.returncode == 0, ran.stdout + ran.stderr
            print("a catkin package's node with messages of viscera:", ran.stdout.strip())
        else:
            watch_in_rviz(folder)
    except AssertionError:
        print((folder / "launch.log").read_text())
        raise
    finally:
        session.terminate()
        session.wait()


if __name__ == "__main__":
    main()
