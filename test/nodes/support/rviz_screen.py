# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""rviz on a display without a screen, and its image, from the file in which Xvfb keeps its screen."""
import mmap
import os
import re
import struct
import subprocess
import tempfile

import numpy
from program import Program
from simulator_watch import wait_until

WIDTH, HEIGHT = 1280, 900
VIEW = slice(70, 760), slice(370, 840)  # rows and columns of the scene, in config/viscera_plugin.rviz
END_LIMIT_S = 10
START_LIMIT_S = 40  # software rendering on a busy machine
MOUSE_SIGN = (240, 228, 66)  # of the button of viscera/Mouse, in the toolbar
BALL_PIXELS = 10000
BACKGROUND = (32, 36, 40)  # of the scene, in config/viscera_plugin.rviz
SIGN_PIXELS = 40  # of the icons of 16 by 16 pixels, without their smooth edges

# An rviz without panels, with only the display, and its largest frame rate.
ALONE = """Visualization Manager:
  Displays:
    - {Class: viscera/Surface, Name: Ball, Enabled: true, Surface topic: surface, Color by: %s, Value: true}
%s  Global Options: {Background Color: 32; 36; 40, Fixed Frame: tissue, Frame Rate: %d}
  Views:
    Current: {Class: rviz/Orbit, Distance: 0.14, Near Clip Distance: 0.01, Pitch: 0.3, Yaw: 4.9, Focal Point: {X: 0, Y: 0, Z: 0}}
"""
IMAGE = "    - {Class: rviz/Image, Name: Image, Enabled: true, Image Topic: /none, Value: true}\n"
# Environment of an rviz that reports how often it draws surfaces.
DEBUG = {"ROSCONSOLE_CONFIG_FILE": os.path.join(os.path.dirname(os.path.abspath(__file__)), "rviz_debug.conf")}


def alone(screen, rate_hz, *options, color_by="sent", others=""):
    """Starts rviz, full screen with only the display, or in a window with other displays after it. Returns its Program,
    which prints once a second how often it has drawn."""
    config = os.path.join(screen.folder.name, "alone.rviz")
    with open(config, "w") as file:
        file.write(ALONE % (color_by, others, rate_hz))
    os.environ.update(DEBUG)
    return Program(["rosrun", "rviz", "rviz", "-d", config, "-f", "tissue", *([] if others else ["--fullscreen"]), *options])


def drawn_hz(output):
    """Returns the rates of all seconds that an rviz reports with DEBUG."""
    return [float(hz) for hz in re.findall(r": ([0-9.]+) Hz, ", output)]


class Screen:
    """An Xvfb with a free display number."""

    def __init__(self, width=WIDTH, height=HEIGHT):
        self.width, self.height = width, height
        self.folder = tempfile.TemporaryDirectory()
        told, tells = os.pipe()
        self.process = subprocess.Popen(["Xvfb", "-displayfd", str(tells), "-screen", "0", "%dx%dx24" % (width, height),
                                         "-fbdir", self.folder.name, "-nolisten", "tcp"], pass_fds=[tells],
                                        stderr=subprocess.DEVNULL)
        os.close(tells)
        with os.fdopen(told) as reader:
            self.display = ":" + reader.readline().strip()
        self.environment = {"DISPLAY": self.display, "LIBGL_ALWAYS_SOFTWARE": "1", "QT_X11_NO_MITSHM": "1",
                            "QT_QPA_PLATFORM": "xcb", "QT_LOGGING_RULES": "*=false"}
        os.environ.update(self.environment)

    def pixels(self):
        """Returns [height, width, 4] blue, green, red and nothing, as bytes."""
        with open(os.path.join(self.folder.name, "Xvfb_screen0"), "rb") as file:
            dump = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)  # xwd, with a header of big-endian words
            words = struct.unpack(">25I", dump[:100])
            begin, line, colors = words[0], words[12], words[19]
            pixels = numpy.frombuffer(dump[:], numpy.uint8, self.height * line, begin + 12 * colors)
        return pixels.reshape(self.height, line // 4, 4)[:, :self.width]

    def picture(self, part=(slice(None), slice(None))):
        """Returns [height, width, 3] red, green, blue, 0..255, of a part of the rows and columns."""
        return self.pixels()[part][:, :, 2::-1].astype(int)

    def save(self, path):
        """Writes a PPM file."""
        with open(path, "wb") as file:
            file.write(b"P6 %d %d 255\n" % (self.width, self.height) + self.picture().astype(numpy.uint8).tobytes())

    def keep(self, name):
        """Saves the image in the folder VISCERA_PICTURES, if it is set."""
        if "VISCERA_PICTURES" in os.environ:
            self.save(os.path.join(os.environ["VISCERA_PICTURES"], name))

    def find(self, color, least=SIGN_PIXELS):
        """Returns the centre (x, y) of the pixels of exactly this colour; None if there are fewer than in an icon of a
        button."""
        red, green, blue = color
        words = numpy.ascontiguousarray(self.pixels()).view("<u4")[:, :, 0]  # compared as one number: this is polled
        rows, columns = numpy.nonzero(words & 0xffffff == red << 16 | green << 8 | blue)
        return (int(numpy.median(columns)), int(numpy.median(rows))) if len(rows) >= least else None

    def ball(self):
        """Returns the centre (x, y) of the red pixels in the scene, such as the ball of stand_in_simulator.py; None if
        there are none."""
        picture = self.picture(VIEW)
        rows, columns = ((picture[:, :, 0] > 1.5 * picture[:, :, 1]) & (picture[:, :, 0] > 40)).nonzero()
        if len(rows) < BALL_PIXELS:
            return None
        return VIEW[1].start + int(columns.mean()), VIEW[0].start + int(rows.mean())

    def draws(self):
        """Returns whether rviz has drawn its scene, of which most is background."""
        return (self.picture()[VIEW] == BACKGROUND).all(axis=2).mean() > 0.5

    def click(self, x, y, button=1):
        self.do("mousemove", x, y)
        self.do("click", button)

    def do(self, *arguments):
        return subprocess.run(["xdotool", *map(str, arguments)], check=True, capture_output=True, text=True).stdout

    def end(self):
        self.process.terminate()
        try:
            self.process.wait(END_LIMIT_S)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.folder.cleanup()


def rviz(config, shows, rate_hz=10):
    """Starts rviz with a frame rate and waits until shows() is true. Tests see what is drawn, not how often, and at the
    30 Hz of the configuration a software renderer takes a whole processor. Sometimes it stopped drawing (once in ten
    starts next to other programs), and sometimes rviz ended at its start with a corrupt heap (once in some tens,
    docs/rviz.md). Then it is restarted, and the output says so. Three failures in a row are an error."""
    folder = tempfile.TemporaryDirectory()
    slower = os.path.join(folder.name, os.path.basename(config))
    with open(config) as shipped, open(slower, "w") as file:
        file.write(re.sub("Frame Rate: [0-9]+", "Frame Rate: %d" % rate_hz, shipped.read()))
    for tries_left in (2, 1, 0):
        program = Program(["rosrun", "rviz", "rviz", "-d", slower, "-f", "tissue"])
        program.folder = folder  # is there for as long as rviz
        ended = lambda: program.process.poll() is not None
        try:
            wait_until(lambda: ended() or shows(), START_LIMIT_S, "sign of rviz")
            if ended():
                raise AssertionError("rviz has ended with %s: %s" % (program.process.poll(), program.output))
            return program
        except AssertionError:
            if tries_left == 0:
                raise
        print("rviz is begun again, it ended with %s: %s" % (program.process.poll(), program.output), flush=True)
        program.end()
