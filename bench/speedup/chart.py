"""Charts of the table of speed-ups."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot

from jobs import PHASES
from tables import PAPER_SECONDS

# Okabe & Ito's palette, told apart with any colour vision.
BLUE, ORANGE, GREY = "#0072B2", "#E69F00", "#7F7F7F"
PHASE_COLOURS = dict(zip(PHASES, ("#7F7F7F", "#F0E442", "#CC79A7", "#0072B2", "#E69F00", "#009E73", "#D55E00")))


def tidy(axes, title, label):
    axes.set_title(title, fontsize=10, loc="left")
    axes.set_xlabel("ranks of one thread")
    axes.set_ylabel(label)
    axes.grid(axis="y", color="#D9D9D9", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.xaxis.get_major_locator().set_params(integer=True)


def shade_crowded(axes, comparison):
    """Marks where ranks share cores."""
    most = max(comparison.runs)
    if comparison.fits(most):
        return
    axes.axvspan(comparison.cores + 0.5, most + 0.5, color="#F0F0F0", zorder=0)
    axes.annotate(f"more ranks than the {comparison.cores} cores", (comparison.cores + 0.6, 0.02),
                  xycoords=("data", "axes fraction"), fontsize=8, color="#4D4D4D")


def draw_speedup(comparison, path):
    """Speed-up over two processors beside the paper's, and CPU-time inflation."""
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(10, 4), layout="constrained")
    paper = sorted(PAPER_SECONDS)
    left.plot(paper, [PAPER_SECONDS[2] / PAPER_SECONDS[ranks] for ranks in paper], "s-", color=ORANGE,
              label="paper (its master does not compute)")
    left.plot(paper, [ranks / 2 for ranks in paper], "--", color=GREY, label="ranks / 2")
    measured = [(ranks, comparison.speedup(ranks, 2)) for ranks in comparison.runs]
    measured = [point for point in measured if point[1] is not None]
    if measured:
        left.plot(*zip(*measured), "o-", color=BLUE, label="Fluxel")
    shade_crowded(left, comparison)
    tidy(left, "Speed-up over two processors", "times as fast")
    left.legend(fontsize=8, frameon=False)

    if 1 in comparison.runs:
        right.plot(list(comparison.runs), [comparison.inflation(ranks) for ranks in comparison.runs], "o-", color=BLUE)
    right.axhline(1, color=GREY, linestyle="--", linewidth=1)
    right.set_ylim(bottom=min(0.9, right.get_ylim()[0]))
    shade_crowded(right, comparison)
    tidy(right, "CPU-time inflation", "processor time over that of one rank")
    figure.savefig(path, dpi=110)
    pyplot.close(figure)


def draw_phases(comparison, path):
    """Processor seconds by phase."""
    figure, axes = pyplot.subplots(figsize=(8, 4), layout="constrained")
    counts = list(comparison.runs)
    bottom = [0.0] * len(counts)
    for phase in PHASES:
        heights = [run.phase_cpu[phase] for run in comparison.runs.values()]
        axes.bar(counts, heights, bottom=bottom, color=PHASE_COLOURS[phase], label=phase.replace("_", " "))
        bottom = [low + height for low, height in zip(bottom, heights)]
    tidy(axes, "Processor time of all ranks by phase", "s")
    axes.legend(fontsize=8, frameon=False, loc="upper left", bbox_to_anchor=(1, 1))
    figure.savefig(path, dpi=110)
    pyplot.close(figure)
