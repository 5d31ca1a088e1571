"""The paper's table beside the measured one, as text, Markdown and CSV."""

import csv

from jobs import PHASES

# Debelov & Sattarov, Parallel radiosity algorithm with simplified calculation of form-factors, section 5.2: a scene of
# 2391 triangles on five nodes of two processors. The master assigned and did not compute.
PAPER_SECONDS = {2: 6500, 3: 3026, 4: 1850, 5: 1534, 6: 1345, 7: 1123, 8: 907, 9: 580, 10: 503}


class Comparison:
    """Measured runs by number of ranks, against np 1 and, as in the paper, against np 2, where these were run."""

    def __init__(self, runs, cores):
        self.runs = runs
        self.cores = cores

    def fits(self, ranks):
        """Whether every rank has a core, so that a speed-up means something."""
        return ranks <= self.cores

    def speedup(self, ranks, base):
        """Of the whole run over that of `base` ranks, no more than `ranks`; None where it would be pretended."""
        if base not in self.runs or ranks < base or not self.fits(ranks):
            return None
        return self.runs[base].wall / self.runs[ranks].wall

    def efficiency(self, ranks, base):
        speedup = self.speedup(ranks, base)
        return None if speedup is None else speedup * base / ranks

    def inflation(self, ranks):
        """Processor time of all ranks over that of one rank."""
        return self.runs[ranks].cpu / self.runs[1].cpu if 1 in self.runs else None

    def phase_inflation(self, ranks, phase):
        """Of one phase; None where np 1 spends less than a hundredth of a second in it, which is not measured well."""
        if 1 not in self.runs or self.runs[1].phase_cpu[phase] < 0.01:
            return None
        return self.runs[ranks].phase_cpu[phase] / self.runs[1].phase_cpu[phase]

    def note(self):
        crowded = [ranks for ranks in self.runs if not self.fits(ranks)]
        if not crowded:
            return f"{self.cores} cores: every rank had one."
        return (f"This machine has {self.cores} cores: np {', '.join(map(str, crowded))} shared them, so no speed-up is "
                "given for these, but CPU-time inflation: processor time of all ranks over that of np 1.")


def number(value, digits):
    return "-" if value is None else f"{value:.{digits}f}"


def paper_rows(comparison):
    """Title and cells, a column for each number of ranks."""
    counts = list(comparison.runs)
    runs = comparison.runs.values()
    base = PAPER_SECONDS[2]
    return [
        ("processors", [str(ranks) for ranks in counts]),
        ("paper, s", [number(PAPER_SECONDS.get(ranks), 0) for ranks in counts]),
        ("paper, speed-up over 2", [number(base / PAPER_SECONDS[ranks] if ranks in PAPER_SECONDS else None, 2)
                                    for ranks in counts]),
        ("Fluxel, s", [number(run.wall, 1) for run in runs]),
        ("speed-up over 2", [number(comparison.speedup(ranks, 2), 2) for ranks in counts]),
        ("efficiency over 2", [number(comparison.efficiency(ranks, 2), 2) for ranks in counts]),
        ("speed-up over 1", [number(comparison.speedup(ranks, 1), 2) for ranks in counts]),
        ("efficiency over 1", [number(comparison.efficiency(ranks, 1), 2) for ranks in counts]),
        ("CPU time of all ranks, s", [number(run.cpu, 1) for run in runs]),
        ("CPU-time inflation", [number(comparison.inflation(ranks), 3) for ranks in counts]),
        ("idle, %", [number(100 * run.idle, 1) for run in runs]),
        ("tiles and corrections sent, MB", [number(1e-6 * run.bytes_sent, 2) for run in runs]),
    ]


def phase_rows(comparison):
    """Wall-clock seconds of each phase, then its CPU-time inflation."""
    counts = list(comparison.runs)
    rows = [("processors", [str(ranks) for ranks in counts])]
    for phase in PHASES:
        name = phase.replace("_", " ")
        rows.append((f"{name}, s", [number(run.phase_wall[phase], 2) for run in comparison.runs.values()]))
        rows.append((f"{name}, CPU-time inflation",
                     [number(comparison.phase_inflation(ranks, phase), 3) for ranks in counts]))
    return rows


def as_text(rows):
    width = max(len(title) for title, _ in rows)
    return "\n".join(f"{title:<{width}}" + "".join(f"{cell:>9}" for cell in cells) for title, cells in rows)


def as_markdown(rows):
    lines = [f"| {title} | {' | '.join(cells)} |" for title, cells in rows]
    lines.insert(1, "| --- |" + " ---: |" * len(rows[0][1]))
    return "\n".join(lines)


def write_csv(file, comparison):
    """A line for each number of ranks; empty where a speed-up would be pretended."""
    with open(file, "w", newline="", encoding="utf-8") as out:
        writer = csv.writer(out)
        writer.writerow(["ranks", "cores", "elements", "wall_s", "cpu_s", "speedup_over_1", "speedup_over_2",
                         "cpu_inflation", "idle_share", "bytes_sent", "hash", *(f"{phase}_wall_s" for phase in PHASES),
                         *(f"{phase}_cpu_s" for phase in PHASES)])
        for ranks, run in comparison.runs.items():
            writer.writerow([ranks, comparison.cores, run.elements, round(run.wall, 3), round(run.cpu, 3),
                             comparison.speedup(ranks, 1), comparison.speedup(ranks, 2), comparison.inflation(ranks),
                             run.idle, run.bytes_sent, run.hash, *(run.phase_wall[phase] for phase in PHASES),
                             *(run.phase_cpu[phase] for phase in PHASES)])
