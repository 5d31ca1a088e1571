"""Reports as docs/schema describes them: validators, and what every report of a run has to be like."""

import functools
import json
import re
from pathlib import Path

import jsonschema

SCHEMAS = Path(__file__).resolve().parents[2] / "docs" / "schema"
NAMES = ("report", "reference", "photons", "compare")  # of reports and of their schemas
SNAKE_CASE = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")
# Objects whose keys are names of a scene: receivers, observers, kinds of sensors. A phase may be named after a receiver.
NAMED_BY_SCENE = {"receivers", "observers", "measured"}
NAMED_PHASE = "receiver_"


@functools.cache
def schema(name):
    """One schema with the definitions that all have in common, which it refers to as to a file beside it."""
    whole, common = (json.loads((SCHEMAS / f"{file}.schema.json").read_text(encoding="utf-8").replace('"common.schema.json#', '"#'))
                     for file in (name, "common"))
    whole["$defs"] = {**common["$defs"], **whole.get("$defs", {})}
    return whole


@functools.cache
def validator(name):
    return jsonschema.Draft202012Validator(schema(name))


def faults(name, report):
    """What is wrong with a report: its place there, and why."""
    found = [f"{error.json_path}: {error.message[:300]}" for error in validator(name).iter_errors(report)]
    return found + [f"{place}: the key is not in snake case" for place in keys_not_in_snake_case(report)]


def keys_not_in_snake_case(value, place="$", is_named=False):
    if isinstance(value, list):
        for k, part in enumerate(value):
            yield from keys_not_in_snake_case(part, f"{place}[{k}]")
    elif isinstance(value, dict):
        for key, part in value.items():
            at = f"{place}.{key}"
            if not (is_named or SNAKE_CASE.fullmatch(key) or place == "$.progress" and key.startswith(NAMED_PHASE)):
                yield at
            yield from keys_not_in_snake_case(part, at, place == "$" and key in NAMED_BY_SCENE)


def check_reports(folder, since=0.0):
    """An AssertionError if any JSON file there, written since then [s since the epoch], is not as its schema has it."""
    folder = Path(folder)
    for file in sorted(folder.glob("*.json")) if folder.is_dir() else ():
        if file.stat().st_mtime < since:
            continue
        assert file.stem in NAMES, f"{file} has no schema in {SCHEMAS}"
        found = faults(file.stem, json.loads(file.read_text(encoding="utf-8")))
        assert not found, f"{file} is not as docs/schema/{file.stem}.schema.json has it:\n" + "\n".join(found[:20])


def output_folder(arguments):
    """What --out names on a command line; None without."""
    words = list(map(str, arguments))
    for k, word in enumerate(words):
        if word == "--out" and k + 1 < len(words):
            return words[k + 1]
        if word.startswith("--out="):
            return word.removeprefix("--out=")
    return None
