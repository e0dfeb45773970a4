#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Pages of sessions in Chromium, with OpenGL in software. Usage: page_in_browser_test.py VISCERA [--times PAGE.html]

Skips, with status 77, where Chromium is missing. With --times it opens a page and prints how long that takes and how
many pictures it draws per second.
"""
import base64
import pathlib
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from browser import SOFTWARE_GL, Browser, find_chromium  # noqa: E402

COMMAND = sys.argv[1] if len(sys.argv) > 1 else "viscera"
WIDTH, HEIGHT = 320, 240
SCENE = """name: pad
bodies:
  - {name: pad, source: box, box_size_m: [0.06, 0.04, 0.012], spacing_m: 0.002, fixed: [{shape: plane, point_m: [0, 0, -0.0045], normal: [0, 0, 1]}]}
styluses: [{name: left, idle: probe, button1: cut}]
cameras: [{name: eye, position_m: [0, -0.12, 0.1], width_px: 320, height_px: 240, rate_hz: 20, vertical_fov_deg: 35}]
"""
STROKES = """strokes:
  - stylus: left
    keys:
      - {t_s: 0, position_m: [-0.02, 0, 0.03], rotation_deg: [0, 30, 0]}
      - {t_s: 0.4, position_m: [-0.02, 0, 0.004], rotation_deg: [0, 30, 0], button1: true}
      - {t_s: 0.9, position_m: [0.02, 0, 0.002], rotation_deg: [0, 30, 0], button1: true}
"""
MOMENTS = (2, 9, 17)  # frames of the page: before the contact, at the beginning of the cut, near its end
LEAST_OVERLAP = 0.97  # intersection over union of the silhouettes; edges of one pixel all around are 2 %
LEAST_SSIM = 0.8
WINDOW = 8  # pixels of the windows of SSIM


def read_png(path):
    """Returns (channels, rows) of a PNG with 8 bits per channel."""
    data = path.read_bytes()
    width, height, depth, kind = struct.unpack(">IIBB", data[16:26])
    assert depth == 8
    channels, at, packed = {0: 1, 2: 3, 6: 4}[kind], 8, b""
    while at < len(data):
        length = struct.unpack(">I", data[at:at + 4])[0]
        if data[at + 4:at + 8] == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    raw, stride, rows, above = zlib.decompress(packed), channels * width, [], bytes(channels * width)
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            left, up = line[i - channels] if i >= channels else 0, above[i]
            corner = above[i - channels] if i >= channels else 0
            paeth = min((left, up, corner), key=lambda v: abs(left + up - corner - v))
            line[i] = (line[i] + (0, left, up, (left + up) // 2, paeth)[kind]) & 255
        rows.append(bytes(line))
        above = line
    return channels, rows


def grey(channels, rows):
    return [[(299 * row[channels * x] + 587 * row[channels * x + 1] + 114 * row[channels * x + 2]) / 1000 for x in range(len(row) // channels)]
            for row in rows]


def ssim(a, b):
    """Returns the mean structural similarity of two grey pictures over windows side by side (Wang et al. 2004)."""
    c1, c2, out = (0.01 * 255) ** 2, (0.03 * 255) ** 2, []
    for y in range(0, len(a) - WINDOW + 1, WINDOW):
        for x in range(0, len(a[0]) - WINDOW + 1, WINDOW):
            p = [v for row in a[y:y + WINDOW] for v in row[x:x + WINDOW]]
            q = [v for row in b[y:y + WINDOW] for v in row[x:x + WINDOW]]
            n = len(p)
            mp, mq = sum(p) / n, sum(q) / n
            vp, vq = sum((v - mp) ** 2 for v in p) / (n - 1), sum((v - mq) ** 2 for v in q) / (n - 1)
            cov = sum((v - mp) * (w - mq) for v, w in zip(p, q)) / (n - 1)
            out.append((2 * mp * mq + c1) * (2 * cov + c2) / ((mp * mp + mq * mq + c1) * (vp + vq + c2)))
    return sum(out) / len(out)


class PageInBrowser(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.made = tempfile.TemporaryDirectory()
        folder = cls.folder = pathlib.Path(cls.made.name)
        (folder / "scene.yaml").write_text(SCENE)
        (folder / "strokes.yaml").write_text(STROKES)
        subprocess.run([COMMAND, "run", folder / "scene.yaml", "--strokes", folder / "strokes.yaml", "--page", folder / "page.html",
                        "--out", folder / "out", "--labels"], check=True, stdout=subprocess.DEVNULL)
        cls.url = (folder / "page.html").as_uri()

    @classmethod
    def tearDownClass(cls):
        cls.made.cleanup()

    def picture(self, browser, frame):
        """Returns the page's picture of a frame, as read_png()."""
        browser.evaluate(f"player.show({frame})")
        answer = browser.evaluate("(() => { const p = player.pixels(); let s = ''; for (const b of p.rows) s += String.fromCharCode(b);"
                                  " return [p.width, p.height, btoa(s)]; })()")
        self.assertEqual(answer[:2], [WIDTH, HEIGHT])
        data = base64.b64decode(answer[2])
        return 4, [data[4 * WIDTH * y:4 * WIDTH * (y + 1)] for y in range(HEIGHT)]

    def test_shows_what_the_renderer_draws(self):
        with Browser(*SOFTWARE_GL) as browser:
            browser.resize(WIDTH, HEIGHT)
            self.assertEqual(browser.open(self.url + "#plain=1&camera=eye"), "ready")
            for frame in MOMENTS[::-1] + MOMENTS[:1]:  # backwards too
                mine, tick = self.picture(browser, frame), 3 * frame
                drawn = read_png(self.folder / "out" / "frames" / f"eye_{tick:06d}.png")
                labels = read_png(self.folder / "out" / "frames" / f"eye_labels_{tick:06d}.png")[1]
                both = either = 0
                for y in range(HEIGHT):
                    for x in range(WIDTH):
                        shown, there = max(mine[1][y][4 * x:4 * x + 3]) > 24, labels[y][x] != 0
                        both += shown and there
                        either += shown or there
                overlap, similar = both / either, ssim(grey(*mine), grey(*drawn))
                print(f"frame {frame}: overlap of silhouettes {overlap:.3f}, SSIM {similar:.3f}")
                self.assertGreater(overlap, LEAST_OVERLAP)
                self.assertGreater(similar, LEAST_SSIM)
            self.assertEqual([url for url in browser.requests() if not url.startswith(("file:", "data:", "about:", "blob:"))], [])

    def test_controls_work_on_a_desktop_and_on_a_phone(self):
        with Browser(*SOFTWARE_GL) as browser:
            for width, height, phone in ((1280, 800, False), (390, 844, True)):
                browser.resize(width, height, phone)
                self.assertEqual(browser.open(self.url), "ready")
                fits = browser.evaluate("[...document.querySelectorAll('footer, footer *, nav *, header')].every((e) => { const b ="
                                        " e.getBoundingClientRect(); return b.left >= 0 && b.right <= innerWidth && b.bottom <= innerHeight; })")
                self.assertTrue(fits, f"controls fit into {width} x {height}")
                self.assertEqual(browser.evaluate("document.title"), "pad: session of viscera")
                for key, frame in (("End", 18), ("ArrowLeft", 17), ("Home", 0), ("ArrowRight", 1)):
                    browser.evaluate(f"dispatchEvent(new KeyboardEvent('keydown', {{key: '{key}'}})), player.busy")
                    self.assertEqual(browser.evaluate("player.number"), frame, key)
                before = browser.evaluate("player.orbit.position.join()")
                for kind, x in (("mousePressed", 150), ("mouseMoved", 220), ("mouseReleased", 220)):
                    browser.call("Input.dispatchMouseEvent", type=kind, x=x, y=300, button="left", buttons=1, clickCount=1)
                self.assertNotEqual(browser.evaluate("player.orbit.position.join()"), before, "a drag turns the view")
                browser.evaluate("document.getElementById('legend-button').click()")
                self.assertIn("cut through", browser.evaluate("document.getElementById('legend').innerText"))
                browser.evaluate("player.play(true)")
                end = time.monotonic() + 60
                while browser.evaluate("player.playing || player.number < 18") and time.monotonic() < end:
                    time.sleep(0.1)
                self.assertEqual(browser.evaluate("player.number"), 18, "it plays to the end")

    def fault(self, browser):
        browser.resize(390, 844, True)
        self.assertEqual(browser.open(self.url), "failed")
        return browser.evaluate("document.getElementById('fault').innerText")

    def test_says_what_a_browser_lacks(self):
        with Browser("--disable-3d-apis") as browser:
            self.assertIn("needs WebGL 2", self.fault(browser))
        with Browser(*SOFTWARE_GL) as browser:
            browser.call("Page.addScriptToEvaluateOnNewDocument", source="delete window.DecompressionStream")
            self.assertIn("DecompressionStream is missing", self.fault(browser))


def print_times(page):
    """Prints how long a page takes to open, to scrub and to draw, in a window of 640 x 480."""
    with Browser(*SOFTWARE_GL) as browser:
        browser.resize(640, 480)
        began = time.monotonic()
        state = browser.open(pathlib.Path(page).resolve().as_uri())
        print(f"{state} after {time.monotonic() - began:.2f} s; {browser.evaluate('player.last + 1')} frames, "
              f"{browser.evaluate('player.frame.surface.shape.kinds.length')} triangles")
        script = """(async () => { const now = () => performance.now(), out = [];
            let from = now(); for (let i = 0; i < 60; ++i) { player.orbit.turn(0.02, 0); player.draw(); player.painter.gl.readPixels(0, 0, 1, 1, 6408, 5121, new Uint8Array(4)); }
            out.push(60000 / (now() - from)); const last = Math.min(player.last, 100);
            await player.show(0); from = now(); for (let i = 1; i <= last; ++i) { await player.show(i); player.draw(); player.painter.gl.readPixels(0, 0, 1, 1, 6408, 5121, new Uint8Array(4)); }
            out.push(1000 * last / (now() - from)); const jumps = [];
            for (let i = 0; i < 12; ++i) { from = now(); await player.show(Math.floor(player.last * ((i * 0.618) % 1))); jumps.push(now() - from); }
            out.push(Math.max(...jumps)); return out; })()"""
        turned, played, jump = browser.evaluate(script)
        print(f"pictures per second: {turned:.0f} while turning, {played:.0f} while playing; longest of 12 jumps in time: {jump:.0f} ms")


if __name__ == "__main__":
    if not find_chromium():
        print("chromium is missing; scripts/install_packages browser installs it")
        sys.exit(77)
    if len(sys.argv) > 3 and sys.argv[2] == "--times":
        print_times(sys.argv[3])
    else:
        unittest.main(argv=sys.argv[:1])
