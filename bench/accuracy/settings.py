"""What is charted: scenes, methods and how fine they are tried."""

import os
from dataclasses import dataclass
from pathlib import Path

from curves import VIEW

ROOT = Path(__file__).resolve().parent.parent.parent

MODERN_HALL_CAMERA = (
    "--eye", "6.911821295180567,1.6516303433984643,2.5541356265944657",
    "--look-at", "6.011643710408107,1.6516302965772593,2.118612343670267",
    "--up", "-4.214739473214832e-08,0.9999999999999978,-2.0391722734450485e-08", "--fov", "70", "--sides", "one")
WOODEN_STAIRCASE_CAMERA = (
    "--eye", "0.032420927097472935,1.5267276149815672,4.881970480788412",
    "--look-at", "0.0247749097978693,1.5717826235996408,3.8830149873122095",
    "--up", "0.0003448413525093779,0.9989840153623055,0.04505366923261864", "--fov", "58.543979551022964", "--sides", "two")


@dataclass(frozen=True)
class Scene:
    name: str
    file: Path
    resolutions: tuple  # of the camera's subdivision, from coarse to fine; pictures of other subdivisions have the last
    edges: tuple  # [m] of the uniform subdivision, likewise
    options: tuple = ()
    exact: float | None = None  # B everywhere, where it is known: then elements are judged by it, not pictures
    block_errors: tuple = (1e-3, 3e-4, 1e-4, 3e-5, 1e-5)  # of the hierarchical method, likewise

    @property
    def files(self):
        """All that the scene is made of."""
        return sorted(self.file.parent.glob(f"{self.file.parent.name}*")) if self.file.suffix == ".toml" else \
            [self.file, self.file.with_suffix(".mtl")]


def of_project(name, resolutions, edges, options=(), exact=None):
    return Scene(name, ROOT / "scenes" / name / f"{name}.toml", resolutions, edges, options, exact)


SCENES = (
    of_project("cornell-box", (32, 64, 128), (0.06, 0.03, 0.015)),
    of_project("emitting-wall", (32, 64, 128), (0.125, 0.0625, 0.03125)),
    of_project("construction-in-wood", (32, 64, 100), (0.5, 0.25, 0.125), ("--max-edge", "0.4")),
    of_project("cube-in-cube", (32, 64, 128), (0.5, 0.25, 0.125), exact=1.0),
    of_project("corridor", (32, 64, 128), (0.4, 0.2, 0.1)),
)


def modern_hall(obj):
    """By NewSee2l035, CC-BY 3.0, not part of the project: as an OBJ file given on the command line. Its 28,459 triangles
    are more elements than any edge would ask for, so that it is not tried uniformly, and once by the camera."""
    return Scene("modern-hall", obj, (24,), (), MODERN_HALL_CAMERA, block_errors=(1e-3, 3e-4, 1e-4))


def wooden_staircase(obj):
    """By Wig42, CC-BY 3.0, not part of the project: as an OBJ file given on the command line. 249,788 triangles."""
    return Scene("wooden-staircase", obj, (), (), WOODEN_STAIRCASE_CAMERA)


def add_scene_options(parser):
    """What every script that solves these scenes is asked."""
    parser.add_argument("--scenes", nargs="+", help="of the project's, by name")
    parser.add_argument("--hall", type=Path, help="modern-hall.obj, to try it too")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--references", type=Path, default=ROOT / "build/references")


def scenes_of(arguments):
    """The scenes that those options ask for."""
    scenes = [scene for scene in SCENES if not arguments.scenes or scene.name in arguments.scenes]
    return scenes + [modern_hall(arguments.hall)] if arguments.hall else scenes


@dataclass(frozen=True)
class Method:
    """A curve of the chart. A further one is a further line below."""

    label: str
    subdivision: str
    options: tuple = ()
    is_view: bool = False  # of the solution for a picture of a quarter of the pixels along each side, which is not timed

    @property
    def name(self):
        """What --method calls it."""
        return "hierarchical" if self.subdivision == "transport" else "matrix"


PHOTONS = Method("photons", "photons")  # on elements of the uniform subdivision, from which a view is made
HIERARCHICAL = Method("hierarchical", "transport")
METHODS = (
    Method("no subdivision", "none"),
    Method("uniform, disc", "uniform", ("--form-factor", "disc")),
    Method("uniform, adaptive", "uniform"),
    Method("camera, point", "camera", ("--form-factor", "point")),
    Method("camera, disc", "camera", ("--form-factor", "disc")),
    Method("camera, adaptive", "camera"),
    HIERARCHICAL,
    Method("hierarchical, each pixel", "transport", ("--picture", "gather")),
    Method(VIEW, "transport", is_view=True),
    PHOTONS,
)


@dataclass(frozen=True)
class Setting:
    """One solve."""

    method: Method
    step: int  # 0 the coarsest
    resolution: int  # pixels a side of the picture
    mesh: tuple  # options that decide on the elements

    @property
    def seen(self):
        """The options of a view with the error that a block error is for."""
        found = list(self.mesh)
        error = float(found[found.index("--block-error") + 1])
        return (*without(without(self.mesh, "--block-error"), "--subdivision"), "--target-error", str(error ** 0.5))

    @property
    def solved_for_view(self):
        size = self.resolution // 4
        return (*without(self.mesh, "--resolution"), "--resolution", f"{size}x{size}", "--keep-links")

    @property
    def whole(self):
        """Whether it has no visibility of its own to share: the hierarchical method finds links, their visibility and
        elements at once."""
        return self.method.name == "hierarchical"

    @property
    def photons(self):
        """So many as that their noise falls as the elements do: each half of an edge has four times as many elements."""
        return 1_000_000 * 8 ** self.step


def settings_of(scene):
    """All settings of a scene, those with the same elements after one another."""
    finest = scene.resolutions[-1]
    found = []
    for method in METHODS:
        if (method.is_view or method is PHOTONS) and scene.exact is not None:
            continue  # they are judged by pictures alone
        if method.subdivision == "camera":
            steps = [(size, scene.options) for size in scene.resolutions]
        elif method.subdivision in ("uniform", "photons"):
            bounded = without(scene.options, "--max-edge")
            steps = [(finest, (*bounded, "--max-edge", str(edge))) for edge in scene.edges]
        elif method.subdivision == "transport":
            bounded = without(scene.options, "--max-edge")
            steps = [(finest, (*bounded, "--block-error", str(error))) for error in scene.block_errors]
        else:
            # A scene file that has a max-edge allows no `--subdivision none`.
            steps = [(finest, (*without(scene.options, "--max-edge"), "--max-edge", "1e9"))]
        for step, (size, options) in enumerate(steps):
            subdivision = "uniform" if method.subdivision in ("none", "photons") else method.subdivision
            mesh = (*options, "--subdivision", subdivision, "--resolution", f"{size}x{size}")
            found.append(Setting(method, step, size, mesh))
    return sorted(found, key=lambda setting: setting.mesh)


def without(options, name):
    """The options but for NAME and its value."""
    kept = list(options)
    if name in kept:
        at = kept.index(name)
        del kept[at:at + 2]
    return tuple(kept)
