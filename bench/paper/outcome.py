"""What is made of the paper, what it came to, and how both are shown."""

import csv
import os
import textwrap
from dataclasses import dataclass, field
from pathlib import Path
from typing import Callable

ROOT = Path(__file__).resolve().parents[2]
OUT = ROOT / "out/paper"
WIDTH = 110  # characters a line


@dataclass
class Outcome:
    """
    heads, rows: the table, as text
    found: what it came to, in a few words and figures
    checks: (what is expected, whether it is so)
    """

    heads: tuple
    rows: list
    found: str
    checks: list = field(default_factory=list)

    def expect(self, text, holds):
        self.checks.append((text, bool(holds)))

    @property
    def met(self):
        return all(holds for _, holds in self.checks)


@dataclass(frozen=True)
class Row:
    """
    name: by which it is called
    place: where the paper has it
    says: what the paper says there
    does: what is done here
    minutes: on 2 cores
    verdict: of the paper's words, where the expectations are met
    make: folder of its files -> Outcome
    """

    name: str
    place: str
    title: str
    says: str
    does: str
    minutes: float
    verdict: str
    make: Callable[[Path], Outcome]


def print_head(row):
    print(f"\n{'=' * WIDTH}\n{row.name}: {row.title} ({row.place})")
    for label, text in (("paper", row.says), ("here", row.does), ("time", f"about {row.minutes:g} minutes on 2 cores")):
        print(textwrap.fill(f"{label + ':':<7}{text}", WIDTH, subsequent_indent=" " * 7), flush=True)


def print_table(outcome):
    lines = [outcome.heads, *outcome.rows]
    widths = [max(len(str(line[column])) for line in lines) for column in range(len(outcome.heads))]
    print()
    for line in lines:
        first, *others = (str(cell) for cell in line)
        print("  ".join([f"{first:<{widths[0]}}", *(f"{cell:>{width}}" for cell, width in zip(others, widths[1:]))]))


def print_outcome(row, outcome, minutes):
    print_table(outcome)
    print()
    for text, holds in outcome.checks:
        print(f"{'yes' if holds else 'NO '}    {text}")
    print(textwrap.fill(f"found: {outcome.found}", WIDTH, subsequent_indent=" " * 7))
    print(f"files: {OUT / row.name}; {minutes:.1f} minutes")
    print(textwrap.fill(f"VERDICT {verdict(row, outcome)}", WIDTH, subsequent_indent=" " * 8), flush=True)


def verdict(row, outcome):
    return row.verdict if outcome.met else "not as expected: " + "; ".join(text for text, holds in outcome.checks if not holds)


def write_csv(path, outcome):
    with open(path, "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([outcome.heads, *outcome.rows])


def processor():
    for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return line.partition(":")[2].strip()
    return "unknown processor"


def write_summary(path, made):
    """The table of docs/paper.md."""
    lines = [f"Machine: {processor()}, {len(os.sched_getaffinity(0))} cores. All together took "
             f"{sum(minutes for *_, minutes in made):.0f} minutes.", "",
             "| `bench/paper/paper ...` | in the paper | the paper says | expected | it came to | verdict | min |",
             "| --- | --- | --- | --- | --- | --- | ---: |"]
    for row, outcome, minutes in made:
        expected = "; ".join(text for text, _ in outcome.checks)
        lines.append(f"| `{row.name}` | {row.place} | {row.says} | {expected} | {outcome.found} | {verdict(row, outcome)} | "
                     f"{minutes:.1f} |")
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
