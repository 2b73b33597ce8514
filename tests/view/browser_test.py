#!/usr/bin/env python3
"""The page of hemirad view in headless Chromium. HEMIRAD names the program."""
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import urllib.parse

import view_test

FLAGS = ("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
         "--disable-background-networking", "--disable-component-update", "--disable-sync",
         "--hide-scrollbars", "--use-gl=angle", "--use-angle=swiftshader",
         "--enable-unsafe-swiftshader", "--virtual-time-budget=20000", "--window-size=640,480")


class Browsed:
    def browse(self, output, *choices):
        """What Chromium says of the page, chosen by `choices` after its #."""
        with tempfile.TemporaryDirectory() as profile:
            url = (self.folder / "page.html").as_uri() + "#" + "&".join(choices)
            return subprocess.run(["chromium", *FLAGS, f"--user-data-dir={profile}", output, url],
                                  cwd=self.folder, capture_output=True, text=True, timeout=120,
                                  check=True).stdout

    def screenshot(self, *choices):
        self.browse(f"--screenshot={self.folder / 'page.png'}", *choices)
        return view_test.read_png((self.folder / "page.png").read_bytes())


class Page(Browsed, view_test.Solved):
    def test_the_box_is_seen_as_it_was_solved(self):
        self.page()

        rows = self.screenshot("camera=front")

        red, green, _ = rows[300][150]
        self.assertGreater(red, 2 * green)  # the left wall
        red, green, _ = rows[300][490]
        self.assertGreater(green, 1.2 * red)
        self.assertGreater(min(rows[70][320]), 180)  # the lamp
        self.assertEqual((0x22, 0x22, 0x22), rows[400][40])

    def test_the_page_shows_what_render_shows(self):
        self.page()
        self.assert_done(self.hemirad("render", "box.glb", "-o", "a.png", "--size", "640x480",
                                      "--camera", "front", "--false-colour", "40"))
        rendered = view_test.read_png((self.folder / "a.png").read_bytes())
        page = (self.folder / "page.html").read_text(encoding="utf-8")
        largest = re.sub(r'"largest":[0-9.e+-]+', '"largest":40.0', page)
        (self.folder / "page.html").write_text(largest, encoding="utf-8")

        shown = self.screenshot("camera=front", "show=false-colour")

        for x, y in ((320, 440), (150, 300), (490, 300), (330, 200), (400, 380)):
            for a, b in zip(rendered[y][x], shown[y][x]):
                self.assertLessEqual(abs(a - b), 6, (x, y, rendered[y][x], shown[y][x]))

    def test_snapshots_differ_from_the_end(self):
        self.page()

        first, last = self.screenshot("camera=front", "time=0"), self.screenshot("camera=front")

        self.assertNotEqual(first[300][320], last[300][320])
        self.assertIn("20", self.browse("--dump-dom", "time=0"))

    def test_no_name_runs_as_a_script(self):
        name = "<img src=x onerror=document.body.dataset.ready='hacked'>.glb"
        shutil.copy(self.folder / "box.glb", self.folder / name)
        self.page(scene=name)

        dom = self.browse("--dump-dom", "camera=" + urllib.parse.quote("<b>"))

        self.assertIn('data-ready="yes"', dom)
        self.assertIn("&lt;img src=x", dom)


class PageOfSeveralAtlases(Browsed, view_test.Room):
    def test_each_surface_shows_its_own_atlas(self):
        pictures = []
        for scene in ("box.glb", "one.glb"):
            self.page(scene=scene)
            pictures.append(self.screenshot("show=false-colour")[210:])  # what is below the panel

        far = max(abs(a - b) for x, y in zip(*pictures) for p, q in zip(x, y)
                  for a, b in zip(p, q))
        self.assertLessEqual(far, 6)
        self.assertGreater(pictures[0][20][200][2], 0x60)  # the wall
        self.assertGreater(pictures[0][130][320][1], 0x80)  # the floor


if __name__ == "__main__":
    unittest.main()
