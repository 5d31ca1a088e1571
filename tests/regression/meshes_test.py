"""Meshes of a solution as other programs read them: VTU and GLB by readers of this file and, where they are there,
VTK, meshio, trimesh and Blender."""

import importlib.util
import json
import math
import os
import re
import shutil
import struct
import subprocess
import unittest
import zlib

from fluxel_job import MATRIX, SCENES, JobTest, start
from solution import area, read_elements

BLENDER = shutil.which("blender")
KINDS = {"Float32": "f", "Float64": "d", "UInt32": "I", "Int64": "q", "UInt8": "B"}


def there_is(*modules):
    return all(importlib.util.find_spec(module) for module in modules)


def read_vtu(file):
    """Arrays by name, as lists of numbers, after VTK's description of its XML formats."""
    data = file.read_bytes()
    head, start_of_data = data.split(b"<AppendedData", 1)[0].decode(), data.index(b"_", data.index(b">", data.index(b"<AppendedData"))) + 1
    arrays = {}
    for kind, name, offset in re.findall(r'<DataArray type="(\w+)" Name="(\w+)" [^>]*offset="(\d+)"', head):
        at = start_of_data + int(offset)
        blocks, size, last = struct.unpack_from("<3Q", data, at)
        sizes = struct.unpack_from(f"<{blocks}Q", data, at + 24)
        at += 24 + 8 * blocks
        raw = b""
        for k, compressed in enumerate(sizes):
            part = zlib.decompress(data[at:at + compressed])
            assert len(part) == (last if k == blocks - 1 and last else size)
            raw, at = raw + part, at + compressed
        arrays[name] = struct.unpack(f"<{len(raw) // struct.calcsize(KINDS[kind])}{KINDS[kind]}", raw)
    return arrays


def read_glb(file):
    """The nodes with a mesh: (name, positions, radiosities, colours, triangles), after the glTF 2.0 specification."""
    data = file.read_bytes()
    magic, version, length, text = struct.unpack_from("<4sIII", data)
    assert (magic, version, length, data[16:20]) == (b"glTF", 2, len(data), b"JSON")
    model, binary = json.loads(data[20:20 + text]), data[20 + text + 8:]

    def values(number):
        accessor = model["accessors"][number]
        view = model["bufferViews"][accessor["bufferView"]]
        count = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        kind = {5123: "H", 5125: "I", 5126: "f"}[accessor["componentType"]]
        assert view["byteOffset"] % 4 == 0
        items = struct.unpack_from(f"<{count * accessor['count']}{kind}", binary, view["byteOffset"])
        return items if count == 1 else [items[k:k + count] for k in range(0, len(items), count)]

    parts = []
    for node in model["nodes"]:
        if "mesh" not in node:
            continue
        (primitive,) = model["meshes"][node["mesh"]]["primitives"]
        attributes, corners = primitive["attributes"], values(primitive["indices"])
        parts.append((node["name"], values(attributes["POSITION"]), values(attributes["_RADIOSITY"]),
                      values(attributes["COLOR_0"]), [corners[k:k + 3] for k in range(0, len(corners), 3)]))
    return model, parts


class MeshesTest(JobTest):
    method = ()

    def write_all(self, scene, *options):
        self.assert_done(self.solve(scene, "--write", "vtu,glb,ply-triangles", *options))
        return self.report()

    def assert_power(self, sums, report, error=1e-6):
        for found, exact in zip(sums, report["leaving"], strict=True):
            self.assertAlmostEqual(found / exact, 1, delta=error)

    def vtu_sums(self):
        """Of A B over all cells, fronts and backs; and how many there are."""
        arrays = read_vtu(self.out / "solution.vtu")
        points, ends = arrays["Points"], (0, *arrays["offsets"])
        sums, count = [0, 0, 0], len(arrays["types"])
        for k in range(count):
            corners = arrays["connectivity"][ends[k]:ends[k + 1]]
            self.assertEqual(len(corners), {5: 3, 9: 4}[arrays["types"][k]])
            size = area([points[3 * c:3 * c + 3] for c in corners])
            for name in ("radiosity", "radiosity_back"):
                for c in range(3):
                    sums[c] += size * arrays[name][3 * k + c] if name in arrays else 0
        return sums, count, arrays

    def test_one_sided(self):
        report = self.write_all(SCENES / "cornell-box" / "cornell-box.toml", "--resolution", "64x64", "--target-error", 0.05)
        sums, count, arrays = self.vtu_sums()
        self.assertEqual(count, report["elements"])
        self.assert_power(sums, report)
        # B = E + rho H, of every cell, to the tolerance of the iteration, a tenth of the target; the lamp's are of one group.
        for B, E, rho, H in zip(*(arrays[name] for name in ("radiosity", "exitance", "reflectance", "irradiance")), strict=True):
            self.assertAlmostEqual(B, E + rho * H, delta=5e-3 * max(B, 0.1))
        self.assertEqual(len({group for group, E in zip(arrays["group"], arrays["exitance"][::3], strict=True) if E > 0}), 1)

        triangles = read_elements(self.out / "solution-triangles.ply")
        self.assertEqual({len(corners) for corners, _, _ in triangles}, {3})
        self.assert_power([sum(area(corners) * B[c] for corners, _, B in triangles) for c in range(3)], report)

        model, parts = read_glb(self.out / "solution.glb")
        self.assertEqual([part[0] for part in parts][:3], ["floor", "ceiling", "back_wall"])
        surface, sums = 0, [0, 0, 0]
        for _, positions, radiosities, colours, faces in parts:
            self.assertEqual(len(positions), len(radiosities))
            self.assertEqual(len(positions), len(colours))
            for face in faces:
                size = area([positions[c] for c in face])
                surface += size
                for c in range(3):
                    sums[c] += size * sum(radiosities[v][c] for v in face) / 3
        self.assertAlmostEqual(surface, sum(area(corners) for corners, _, _ in triangles), delta=1e-5 * surface)
        self.assert_power(sums, report, 0.05)  # smooth, so not the same
        self.assertEqual(model["nodes"][0]["name"], "fluxel")

    def test_two_sided_and_heat(self):
        report = self.write_all(SCENES / "heating-chamber" / "heating-chamber.toml")
        sums, count, arrays = self.vtu_sums()
        self.assertEqual(count, report["elements"])
        self.assert_power(sums, report)
        for T, q, emissivity, B, H, sides in zip(arrays["temperature"], arrays["net_flux"], arrays["emissivity"],
                                                 arrays["radiosity"][::3], arrays["irradiance"][::3], arrays["sides"], strict=True):
            if not sides & 1:
                continue
            self.assertAlmostEqual(q, B - H, delta=1e-4 * max(B, H))
            emitted = emissivity * 5.670374419e-8 * T**4
            self.assertAlmostEqual(B, emitted + (1 - emissivity) * H, delta=1e-4 * B)

    def test_a_later_run_removes_what_it_does_not_write(self):
        scene = SCENES / "emitting-wall" / "emitting-wall.toml"
        self.write_all(scene, "--target-error", 0.1)
        written = {name for name in self.written() if name.startswith("solution")}
        self.assertEqual(written, {"solution.ply", "solution.vtu", "solution.glb", "solution-triangles.ply"})
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
        faces = len(read_elements(self.out / "solution-triangles.ply"))
        self.assertEqual(len(trimesh.load(self.out / "solution-triangles.ply").faces), faces)
        parts = trimesh.load(self.out / "solution.glb").geometry.values()
        self.assertEqual(sum(len(part.faces) for part in parts), faces)

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
