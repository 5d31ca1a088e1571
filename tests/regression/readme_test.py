"""What continuous integration calls is what the README tells a stranger to call."""

import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def readme_commands():
    """Those of the README's first block of code, without comments."""
    block = (ROOT / "README.md").read_text(encoding="utf-8").split("```")[1]
    return [line.split("#")[0].strip() for line in block.splitlines() if line.strip()]


def script_commands(name):
    lines = (ROOT / name).read_text(encoding="utf-8").splitlines()
    return [line for line in lines if line and not line.startswith(("#", "set ", "cd "))]


class Readme(unittest.TestCase):
    def test_ci_calls_the_test_command_literally_and_first(self):
        first, second = script_commands(".ci/run")
        self.assertEqual(first, readme_commands()[1])
        self.assertRegex(second, r"^scripts/test-more \$\(\(.* % 4 \+ 1\)\)$")

    def test_the_longer_tests_call_the_first_command_literally(self):
        steps = [line for line in script_commands("scripts/test-more") if line.endswith(f" {readme_commands()[0]}")]
        self.assertEqual(len(steps), 1, steps)


if __name__ == "__main__":
    unittest.main()
