"""Tables (CSV) whose rows are kept from run to run."""

import csv
import sys


def number_of(text):
    try:
        return float(text)
    except ValueError:
        return text


def read_rows(path, fields):
    """With numbers where a cell is one; none where there is no file."""
    if not path.exists():
        return []
    with open(path, newline="", encoding="utf-8") as file:
        reader = csv.DictReader(file)
        if tuple(reader.fieldnames or fields) != tuple(fields):
            sys.exit(f"{path} has other columns, of another version: move it away, or name another file")
        return [{key: number_of(value) for key, value in row.items()} for row in reader]


def write_rows(path, fields, rows):
    """A row need not have all fields."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, fields)
        writer.writeheader()
        writer.writerows(rows)
