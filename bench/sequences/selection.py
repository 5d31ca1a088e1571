#!/usr/bin/python3
"""By how much errors are too small where a measurement ends at the first look at which they are small enough.

Independent samples by 16 randomisations, looks at 4, 5, 6, 7, 8, 10, 12, ... samples, from 16 on; the target lies between those of 300
and 600 samples. Prints, for as many sensors that share in the error, and errors stated as so many times what is found: the part of true
errors within 1, 2 and 3 stated ones (Student's t of 15 degrees of freedom: 66.7, 93.6, 99.1 %), their root mean square over the stated one,
and the samples that are taken over what the target needs.

    bench/sequences/selection.py
"""

import math

import numpy as np

RANDOMISATIONS, LEAST, RUNS = 16, 16, 8000


def looks():
    samples = 4
    while samples < 200_000:
        yield samples
        samples += max(1, (1 << samples.bit_length() - 1) // 4)


def stopped(random, sensors, factor):
    """Deviations of one run from their mean, over the stated errors; both; samples over those that the target needs."""
    needed = math.exp(random.uniform(math.log(300), math.log(600)))
    deviation = math.sqrt(needed * RANDOMISATIONS)  # of a sample, so that the error is 1 there
    sums, before = np.zeros((sensors, RANDOMISATIONS)), 0
    for samples in looks():
        sums += random.normal(size=sums.shape) * math.sqrt(samples - before) * deviation
        before = samples
        means = sums / samples
        squares = means.var(axis=1, ddof=1) / RANDOMISATIONS
        if samples >= LEAST and factor * math.sqrt(squares.mean()) <= 1:
            return means.mean(axis=1), factor * np.sqrt(squares), samples / needed
    raise RuntimeError("it does not end")


def main():
    random = np.random.default_rng(1)
    print("| sensors | factor | within 1, 2, 3 [%] | rms true / stated | samples / needed |\n| ---: | ---: | ---: | ---: | ---: |")
    for sensors in (1, 2, 4, 16):
        for factor in (1, 1 + 0.08 / sensors):
            runs = [stopped(random, sensors, factor) for _ in range(RUNS // sensors)]
            off, stated = (np.concatenate([run[k] for run in runs]) for k in (0, 1))
            within = ", ".join(f"{100 * np.mean(np.abs(off) <= k * stated):.1f}" for k in (1, 2, 3))
            true = math.sqrt(np.sum(off**2) / np.sum(stated**2))
            print(f"| {sensors} | {factor:.3f} | {within} | {true:.3f} | {np.mean([run[2] for run in runs]):.2f} |")


if __name__ == "__main__":
    main()
