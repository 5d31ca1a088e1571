"""Runs of Fluxel by the matrix method, pictures of its references, and errors of pictures."""

import functools
import subprocess
import sys
import warnings

import numpy as np

from outcome import OUT, ROOT

sys.path += [str(ROOT / "python"), str(ROOT / "bench")]
import fluxel

FLUXEL = ROOT / "build/release/app/fluxel"
BENCHES = ROOT / "build/release/bench"
RAYS = 60_000_000  # of a reference: its noise, which is taken out of all errors, is 4 % at 50 x 50 pixels


def scene_file(name):
    return ROOT / "scenes" / name / f"{name}.toml"


def solve(scene, **options):
    """Of a scene of the project by its name, or of a file, as the paper has it: pictures show the elements, and there are no
    estimates and audits of the error."""
    file = scene_file(scene) if isinstance(scene, str) else scene
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fluxel.NotReachedWarning)  # some rules diverge, which is reported
        return fluxel.solve(file, executable=FLUXEL,
                            **{"method": "matrix", "picture": "elements", "no_error_estimate": True, "audit": 0, **options})


def picture(scene, size, **options):
    """(size, size, 3) radiance, one ray a pixel."""
    return solve(scene, resolution=(size, size), supersample=1, **options).picture


@functools.cache
def truth(scene, size, area=False, **options):
    """The picture by paths of light: of the points that pixels of one ray show, or of their whole area."""
    out = OUT / "references" / f"{scene}-{size}{'-area' if area else ''}"
    found = fluxel.reference(scene_file(scene), out=out, executable=FLUXEL, only="picture", sampling="even", rays=RAYS,
                             resolution=(size, size), **({} if area else {"supersample": 1}), **options)
    return found.picture


def error(judged, reference, where=None):
    """Root mean square error of radiances over the reference's mean, of the worst colour, without the reference's noise;
    `where`: of these pixels alone."""
    where = np.ones(reference.shape, bool) if where is None else where
    square = ((judged - reference.values)[where].astype(float) ** 2).mean(axis=0)
    noise = (reference.error[where].astype(float) ** 2).mean(axis=0)
    return float(np.sqrt(np.maximum(square - noise, 0)).max() / reference.values[where].mean())


def bench(name, *arguments):
    """Runs a bench program and hands on what it prints."""
    program = BENCHES / name / f"{name}_bench"
    if not program.exists():
        sys.exit(f"{program} is not there: run scripts/build first")
    print(flush=True)
    done = subprocess.run([str(program), *map(str, arguments)], check=False)
    if done.returncode:
        sys.exit(f"{program.name} ended with {done.returncode}")


def percent(value):
    return f"{100 * value:.3g} %"
