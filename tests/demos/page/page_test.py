#!/usr/bin/python3
"""The page of runs in a browser without a screen: page_test.py AMBIENT_DEMO [-v].

Needs chromium, chromedriver, selenium and three.js, as Debian has them.
"""

import csv
import io
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
from matplotlib.image import imread
from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.support.ui import WebDriverWait

ROOT = Path(__file__).resolve().parents[3]
SWITCHES = """--headless --no-sandbox --disable-gpu --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader
    --disable-quic --no-first-run --disable-background-networking --disable-component-update --disable-sync
    --disable-dev-shm-usage --force-device-scale-factor=1 --window-size=900,640""".split()
DEMO = None  # the program ambient_demo


def run_scene(folder, scene, *changes, log=()):
    settings = [word for change in changes for word in ("--set", change)] + [word for name in log for word in ("--log", name)]
    subprocess.run([DEMO, ROOT / f"data/scenes/{scene}.json", "--quiet", "--out", folder, *settings], check=True)


def make_page(page, *arguments):
    generator = [sys.executable, "-B", ROOT / "demos/page/make_page.py", *arguments, "-o", page]
    subprocess.run(generator, check=True, stdout=subprocess.DEVNULL)


def start_browser(profile, *switches):
    options = webdriver.ChromeOptions()
    options.binary_location = "/usr/bin/chromium"
    for switch in [*SWITCHES, *switches, f"--user-data-dir={profile}"]:
        options.add_argument(switch)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)


def rows_of(folder, body):
    """Rows of trajectory.csv without the name."""
    with open(folder / "trajectory.csv", newline="") as stream:
        return np.array([[float(x) for x in row[:1] + row[2:15]] for row in csv.reader(stream) if row[1] == body])


def rows_with_names(folder):
    with open(folder / "trajectory.csv", newline="") as stream:
        return list(csv.DictReader(stream))


def rotation_matrix(w, x, y, z):
    axis = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + 2 * w * axis + 2 * axis @ axis


class PageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        cls.addClassCleanup(folder.cleanup)
        cls.out = Path(folder.name)
        # Two turns between samples that the page keeps, 15 ms apart.
        spin = "bodies.0.angular_velocity=[0, -900, 0]"
        golf = ("duration=0.5", "output_step=0.005", spin, "bodies.0.shape.faces=320")
        run_scene(cls.out / "golf_dimpled_spin", "golf_dimpled_spin", *golf, "law=published", "bodies.0.separation_angle=2.2")
        for model in ("vacuum", "gwtf"):
            run_scene(cls.out / f"golf_dimpled_spin-{model}", "golf_dimpled_spin", f"model={model}", *golf)
        run_scene(cls.out / "ball_on_bottom", "ball_on_bottom", "duration=0.5")
        run_scene(cls.out / "flap_in_current", "flap_in_current", "duration=0.3", "bodies.0.separation_angle=2.2")
        run_scene(cls.out / "duck_dive", "duck_dive", "duration=0.5", "water.waves=[{\"amplitude\": 0.05, \"period\": 2}]")
        run_scene(cls.out / "floating_cube", "floating_cube", "duration=1", log=["wrench"])
        run_scene(cls.out / "barge_floods", "barge_floods", "duration=60", "output_step=1", log=["holds"])
        cls.page = cls.out / "page.html"
        make_page(cls.page, *sorted(cls.out.iterdir()), "--tables", ROOT / "docs/experiments.md")
        cls.browser = start_browser(cls.out / "profile")
        cls.addClassCleanup(cls.browser.quit)
        cls.browser.set_script_timeout(20)
        cls.browser.get(cls.page.as_uri())
        cls.moved_by_itself = cls.browser.execute_script("return player.playing || player.time > 0")

    def setUp(self):
        self.choose("golf dimpled spin")

    def tearDown(self):
        errors = [entry for entry in self.browser.get_log("browser") if entry["level"] == "SEVERE"]
        self.assertEqual(errors, [])

    def choose(self, title):
        buttons = self.browser.find_elements(By.CSS_SELECTOR, "#scenes button")
        next(button for button in buttons if button.text == title).click()

    def scrub(self, time):
        self.browser.execute_script(
            "const slider = document.getElementById('time'); slider.value = arguments[0];"
            "slider.dispatchEvent(new Event('input'));",
            float(time),
        )

    def pixels(self):
        """What the canvas shows, rows x columns x 3 in [0, 1]."""
        # Two frames: the first may have been asked for before the change.
        self.browser.execute_async_script("requestAnimationFrame(() => requestAnimationFrame(arguments[0]))")
        picture = self.browser.find_element(By.ID, "stage").screenshot_as_png
        return imread(io.BytesIO(picture))[:, :, :3]

    def pose(self, body):
        return self.browser.execute_script("return player.pose(arguments[0])", body)

    def test_begins_with_what_moves(self):
        self.assertTrue(self.moved_by_itself)

    def test_needs_nothing_but_itself(self):
        self.assertEqual(self.browser.execute_script("return performance.getEntriesByType('resource').length"), 0)
        self.assertIn("golf_dimpled_spin", self.browser.find_element(By.ID, "tables").text)

    def test_text_around_the_tables_is_shown(self):
        text = self.browser.find_element(By.ID, "tables").text
        for words in ("(paper; ours)", "Underwater Rigid Body Dynamics", "Where the model is known to differ"):
            self.assertIn(words, text)
        self.assertNotRegex(text, r"\*\*|\]\(|^\||<b>|&[a-z]+;")

    def test_every_scene_is_drawn(self):
        for title in ("ball on bottom", "flap in current", "golf dimpled spin"):
            self.choose(title)
            picture = self.pixels()
            background = np.array([0xEE, 0xF2, 0xF6]) / 255
            share = np.mean(np.abs(picture[100:-150] - background).max(axis=2) > 0.1)
            colours = len(np.unique(np.round(picture.reshape(-1, 3) * 255), axis=0))
            self.assertGreater(share, 0.002, title)
            self.assertGreater(colours, 100, title)

    def test_scrubbing_moves_the_body_as_logged(self):
        rows = rows_of(self.out / "golf_dimpled_spin", "ball")
        self.scrub(0)
        before = self.pixels()
        # Rows that the page did and did not keep.
        for row in rows[[0, 30, 31, 50, 76, 100]]:
            self.scrub(row[0])
            pose = self.pose("ball")
            np.testing.assert_allclose(pose["position"], row[1:4], rtol=1e-5, atol=1e-5)
            x, y, z, w = pose["orientation"]
            np.testing.assert_allclose(rotation_matrix(w, x, y, z), rotation_matrix(*row[4:8]), atol=1e-4)
        self.assertGreater(np.mean(np.abs(self.pixels() - before).max(axis=2) > 0.05), 1e-3)

    def test_water_is_in_the_hold_and_the_sea_is_not(self):
        self.choose("barge floods")
        # From straight above, the camera close over the barge.
        look = """
            const view = player.view; view.lookAt(view.moving()[0], player.time);
            view.controls.target.copy(view.placeOf(view.moving()[0]));
            view.camera.position.copy(view.controls.target).add(new THREE.Vector3(0, 6, 0.01));
            view.controls.update(); player.changed = true;"""
        middles = []
        for time in (0, 60):
            self.scrub(time)
            self.browser.execute_script(look)
            picture = self.pixels()
            rows, columns = picture.shape[:2]
            middles.append(picture[rows // 2 - 3 : rows // 2 + 3, columns // 2 - 3 : columns // 2 + 3].mean(axis=(0, 1)))
        dry, wet = middles
        self.assertGreater(wet[2] - wet[0], 0.2)  # blue
        self.assertGreater(np.abs(wet - dry).max(), 0.1)
        water = float(rows_with_names(self.out / "barge_floods")[-1]["hold0_volume"])
        self.assertIn(f"water inside {water:.3g} m³", self.browser.find_element(By.ID, "numbers").text)

    def test_slip_is_that_of_the_faces(self):
        geometry = json.loads((self.out / "flap_in_current/geometry.json").read_text())
        flow = geometry["medium_velocity"]
        self.assertGreater(np.linalg.norm(flow), 0)
        self.choose("flap in current")
        largest = []
        for body in geometry["bodies"]:
            corners = np.reshape(body["vertices"], (-1, 3))[np.reshape(body["triangles"], (-1, 3))]
            centroids = corners.mean(axis=1)
            normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            normals /= np.linalg.norm(normals, axis=1)[:, None]
            row = rows_of(self.out / "flap_in_current", body["name"])[-1]
            to_world = rotation_matrix(*row[4:8])
            velocity = row[11:14] - flow + np.cross(row[8:11], centroids @ to_world.T)
            normals = normals @ to_world.T
            slip = velocity - np.sum(velocity * normals, axis=1)[:, None] * normals
            largest.append(np.linalg.norm(slip, axis=1).max())
        self.browser.execute_script("player.view.moveTo(0.3)")
        shown = self.browser.execute_script("return Math.max(...player.view.bodies.map((view) => view.largest))")
        self.assertAlmostEqual(shown, max(largest), delta=1e-4 * max(largest))

    def test_separation_is_that_of_the_law(self):
        angles = "return Object.fromEntries(player.view.bodies.map((view) => [view.body.name, view.body.separation_angle]))"
        for title in ("golf dimpled spin", "flap in current"):
            self.choose(title)
            shown = self.browser.execute_script(angles)
            geometry = json.loads((self.out / title.replace(" ", "_") / "geometry.json").read_text())
            for body in geometry["bodies"]:
                published = body["law"] == "published"
                self.assertEqual(published, title == "golf dimpled spin")
                self.assertEqual(shown[body["name"]], body["separation_angle"] if published else np.pi / 2)

    def test_water_has_its_waves(self):
        self.choose("duck dive")
        height = "return player.view.water.height(arguments[0], 0, arguments[1])"
        length = 9.81 * 2**2 / (2 * np.pi)
        for x, time, expected in ((0, 0, 0.05), (length / 2, 0, -0.05), (0, 1, -0.05), (length / 2, 1, 0.05)):
            self.assertAlmostEqual(self.browser.execute_script(height, x, time), expected, places=5)
        self.choose("golf dimpled spin")
        self.assertIsNone(self.browser.execute_script("return player.view.water"))

    def set_visible(self, parts, visible):
        """Parts of the picture, an expression of `view` in JavaScript."""
        change = "const { view } = player; for (const part of %s) part.visible = arguments[0]; player.changed = true"
        self.browser.execute_script(change % parts, visible)

    def changed_by(self, parts):
        """Which pixels change if parts are hidden."""
        shown = self.pixels()
        self.set_visible(parts, False)
        hidden = self.pixels()
        self.set_visible(parts, True)
        return np.abs(shown - hidden).max(axis=2) > 0.02

    def test_the_surface_cuts_bodies(self):
        self.choose("floating cube")
        self.browser.execute_script("player.view.lookAt(player.view.bodies[0], 1)")
        self.scrub(1)
        self.set_visible("[view.water.group]", False)
        body = self.changed_by("[view.bodies[0].mesh]")
        self.set_visible("[view.water.group]", True)
        tinted = self.changed_by("[view.water.group]") & body
        share = tinted.sum() / body.sum()
        self.assertGreater(body.sum(), 1000)
        self.assertTrue(0.03 < share < 0.5, share)  # a tenth of the cube is in the water
        rows = [np.nonzero(mask.any(axis=1))[0] for mask in (tinted, body & ~tinted)]
        self.assertGreater(np.median(rows[0]), np.median(rows[1]))

    def test_forces_are_arrows_that_can_be_switched_on(self):
        switch = self.browser.find_element(By.ID, "show-forces")
        self.assertFalse(switch.is_displayed())  # golf has no log of forces
        self.choose("floating cube")
        self.scrub(0.5)
        self.assertTrue(switch.is_displayed())
        without = self.pixels()
        switch.click()
        changed = np.abs(self.pixels() - without).max(axis=2) > 0.1
        self.assertGreater(changed.sum(), 100)
        with open(self.out / "floating_cube" / "trajectory.csv", newline="") as stream:
            rows = list(csv.DictReader(stream))
        buoyancy = [np.linalg.norm([float(row[f"buoyancy_f{axis}"]) for axis in "xyz"]) for row in rows]
        shown = self.browser.execute_script(
            "const { forces, motion } = player.view.bodies[0], part = forces.parts.indexOf('buoyancy');"
            "const arrow = forces.arrows[part], sample = motion.indexBefore(player.time);"
            "return [motion.timeOf(sample), forces.force(sample, part).length(),"
            " arrow.line.scale.y + arrow.cone.scale.y, forces.metresPerNewton];")
        row = np.argmin([abs(float(row["time"]) - shown[0]) for row in rows])
        self.assertAlmostEqual(shown[1], buoyancy[row], delta=1e-3 * buoyancy[row])
        self.assertAlmostEqual(shown[2] / (shown[1] * shown[3]), 1, delta=0.01)
        switch.click()
        self.assertLess((np.abs(self.pixels() - without).max(axis=2) > 0.1).sum(), 5)

    def test_fits_a_window_without_scrolling(self):
        make_page(self.out / "all.html", self.out / "golf_dimpled_spin", self.out / "ball_on_bottom")
        size = self.browser.get_window_size()
        self.addCleanup(self.browser.get, self.page.as_uri())
        self.addCleanup(self.browser.set_window_size, size["width"], size["height"])
        self.browser.set_window_size(1400, 900)
        self.browser.get((self.out / "all.html").as_uri())
        excess = """const { scrollWidth, scrollHeight } = document.documentElement;
            return [scrollWidth - innerWidth, scrollHeight - innerHeight]"""
        self.assertEqual(self.browser.execute_script(excess), [0, 0])

    def test_rivals_can_be_hidden(self):
        def orange(picture):
            """Pixels near the colour of the rival's path, left of its entry in the list."""
            part = picture[:, : int(0.6 * picture.shape[1])]
            return np.sum(np.abs(part - np.array([0xE8, 0x59, 0x0C]) / 255).max(axis=2) < 0.2)

        self.scrub(0.3)
        self.assertGreater(orange(self.pixels()), 30)
        box = self.browser.find_element(By.ID, "rival-gwtf")
        box.click()
        self.assertLess(orange(self.pixels()), 3)
        box.click()
        self.assertGreater(orange(self.pixels()), 30)

    def test_a_flow_has_an_arrow_and_its_speed(self):
        def blue(picture):
            """Pixels like the arrow, below and left of the middle."""
            part = picture[picture.shape[0] // 2 :, : picture.shape[1] // 3]
            return np.sum(part[:, :, 2] - part[:, :, 0] > 0.25)

        self.choose("ball on bottom")
        self.assertEqual(blue(self.pixels()), 0)
        self.assertFalse(self.browser.find_element(By.ID, "flow").is_displayed())
        self.choose("flap in current")
        self.assertGreater(blue(self.pixels()), 100)
        self.assertIn("flow of 1 m/s", self.browser.find_element(By.ID, "legend").text)

    def test_says_how_much_bodies_are_magnified(self):
        scale = lambda: self.browser.find_element(By.ID, "scale").text
        self.assertRegex(scale(), r"bodies drawn \d+ times their size")
        self.choose("flap in current")
        self.assertNotIn("drawn", scale())

    def test_a_run_without_moving_bodies_is_shown(self):
        run_scene(self.out / "still", "plate_8cm", "duration=0.1", "bodies.0.mass=0")
        make_page(self.out / "still.html", self.out / "still")
        self.addCleanup(self.browser.get, self.page.as_uri())
        self.browser.get((self.out / "still.html").as_uri())
        self.assertEqual(self.browser.find_element(By.ID, "numbers").text, "no body moves")
        picture = self.pixels()
        row, column = picture.shape[0] // 2, picture.shape[1] // 2
        self.assertGreater(np.abs(picture[row, column] - np.array([0xEE, 0xF2, 0xF6]) / 255).max(), 0.1)

    def test_plays_and_pauses(self):
        time = lambda: self.browser.execute_script("return player.time")
        button = self.browser.find_element(By.ID, "play")
        self.browser.execute_script("document.getElementById('speed').value = 0.01")
        button.click()
        WebDriverWait(self.browser, 20).until(lambda _: time() > 0)
        button.click()
        stopped = time()
        self.pixels()
        self.assertEqual(time(), stopped)
        self.assertLess(stopped, 0.5)

    def test_space_bar_plays(self):
        self.browser.execute_script("document.getElementById('speed').value = 0.01")
        body = self.browser.find_element(By.TAG_NAME, "body")
        for expected in ("Pause", "Play"):
            body.send_keys(" ")
            self.assertEqual(self.browser.find_element(By.ID, "play").text, expected)

    def test_following_keeps_the_body_in_the_middle(self):
        self.browser.execute_script(
            "const view = document.getElementById('view'); view.value = 0; view.dispatchEvent(new Event('change'));"
        )
        self.scrub(0.4)
        picture = self.pixels()
        middle = picture[picture.shape[0] // 2, picture.shape[1] // 2]
        self.assertGreater(np.abs(middle - np.array([0xEE, 0xF2, 0xF6]) / 255).max(), 0.2)

    def test_without_webgl_scenes_and_tables_are_readable(self):
        browser = start_browser(self.out / "second profile", "--disable-3d-apis")
        self.addCleanup(browser.quit)
        browser.get(self.page.as_uri())
        text = lambda name: browser.find_element(By.ID, name).text
        self.assertIn("no WebGL", text("no-picture"))
        self.assertFalse(browser.find_element(By.ID, "play").is_displayed())
        buttons = browser.find_elements(By.CSS_SELECTOR, "#scenes button")
        next(button for button in buttons if button.text == "ball on bottom").click()
        self.assertEqual(text("title"), "ball on bottom")
        self.assertGreater(len(text("description")), 10)
        self.assertIn("golf_dimpled_spin", text("tables"))
        self.assertFalse([entry for entry in browser.get_log("browser") if "Uncaught" in entry["message"]])


if __name__ == "__main__":
    DEMO = sys.argv.pop(1)
    unittest.main()
