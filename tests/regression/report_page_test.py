"""The pages of runs, report.html and its kin, as a browser shows them."""

import json
import shutil
import time
import unittest

from browser import DATA, Page, parse_strictly, start_browser, with_data
from fluxel_job import MATRIX, SCENES, JobTest, launch, start
from rooms import INSIDE, MTL, ROOM, scene_file

import fluxel

CORNELL = SCENES / "cornell-box" / "cornell-box.toml"
CHAMBER = SCENES / "heating-chamber" / "heating-chamber.toml"
MOST_BYTES = 5_000_000
DESK = '[[receivers]]\nname = "desk"\norigin = [0.2, 0.2, 0.2]\nu = [0.5, 0, 0]\nv = [0, 0.5, 0]\ncells = [4, 4]\n'
HOSTILE = ("<script>document.title='pwned'</script>", "\"'><img/src=x/onerror=\"document.title='pwned'\">", "ה'מנורה\u202e", "n" * 10_000, "x" + 70 * "é", "</script><!--")


class ReportPageTest(JobTest):
    @classmethod
    def setUpClass(cls):
        cls.browser = start_browser()
        cls.addClassCleanup(cls.browser.quit)

    def setUp(self):
        super().setUp()
        self.write("room.mtl", MTL)
        self.room = self.write("room.obj", ROOM)

    def run_well(self, *arguments, ranks=1, codes=(0, 3)):
        job = start([*arguments, "--quiet", "--out", self.out], ranks)
        self.assertIn(job.code, codes, job)

    def opened(self, name="report.html"):
        file = self.out / name
        self.assertLess(file.stat().st_size, MOST_BYTES)
        parse_strictly(file)
        page = Page(self.browser, file)
        self.assertEqual(page.said, [])
        self.assertEqual(page.run("return performance.getEntriesByType('resource').filter(entry => !entry.name.startsWith('data:')).length"), 0)
        self.assertLessEqual(page.run("return document.documentElement.scrollWidth"), 1200)
        self.assertNotIn("[object", page.text)
        self.assertNotIn("undefined", page.text)
        self.assertNotIn("NaN", page.text)
        return page

    def test_a_picture_its_error_and_its_mesh(self):
        scene = self.write("room.toml", scene_file(DESK))
        self.run_well("solve", scene, "--target-error", 0.1, "--resolution", "40x30", ranks=2)
        report = json.loads((self.out / "report.json").read_text())
        page = self.opened()
        text = page.text
        self.assertIn("The error of the picture is stated", text)
        self.assertIn(f"is stated as {float(format(100 * report['stated_error'], '.2g')):g} %", text)
        self.assertIn("desk", text)
        self.assertIn("mpirun -np 2 fluxel solve", text)
        self.assertEqual(page.run("return document.querySelectorAll('figure img').length"), 3, "picture, false colours, plan")
        self.assertTrue(page.run("return [...document.images].every(image => image.naturalWidth > 0)"))

    def test_a_click_on_the_mesh_says_what_is_there(self):
        self.run_well("solve", self.room, "--target-error", 0.1)
        page = self.opened()
        page.click("#mesh canvas", 0.5, 0.5)
        said = page.run("return document.querySelector('.said').innerText")
        self.assertRegex(said, r"element \d+.*group")
        for quantity in ("radiosity B", "irradiance E", "reflectance"):
            self.assertIn(quantity, said)
        page.click("#mesh canvas", 0.01, 0.01)
        self.assertEqual(page.run("return document.querySelector('.said').innerText"), "Nothing is here.")
        # Colours change what is drawn.
        seen = [page.run("""const select = document.getElementById('quantity'); select.value = arguments[0]; select.dispatchEvent(new Event('change'));
                            return document.querySelector('#mesh canvas').toDataURL()""", k) for k in (0, 1, 3)]
        self.assertEqual(len(set(seen)), 3)
        self.assertEqual(page.said, [])

    def test_the_unlit_outside_of_a_room_of_slabs_does_not_hide_its_inside(self):
        slabs = "".join(f"[[geometry]]\nbox = {size}\ntranslate = {place}\n" for size, place in (
            ([1.2, 1.2, 0.1], [-0.1, -0.1, -0.1]), ([1.2, 1.2, 0.1], [-0.1, -0.1, 1]), ([0.1, 1, 1], [-0.1, 0, 0]),
            ([0.1, 1, 1], [1, 0, 0]), ([1.2, 0.1, 1], [-0.1, -0.1, 0]), ([1.2, 0.1, 1], [-0.1, 1, 0])))
        lamp = "[[luminaires]]\nname = \"bulb\"\nintensity = 10.0\nposition = [0.5, 0.5, 0.7]\n"
        self.run_well("solve", self.write("slabs.toml", slabs + lamp), "--target-error", 0.1, "--up", "0,0,1")
        page = self.opened()
        brightest = """const drawn = document.querySelector('#mesh canvas'), flat = document.createElement('canvas');
            flat.width = drawn.width; flat.height = drawn.height; const pen = flat.getContext('2d'); pen.drawImage(drawn, 0, 0);
            return pen.getImageData(0, 0, flat.width, flat.height).data.reduce((most, value, k) => k % 4 === 3 ? most : Math.max(most, value), 0)"""
        self.assertGreater(page.run(brightest), 120)
        page.run("document.getElementById('lit').click()")
        self.assertLess(page.run(brightest), 80)
        self.assertEqual(page.said, [])
        # What emits is lit, though no light comes to it.
        lamp = "[[geometry]]\nrectangle = [1, 1]\nmaterial = \"lamp\"\n[[geometry]]\nbox = [1, 1, 0.1]\ntranslate = [0, 0, -1]\n[materials]\nlamp.E = 10\ndefault.rho = 0\n"
        self.run_well("solve", self.write("lamp.toml", lamp), "--target-error", 0.1, "--up", "0,0,1")
        self.assertGreater(self.opened().run(brightest), 120)

    def test_values_of_a_click_are_those_of_the_file(self):
        self.run_well("solve", self.room, *MATRIX, "--subdivision", "none", "--no-error-estimate", "--audit", 0)
        page = self.opened()
        unpacked = page.run("return unpack(JSON.parse(document.getElementById('data').textContent).mesh).then(data => Array.from(data.radiosity))")
        elements = fluxel.read_elements(self.out / "solution.ply")
        self.assertEqual(len(unpacked), elements.radiosity.size)
        largest = elements.radiosity.max()
        for found, wanted in zip(unpacked, elements.radiosity.ravel()):
            self.assertAlmostEqual(found, wanted, delta=1e-3 * wanted + 1e-7 * largest)

    def test_without_webgl_the_rest_is_there(self):
        self.run_well("solve", self.room, "--target-error", 0.1)
        blind = start_browser(with_webgl=False)
        self.addCleanup(blind.quit)
        page = Page(blind, self.out / "report.html")
        self.assertIn("no WebGL", page.text)
        self.assertIn("How good it is", page.text)

    def test_heat(self):
        self.run_well("solve", CHAMBER)
        page = self.opened()
        self.assertIn("refractory", page.text)
        self.assertIn("temperature T", page.run("return document.getElementById('quantity').selectedOptions[0].text"))

    def test_view_factors(self):
        self.run_well("viewfactors", self.room)
        page = self.opened("view-factors.html")
        page.click("#matrix", 0.5, 0.01)
        self.assertRegex(page.text, r"from \S+, (front|back)\s+to \S+, (front|back)\s*: F = [0-9.]+")

    def test_photons_references_and_comparisons(self):
        elements = ("--max-edge", 0.2, "--only", "elements")
        self.run_well("photons", self.room, *elements, "--photons", 300_000)
        self.assertIn("elements: one standard error is", self.opened("photons.html").text.replace("\n", ""))
        kept = self.work / "kept.ply"
        shutil.copy(self.out / "photons.ply", kept)
        self.run_well("reference", self.room, "--elements", kept, "--time", 1, *INSIDE, "--resolution", "16x12")
        page = self.opened("reference.html")
        self.assertIn("standard error of B", page.run("return document.getElementById('quantity').innerText"))
        self.run_well("compare", kept, self.out / "reference.ply")
        self.assertIn("root mean square difference", self.opened("compare.html").text)
        self.run_well("compare", self.out / "reference.exr", self.out / "reference.exr")
        self.assertEqual(self.opened("compare.html").run("return document.querySelectorAll('figure img').length"), 1)

    def test_a_run_that_fails_says_so_first(self):
        self.run_well("solve", self.room, *MATRIX, "--subdivision", "uniform", "--max-edge", 0.3, "--max-iterations", 1, "--no-error-estimate", codes=(3,))
        page = self.opened()
        self.assertIn("The solver has not converged", page.text)
        self.assertTrue(page.run("return document.querySelector('.warnings').compareDocumentPosition(document.querySelector('.verdict')) & 4"))

    def test_dry_runs_have_a_page_too(self):
        self.run_well("solve", self.room, "--dry-run", codes=(0,))
        text = self.opened().text
        self.assertIn("Forecast (dry run)", text)
        self.assertIn("nothing has been solved", text)

    def test_a_thousand_warnings(self):
        self.run_well("solve", self.room, "--target-error", 0.1)

        def warn(data):
            of = json.loads(data)
            of["report"]["warnings"] = [f"warning {k}" for k in range(1000)]
            return json.dumps(of)
        with_data(self.out / "report.html", warn)
        text = self.opened().text
        self.assertIn("1000 warnings", text)
        self.assertIn("and 940 more warnings", text)

    def test_hostile_names_are_text(self):
        for k, hostile in enumerate(HOSTILE):
            mtl = self.write("hostile.mtl", MTL.replace("newmtl white", f"newmtl {hostile}"))
            obj = self.write("hostile.obj", ROOM.replace("room.mtl", "hostile.mtl").replace("usemtl white", f"g {hostile}\nusemtl {hostile}"))
            self.assertIn(hostile, mtl.read_text() + obj.read_text())
            self.run_well("solve", obj, "--target-error", 0.2)
            self.opened()
            page = Page(self.browser, self.out / "report.html")
            self.assertNotEqual(page.run("return document.title"), "pwned")
            names = page.run("return unpack(JSON.parse(document.getElementById('data').textContent).mesh) && JSON.parse(document.getElementById('data').textContent).mesh.groups")
            self.assertIn(hostile, names, k)
            self.run_well("viewfactors", obj)
            page = self.opened("view-factors.html")
            self.assertNotEqual(page.run("return document.title"), "pwned")
            self.assertIn(hostile[:100].strip("\u202e"), page.text)

    def test_live(self):
        process = launch(["photons", CORNELL, "--max-edge", 0.05, "--target-error", 1e-4, "--time", 20, "--only", "elements", "--live", "--out", self.out], 1)
        file = self.out / "photons.html"
        end = time.monotonic() + 60
        while not (file.exists() and "samples" in DATA.search(file.read_text()).group(2)) and time.monotonic() < end:
            time.sleep(0.2)
        self.assertIn('http-equiv="refresh"', file.read_text())
        page = self.opened("photons.html")
        self.assertIn("under way", page.text)
        process.communicate(timeout=60)
        self.assertNotIn('http-equiv="refresh"', file.read_text())
        self.assertNotIn("under way", self.opened("photons.html").text)


if __name__ == "__main__":
    unittest.main()
