"""Meshes of a solution as other programs read them: GLB by a reader of this file, others by the package in python/ and, where they are there,
VTK, meshio, trimesh and Blender."""

import importlib.util
import math
import os
import shutil
import subprocess
import unittest

from fluxel_job import MATRIX, SCENES, JobTest, start

import fluxel

BLENDER = shutil.which("blender")


def there_is(*modules):
    return all(importlib.util.find_spec(module) for module in modules)


def read_glb(file):
    """The nodes with a mesh: (name, positions, radiosities, colours, triangles), after the glTF 2.0 specification."""
    glb, parts = fluxel.GlbFile(file), []
    for node, (primitive,) in glb.nodes():
        attributes = {name: glb.values(number) for name, number in primitive["attributes"].items()}
        low, step = node.get("translation", (0, 0, 0)), node.get("scale", (1, 1, 1))
        parts.append((node["name"], low + step * attributes["POSITION"].astype(float), attributes.get("_RADIOSITY"),
                      attributes["COLOR_0"], glb.values(primitive["indices"]).reshape(-1, 3)))
    return glb.model, parts


class MeshesTest(JobTest):
    method = ()

    def write_all(self, scene, *options):
        self.assert_done(self.solve(scene, "--write", "vtu,glb,ply-triangles", *options))
        return self.report()

    def assert_power(self, sums, report, error=1e-6):
        for found, exact in zip(sums, report["leaving"], strict=True):
            self.assertAlmostEqual(found / exact, 1, delta=error)

    def assert_power_of_cells(self, grid, report):
        """The sum of A B over all cells, fronts and backs; and how many there are."""
        self.assertEqual(len(grid), report["elements"])
        sides = [grid[name] for name in ("radiosity", "radiosity_back") if name in grid.cell_data]
        self.assert_power(sum(grid.areas @ B for B in sides), report)

    def test_one_sided(self):
        report = self.write_all(SCENES / "cornell-box" / "cornell-box.toml", "--resolution", "64x64", "--target-error", 0.05)
        grid = fluxel.read_grid(self.out / "solution.vtu")
        self.assert_power_of_cells(grid, report)
        # B = E + rho H, of every cell, to the tolerance of the iteration, a tenth of the target; the lamp's are of one group.
        B, E, rho, H = (grid[name] for name in ("radiosity", "exitance", "reflectance", "irradiance"))
        self.assertLess((abs(B - E - rho * H) / B.clip(0.1)).max(), 5e-3)
        self.assertEqual(len(set(grid["group"][E[:, 0] > 0])), 1)

        triangles = fluxel.read_elements(self.out / "solution-triangles.ply")
        self.assertEqual(triangles.faces.shape[1], 3)
        self.assert_power(triangles.areas @ triangles.radiosity, report)

        model, parts = read_glb(self.out / "solution.glb")
        self.assertEqual([part[0] for part in parts][:3], ["floor", "ceiling", "back_wall"])
        surface, sums = 0, [0, 0, 0]
        for _, positions, radiosities, colours, faces in parts:
            self.assertEqual(len(positions), len(radiosities))
            self.assertEqual(len(positions), len(colours))
            for face in faces:
                u, v = ([b - a for a, b in zip(positions[face[0]], positions[corner], strict=True)] for corner in face[1:])
                size = math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2
                surface += size
                for c in range(3):
                    sums[c] += size * sum(radiosities[v][c] for v in face) / 3
        self.assertAlmostEqual(surface, triangles.areas.sum(), delta=1e-5 * surface)
        self.assert_power(sums, report, 0.05)  # smooth, so not the same
        self.assertEqual(model["nodes"][0]["name"], "fluxel")

    def test_quantised(self):
        self.assert_done(self.solve(SCENES / "cornell-box" / "cornell-box.toml", "--resolution", "16x16", "--target-error", 0.05,
                                    "--mesh-max-edge", 0.05, "--write", "glb,glb-quantised"))
        files = [self.out / name for name in ("solution.glb", "solution-quantised.glb")]
        (_, full), (model, quantised) = map(read_glb, files)
        self.assertEqual(model["extensionsRequired"], ["KHR_mesh_quantization"])
        self.assertIn("KHR_mesh_quantization", model["extensionsUsed"])
        self.assertLess(files[1].stat().st_size, 0.6 * files[0].stat().st_size)
        step = 0.5592 / 65535  # m, of the box's longest side
        grids = set()
        for (name, positions, _, colours, faces), (other, places, none, shown, corners) in zip(full, quantised, strict=True):
            self.assertEqual((name, colours.tolist(), faces.tolist()), (other, shown.tolist(), corners.tolist()))
            self.assertIsNone(none)
            for at, place in zip(positions, places, strict=True):
                self.assertLess(max(abs(a - b) for a, b in zip(at, place, strict=True)), 0.51 * step)
        for node in model["nodes"]:
            if "mesh" in node:
                grids.add((*node["translation"], *node["scale"]))
                self.assertAlmostEqual(node["scale"][0] / step, 1, delta=1e-5)
        self.assertEqual(len(grids), 1, "parts that meet still do")
        for accessor in model["accessors"]:
            if "max" in accessor:
                self.assertLessEqual(max(accessor["max"]), 65535)

    def test_two_sided_and_heat(self):
        report = self.write_all(SCENES / "heating-chamber" / "heating-chamber.toml")
        grid = fluxel.read_grid(self.out / "solution.vtu")
        self.assert_power_of_cells(grid, report)
        fronts = grid["sides"] & 1 > 0
        T, q, emissivity, B, H = (grid[name][fronts].astype(float).reshape(fronts.sum(), -1)[:, 0]
                                  for name in ("temperature", "net_flux", "emissivity", "radiosity", "irradiance"))
        self.assertLess((abs(q - (B - H)) / B.clip(H)).max(), 1e-4)
        self.assertLess((abs(B - emissivity * 5.670374419e-8 * T**4 - (1 - emissivity) * H) / B).max(), 1e-4)

    def test_a_later_run_removes_what_it_does_not_write(self):
        scene = SCENES / "emitting-wall" / "emitting-wall.toml"
        self.assert_done(self.solve(scene, "--write", "vtu,glb,glb-quantised,ply-triangles", "--target-error", 0.1))
        written = {name for name in self.written() if name.startswith("solution")}
        self.assertEqual(written, {"solution.ply", "solution.vtu", "solution.glb", "solution-quantised.glb",
                                   "solution-triangles.ply"})
        self.assert_done(self.solve(scene, "--target-error", 0.1))
        self.assertEqual({name for name in self.written() if name.startswith("solution")}, {"solution.ply"})

    def test_unknown_names(self):
        job = start(["solve", SCENES / "cornell-box" / "cornell-box.toml", "--write", "vtu,glbs", "--out", self.out], ranks=1)
        self.assert_refused(job, "--write", "'glbs'", "did you mean 'glb'?")

    @unittest.skipUnless(there_is("vtk", "meshio", "trimesh"), "there is no VTK, meshio or trimesh")
    def test_other_readers(self):
        import meshio
        import trimesh
        import vtk
        report = self.write_all(SCENES / "cornell-box" / "cornell-box.toml", *MATRIX, "--resolution", "32x32")
        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(self.out / "solution.vtu"))
        reader.Update()
        grid = reader.GetOutput()
        self.assertEqual(grid.GetNumberOfCells(), report["elements"])
        sizes = vtk.vtkCellSizeFilter()
        sizes.SetInputData(grid)
        sizes.Update()
        cells = sizes.GetOutput().GetCellData()
        self.assert_power([sum(cells.GetArray("Area").GetValue(k) * cells.GetArray("radiosity").GetComponent(k, c)
                               for k in range(report["elements"])) for c in range(3)], report)
        mesh = meshio.read(self.out / "solution.vtu")
        self.assertEqual(sum(len(block.data) for block in mesh.cells), report["elements"])
        self.assertLessEqual({"radiosity", "irradiance", "reflectance", "patch", "group"}, set(mesh.cell_data))
        ply = vtk.vtkPLYReader()
        ply.SetFileName(str(self.out / "solution.ply"))
        ply.Update()
        self.assertEqual(ply.GetOutput().GetNumberOfCells(), report["elements"])
        self.assertEqual(ply.GetOutput().GetCellData().GetArrayName(0), "RGB")
        faces = len(fluxel.read_elements(self.out / "solution-triangles.ply"))
        self.assertEqual(len(trimesh.load(self.out / "solution-triangles.ply").faces), faces)
        self.assert_done(self.solve(SCENES / "cornell-box" / "cornell-box.toml", *MATRIX, "--resolution", "32x32", "--write",
                                    "glb,glb-quantised"))
        scenes = [trimesh.load(self.out / name) for name in ("solution.glb", "solution-quantised.glb")]
        for scene in scenes:
            self.assertEqual(sum(len(part.faces) for part in scene.geometry.values()), faces)
            self.assertLess(abs(scene.bounds - scenes[0].bounds).max(), 1e-5)

    @unittest.skipUnless(BLENDER, "there is no Blender")
    def test_blender_reads_colours(self):
        self.write_all(SCENES / "cornell-box" / "cornell-box.toml", *MATRIX, "--resolution", "32x32")
        script = self.write("read.py", "import numpy; numpy.bool = bool\nimport bpy, sys\n"
                            "bpy.ops.wm.read_factory_settings(use_empty=True)\n"
                            "bpy.ops.import_scene.gltf(filepath=sys.argv[-1])\n"
                            "for o in bpy.context.scene.objects:\n"
                            "    if o.type == 'MESH':\n"
                            "        c = o.data.color_attributes[0].data\n"
                            "        print('MESH', o.name, sum(x.color[0] for x in c) / len(c), sum(x.color[1] for x in c) / len(c))\n")
        said = subprocess.run([BLENDER, "--background", "--factory-startup", "--python-exit-code", "1", "--python", script, "--",
                               self.out / "solution.glb"], check=True, capture_output=True, text=True, timeout=120,
                              env={**os.environ, "PATH": "/usr/bin:/bin"}).stdout
        mean = {words[1]: (float(words[2]), float(words[3])) for words in map(str.split, said.splitlines()) if words[:1] == ["MESH"]}
        self.assertGreater(mean["left_wall"][0], 3 * mean["left_wall"][1], "red")
        self.assertLess(mean["right_wall"][0], mean["right_wall"][1], "green")


if __name__ == "__main__":
    unittest.main()
