"""Plants faults in a copy of the sources, one at a time, and shows that a test catches each.

Every `*.patch` beside this file is one fault. Its first line says what is broken and which test has to fail:

    WHAT; caught by cargo test ARGUMENTS -- NAME

A fault counts as caught only if that test runs and fails; a patch that no longer applies, sources that no longer
compile and a test that is gone or fails without the fault are errors. `run.py [NAME …]` plants only the faults named.
"""

import argparse
import os
import re
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
TREE = ROOT / "target" / "planted" / "tree"
# Dependencies have been built here before; our own crates differ by their path, so none of theirs is replaced.
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
HEADER = re.compile(r"(?P<what>.+); caught by cargo test (?P<arguments>.+) -- (?P<test>\S+)")
LONGEST_S = 1800
# Compiled again for every fault, our crates are quicker unoptimised.
OPTIMISED = ("", "package.trove-render.", "package.trove-trace.", "package.trove-assets.", "package.trove-judge.")
QUICK = tuple(word for which in OPTIMISED for word in ("--config", f"profile.dev.{which}opt-level=0"))


class Fault:
    """A patch with its header."""

    def __init__(self, path):
        self.name, self.path = path.stem, path
        first = path.read_text().splitlines()[0]
        found = HEADER.fullmatch(first)
        if found is None:
            raise SystemExit(f"{path}:1: expected 'WHAT; caught by cargo test ARGUMENTS -- NAME', found {first!r}")
        self.what, self.test = found["what"], found["test"]
        self.arguments = tuple(found["arguments"].split())


def in_tree(*command):
    """Runs a command in the copy, which git is not to take for a part of this repository."""
    environment = {**os.environ, "CARGO_TARGET_DIR": str(TARGET), "GIT_CEILING_DIRECTORIES": str(TREE.parent)}
    environment.pop("GIT_DIR", None)
    return subprocess.run(
        command,
        cwd=TREE,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=LONGEST_S,
    )


def restore():
    """Makes the copy equal to the tracked files as they are now; only what differs is written, so the rest stays built."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True).stdout
    names = {Path(os.fsdecode(name)) for name in listed.split(b"\0") if name}
    names = {name for name in names if (ROOT / name).is_file()}
    for name in names:
        wanted, copy = (ROOT / name).read_bytes(), TREE / name
        if not copy.is_file() or copy.read_bytes() != wanted:
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(wanted)
    for copy in TREE.rglob("*"):
        if copy.is_file() and copy.relative_to(TREE) not in names:
            copy.unlink()


def outcomes(arguments, tests):
    """What became of each named test, `ok` or `FAILED`, and all that cargo said."""
    done = in_tree("cargo", "test", "--locked", *QUICK, *arguments, "--", "--exact", *tests)
    found = dict(re.findall(r"^test (\S+) \.\.\. (ok|FAILED)$", done.stdout, re.MULTILINE))
    return {test: found.get(test) for test in tests}, done.stdout


def fail_without_fault(faults):
    """Whether any named test fails, or is not there, while nothing is broken."""
    bad = False
    for arguments in sorted({fault.arguments for fault in faults}):
        tests = sorted({fault.test for fault in faults if fault.arguments == arguments})
        found, said = outcomes(arguments, tests)
        for test in (test for test in tests if found[test] != "ok"):
            bad = True
            print(f"{test}: expected it to pass while nothing is broken, found {found[test] or 'no such test'}")
        if bad:
            print("\n".join(said.splitlines()[-40:]))
    return bad


def plant(fault):
    """One of `caught`, `NOT CAUGHT` and an error."""
    applied = in_tree("git", "apply", str(fault.path))
    if applied.returncode != 0:
        return f"error: the patch does not apply: {applied.stdout.strip()}"
    try:
        found, said = outcomes(fault.arguments, [fault.test])
    except subprocess.TimeoutExpired:
        return f"error: no end after {LONGEST_S} s"
    finally:
        restore()
    match found[fault.test]:
        case "FAILED":
            return "caught"
        case "ok":
            return "NOT CAUGHT"
        case _:
            print("\n".join(said.splitlines()[-40:]))
            return "error: the test did not run"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", help="faults to plant (default: all)")
    names = parser.parse_args().names
    faults = [Fault(path) for path in sorted(HERE.glob("*.patch")) if not names or path.stem in names]
    if unknown := set(names) - {fault.name for fault in faults}:
        parser.error(f"no such fault: {', '.join(sorted(unknown))}")
    TREE.mkdir(parents=True, exist_ok=True)
    restore()
    if fail_without_fault(faults):
        return 1
    rows = []
    for fault in sorted(faults, key=lambda fault: fault.arguments):
        started = time.monotonic()
        rows.append((fault, plant(fault), time.monotonic() - started))
        print(f"{fault.name}: {rows[-1][1]}", flush=True)
    width = max(len(fault.name) for fault in faults)
    print(f"\n{'fault':{width}}  {'':10}  {'s':>4}  what is broken, and the test that fails")
    for fault, outcome, seconds in rows:
        print(f"{fault.name:{width}}  {outcome:10}  {seconds:4.0f}  {fault.what}: {fault.test}")
    caught = sum(outcome == "caught" for _, outcome, _ in rows)
    print(f"{caught} of {len(rows)} faults caught")
    return 0 if caught == len(rows) else 1


if __name__ == "__main__":
    sys.exit(main())
