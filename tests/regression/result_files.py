"""Fluxel's files as plain numbers, whose equality is that of all digits: arrays of the package in python/ as lists."""

import fluxel


def read_exr(file):
    """{channel: [row of values, from the top]}"""
    return {name: values.tolist() for name, values in fluxel.read_picture(file).channels.items()}


def read_elements(file):
    """A list of {"corners": [(x, y, z)], "patch": k, "radiosity": (r, g, b), "error": ...}, one an element."""
    elements = fluxel.read_elements(file)
    vertices = list(map(tuple, elements.vertices.tolist()))
    layers = {name: list(map(tuple, values.tolist())) for name, values in elements.layers.items()}
    return [{"corners": [vertices[k] for k in face if k >= 0], "patch": patch, **{name: layers[name][i] for name in layers}}
            for i, (face, patch) in enumerate(zip(elements.faces.tolist(), elements.patch.tolist(), strict=True))]


def radiosities(file):
    """The radiosity of the front, and where there is one of the back, of all elements: [r, g, b, r, g, b]."""
    layers = fluxel.read_elements(file).layers
    sides = [layers[name].tolist() for name in ("radiosity", "radiosity_back") if name in layers]
    return [sum(of, []) for of in zip(*sides, strict=True)]
