#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""page_server beside a simulator: what a browser would receive, what is refused, and how much that costs.

VISCERA_WEB_MESSAGES is the number of random messages, 100,000 in the long form. VISCERA_BROWSER opens the page in
Chromium, and VISCERA_PICTURES names a folder for pictures of it.
"""
import base64
import json
import os
import pathlib
import random
import re
import struct
import sys
import time
import unittest

import numpy
import rospy
import rostest
from drivers import Crtk
from program import Program, node
from simulator_watch import Latest, SimulatorWatch, wait_until
from viscera.msg import SurfaceTopology, SurfaceVertices
from web_page import BYTES, Closed, Page, WebSocket, ask

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "cli"))
from browser import SOFTWARE_GL, Browser, find_chromium  # noqa: E402

MESSAGES = int(os.environ.get("VISCERA_WEB_MESSAGES", 1500))
MOST_GROWTH_KB = 8192         # of memory over the messages: pages of the allocator, not one block per message
LATENCY_GOAL_S = 0.1          # from a pose to a page on this machine; printed
LATENCY_LIMIT_S = 1.0         # of the fastest third, for any slow and busy machine
ROUNDING_M = 1e-7             # of float32, some cm from the origin
IN_FRONT, INSIDE = (0.0, -0.09, -0.02), (0.0, -0.05, -0.02)
MOVED_M = 1e-3                # of a vertex that was pushed
KNOWN = ("shown", "call", "reset", "pause", "start_task", "task", "state")


def memory_kb(pid):
    with open("/proc/%d/statm" % pid) as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") // 1024


def random_message(dice):
    """Returns bytes of a message that is no valid one of a page, but may look like one."""
    kind = dice.randrange(4)
    if kind == 0:
        return bytes(dice.randrange(256) for _ in range(dice.randrange(200)))
    if kind == 1:
        return ("{" * dice.randrange(1, 2000)).encode()
    if kind == 2:
        return ('{"%s": %s}' % (dice.choice(KNOWN), dice.choice(("-1", "1e99", "null", '"' + "x" * dice.randrange(2000) + '"', "[]", str(dice.randrange(2**40)))))).encode()
    return ('{"call": "%s", "task": %d}' % (dice.choice(KNOWN), dice.randrange(9))).encode()


class PageServerTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("page_server_test")
        cls.watch = SimulatorWatch()
        cls.watch.wait_ready()
        cls.stylus = Crtk("left")
        cls.servers = {name: Program([node("page_server"), "_port:=0", "__name:=" + name, *more])
                       for name, more in (("reader", ["_max_clients:=3"]), ("teacher", ["_control:=true"]))}
        cls.port = {}
        for name, program in cls.servers.items():
            program.said("is shown at http://127.0.0.1:")
            cls.port[name] = int(re.search(r"127\.0\.0\.1:(\d+)/", program.output).group(1))

    @classmethod
    def tearDownClass(cls):
        cls.stylus.end()
        for program in cls.servers.values():
            program.end()

    def setUp(self):
        self.pages = []

    def tearDown(self):
        for page in self.pages:
            page.close()

    def page(self, name="reader", **options):
        page = Page(self.port[name], **options)
        self.pages.append(page)
        return page

    def get(self, target="/", host=None, method="GET", more=""):
        port = self.port["reader"]
        return ask(port, ("%s %s HTTP/1.1\r\nHost: %s\r\n%s\r\n" % (method, target, host or "127.0.0.1:%d" % port, more)).encode())

    def wait_frame(self, page, condition, what):
        """Returns the first decoded frame for which condition(frame) is true."""
        def check():
            frame = page.decode(*page.frame())
            return frame if condition(frame) else None
        return wait_until(check, 30, what)

    def test_a_place_where_it_cannot_listen_ends_it(self):
        for parameter, words in (("_port:=%d" % self.port["reader"], "choose ~address and ~port"), ("_port:=70000", "~port"), ("_address:=host.example", "no IP address")):
            program = Program([node("page_server"), "__name:=misplaced", "_port:=0", parameter])
            self.assertEqual(program.process.wait(30), 1, parameter)
            program.said(words)
            rospy.delete_param("/misplaced")

    def test_serves_one_page_that_loads_nothing_else(self):
        status, answer = self.get()
        head, text = answer.split("\r\n\r\n", 1)
        self.assertEqual(status, 200)
        self.assertIn("frame-ancestors 'none'", head)
        self.assertIn("default-src 'none'", text)
        self.assertIn("class Live extends View", text)
        for other in ("http:", "https:", " src=", "import "):
            self.assertNotIn(other, text)

    def test_requests_that_are_not_the_pages_are_refused(self):
        port = self.port["reader"]
        for status, options in ((404, {"target": "/etc/passwd"}), (405, {"method": "POST"}), (403, {"host": "evil.example"}),
                                (403, {"host": "127.0.0.1.evil.example:%d" % port}), (403, {"host": "localhost\r\nHost: localhost"}),
                                (200, {"host": "localhost:%d" % port}), (200, {"host": "[::1]:%d" % port}), (400, {"more": "X: " + "x" * 9000 + "\r\n"})):
            self.assertEqual(self.get(**options)[0], status, options)
        self.assertEqual(ask(port, b"\x16\x03\x01 no HTTP\r\n\r\n")[0], 400)
        for origin in ("http://evil.example", "https://127.0.0.1:%d" % port, "http://127.0.0.1:%d" % (port - 1), "null"):
            with self.assertRaises(ConnectionRefusedError, msg=origin) as refused:
                WebSocket(port, origin=origin)
            self.assertEqual(refused.exception.args[0], 403)
        WebSocket(port, origin="http://127.0.0.1:%d" % port).close()
        wait_until(lambda: re.search(r"refused \d+ requests and messages so far", self.servers["reader"].output), 20, "a warning")

    def test_frames_agree_with_the_topics(self):
        sent = {}
        vertices = Latest("surface", SurfaceVertices, lambda m: sent.update({m.tick: m}), queue_size=100)
        topology = Latest("surface_topology", SurfaceTopology)
        self.stylus.at = IN_FRONT
        page = self.page()
        # Another test may have cut: after its reset, the first frames of a page may still be those of before.
        rest = self.wait_frame(page, lambda frame: frame["tools"] and not any(t[3] for t in frame["triangles"]), "a whole block and a tool")
        self.stylus.at = INSIDE
        self.wait_frame(page, lambda f: numpy.abs(f["positions"] - rest["positions"]).max() > MOVED_M and len(f["forces"]) and f["forces"][0][1] < -0.01,
                        "pushed tissue and its force")
        header, data = page.frame()
        wait_until(lambda: header["tick"] in sent or max(sent, default=0) > header["tick"], 10, "the surface of the frame's tick")
        frame, message = page.decode(header, data), sent[header["tick"]]
        used = sorted({v for t in frame["triangles"] for v in t[:3]})
        there = numpy.array(message.positions_m).reshape(-1, 3)
        self.assertEqual(there.shape, frame["positions"].shape)
        self.assertLess(numpy.abs(there - frame["positions"])[used].max(), frame["step"] / 2 + ROUNDING_M)
        triangles = numpy.array(topology.message.triangles).reshape(-1, 3)
        self.assertEqual(sorted(map(tuple, triangles.tolist())), sorted(t[:3] for t in frame["triangles"]))
        page.until(lambda: page.state["bodies"] and page.state["styluses"])
        self.assertEqual([body["name"] for body in page.state["bodies"]], ["block"])
        self.assertIn("camera", [camera["name"] for camera in page.state["cameras"]])
        self.assertEqual(page.state["styluses"], ["left", "right"])
        vertices.stop()
        topology.stop()

    def test_a_cut_is_followed(self):
        self.stylus.at = (-0.06, -0.055, -0.02)
        page = self.page()
        before = self.wait_frame(page, lambda frame: frame["tools"], "a frame with a tool")
        self.stylus.press(2, False)
        time.sleep(0.5)
        self.stylus.press(2, True)
        for i in range(60):
            self.stylus.at = (-0.06 + 0.002 * i, -0.055, -0.02)
            page.frame()
        after = self.wait_frame(page, lambda frame: any(t[3] for t in frame["triangles"]), "walls of a cut")
        self.assertGreater(len(after["triangles"]), len(before["triangles"]))
        self.stylus.press(2, False)
        self.stylus.at = IN_FRONT

    def test_a_pose_is_soon_on_the_page(self):
        poses = Crtk("right")  # at None: it sends what we tell it
        wait_until(lambda: poses.poses.get_num_connections() > 0, 20, "a simulator that listens to it")
        page, took = self.page(), []
        page.frame()
        for i in range(40):
            at = (0.03, -0.09 - 1e-4 * i, -0.021)
            began = time.monotonic()
            poses.tell(at, ((1, 0, 0), (0, 1, 0), (0, 0, 1)))
            while time.monotonic() < began + 2:
                if struct.pack("<3f", *at) in page.frame(limit_s=2)[1]:
                    took.append(time.monotonic() - began)
                    break
        took = sorted(took[5:])  # the tool appears
        print("pose to page: %.0f ms in the median, %.0f at most; goal %.0f" % (1e3 * took[len(took) // 2], 1e3 * took[-1], 1e3 * LATENCY_GOAL_S))
        self.assertGreater(len(took), 20)
        self.assertLess(took[len(took) // 3], LATENCY_LIMIT_S)

    def test_a_page_that_does_not_draw_gets_no_more_frames(self):
        self.stylus.at = IN_FRONT
        page = self.page()
        first = [page.frame(shown=False)[0]["frame"] for _ in range(2)]
        for i in range(30):
            self.stylus.at = (0.0, -0.09, -0.02 + 1e-3 * (i % 2))
            time.sleep(0.05)
        with self.assertRaises(TimeoutError):
            page.frame(shown=False, limit_s=1.5)
        page.socket.send('{"shown": %d}' % first[1])
        self.assertGreater(page.frame()[0]["frame"], first[1] + 5, "the newest frame, not the next one")

    def test_a_read_only_page_cannot_call(self):
        tick = self.watch.value("simulation", "tick")
        page = self.page()
        page.call("reset")
        with self.assertRaisesRegex(Closed, "1008 .*read-only"):
            page.until(lambda: False)
        self.watch.wait_news()
        self.assertGreater(self.watch.value("simulation", "tick"), tick)

    def test_buttons_call_the_services(self):
        page = self.page("teacher")
        page.frame()
        self.stylus.at = IN_FRONT
        for service, answer in (("pause", "/pause: "), ("resume", "/resume: "), ("reset", "/reset: "), ("start_task", "refused")):
            page.call(service, **({"task": "no_such_task"} if service == "start_task" else {}))
            page.until(lambda: any(answer in told and "..." not in told for told in page.answers))
        self.assertIn("incision", page.state["tasks"])
        with self.assertRaisesRegex(Closed, "1008"):
            page.call("load_scene")
            page.until(lambda: False)

    def test_the_layout_of_foxglove_names_topics_of_the_simulator(self):
        layout = (pathlib.Path(__file__).resolve().parents[3] / "config/foxglove_layout.json").read_text()
        panels = json.loads(layout)["configById"]
        named = {name.split(".")[0] for name in re.findall(r'"(/[^"]*)"', layout)}
        self.assertLessEqual({"/surface_marker", "/scene_markers", "/camera/image_raw", "/diagnostics"}, named)
        self.assertEqual(named - {topic for topic, _ in rospy.get_published_topics()}, set())
        self.assertEqual(sorted(panels), sorted(re.findall(r'"(?:first|second)": "([^"]*)"', layout)), "every panel has a place")

    def test_no_more_pages_than_allowed(self):
        for _ in range(3):
            self.page()
        with self.assertRaises(ConnectionRefusedError) as refused:
            WebSocket(self.port["reader"])
        self.assertEqual(refused.exception.args[0], 503)

    def test_without_a_page_nothing_is_subscribed(self):
        master = rospy.get_master()

        def subscribers():
            found = [names for topic, names in master.getSystemState()[2][1] if topic == "/surface"]
            return [name for name in sum(found, []) if name in ("/reader", "/teacher")]
        page = self.page()
        page.frame()
        wait_until(lambda: subscribers() == ["/reader"], 20, "one subscription")
        page.close()
        wait_until(lambda: not subscribers(), 20, "end of the subscription")

    @unittest.skipUnless(os.environ.get("VISCERA_BROWSER") and find_chromium(), "the long form, with Chromium")
    def test_a_browser_shows_it_on_a_desktop_and_on_a_phone(self):
        folder = os.environ.get("VISCERA_PICTURES")
        self.stylus.at = INSIDE
        with Browser(*SOFTWARE_GL) as browser:
            for name, width, height, phone in (("desktop", 1280, 800, False), ("phone", 390, 844, True)):
                browser.resize(width, height, phone)
                self.assertEqual(browser.open("http://127.0.0.1:%d/" % self.port["teacher"]), "ready")
                fits = browser.evaluate("[...document.querySelectorAll('footer, footer *, nav *, header')].every((e) => { const b ="
                                        " e.getBoundingClientRect(); return b.left >= 0 && b.right <= innerWidth && b.bottom <= innerHeight; })")
                self.assertTrue(fits, "controls fit into %d x %d" % (width, height))
                first = browser.evaluate("live.frame.header.frame")
                self.stylus.at = IN_FRONT if phone else INSIDE
                wait_until(lambda: browser.evaluate("live.frame.header.frame") > first + 5, 60, "five more pictures")
                bright = browser.evaluate("(() => { const p = live.pixels(); let n = 0; for (let i = 0; i < p.rows.length; i += 4) n += p.rows[i] > 60; return n / (p.width * p.height); })()")
                self.assertGreater(bright, 0.02, "tissue is drawn")
                browser.evaluate("document.getElementById('legend-button').click()")
                self.assertIn("block", browser.evaluate("document.getElementById('legend').innerText"))
                browser.evaluate("document.getElementById('legend-button').click()")
                browser.evaluate("document.getElementById('reset').click()")
                wait_until(lambda: "reset: " in browser.evaluate("document.getElementById('answer').textContent"), 30, "the answer of reset")
                print(name, browser.evaluate("document.getElementById('status').textContent"), "|", browser.evaluate("document.getElementById('rate').textContent"))
                if folder:
                    (pathlib.Path(folder) / (name + ".png")).write_bytes(base64.b64decode(browser.call("Page.captureScreenshot")["data"]))
            own = ("http://127.0.0.1:", "ws://127.0.0.1:", "data:", "about:", "blob:")
            self.assertEqual([url for url in browser.requests() if not url.startswith(own)], [])

    def test_random_messages_end_connections_and_leave_nothing_behind(self):
        dice, port, server = random.Random(62), self.port["teacher"], self.servers["teacher"]
        before = None
        for i in range(MESSAGES):
            if i == MESSAGES // 5:
                before = memory_kb(server.process.pid)
            try:
                connection = WebSocket(port)
            except ConnectionRefusedError as refused:  # the last ones are not gone yet
                self.assertEqual(refused.args[0], 503)
                time.sleep(0.05)
                continue
            try:
                connection.send(random_message(dice), dice.choice((1, 2, 0, 3, 9)) if dice.random() < 0.2 else 1)
                if i % 100 == 0:
                    with self.assertRaises((Closed, ConnectionError)):
                        connection.send(b"x" * 5000, BYTES)
                        while True:
                            connection.receive()
            except ConnectionError:
                pass
            connection.close()
        grown = memory_kb(server.process.pid) - before
        print("%d random messages: memory grew by %d kB" % (MESSAGES, grown))
        self.assertIsNone(server.process.poll())
        self.assertLess(grown, MOST_GROWTH_KB)
        self.page("teacher").frame()


if __name__ == "__main__":
    rostest.rosrun("viscera", "page_server_test", PageServerTest, sys.argv)
