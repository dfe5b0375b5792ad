"""What each function of trace.ptx takes of a card's threads, by NVIDIA's assembler: `registers.py PTXAS`.

Prints a row for each function with registers and bytes of stack for every architecture, and ends with 1 if any spills
registers or is not assembled.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

PTX = Path(__file__).resolve().parents[1] / "crates/trove-render/src/card/trace.ptx"
# From Turing on, the oldest that trace.ptx is made for.
ARCHITECTURES = ("sm_75", "sm_80", "sm_86", "sm_89", "sm_90", "sm_100", "sm_120")
ENTRY = re.compile(r"Compiling entry function '(\w+)'")
SPILLS = re.compile(r"(\d+) bytes spill stores, (\d+) bytes spill loads")
REGISTERS = re.compile(r"Used (\d+) registers")
STACK = re.compile(r"(\d+) bytes cumulative stack size")


def functions(ptxas: str, architecture: str) -> dict[str, list[int]]:
    """Registers, stack and spills of each function, the two last in bytes."""
    with tempfile.TemporaryDirectory() as folder:
        command = [ptxas, f"-arch={architecture}", "-v", "-o", f"{folder}/trace.cubin", str(PTX)]
        done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{PTX} is not assembled for {architecture}: {done.stdout}{done.stderr}")
    found: dict[str, list[int]] = {}
    name = ""
    # Functions that an entry calls are told of after it.
    for line in (done.stdout + done.stderr).splitlines():
        if entry := ENTRY.search(line):
            name = entry[1]
            found[name] = [0, 0, 0]
        if used := REGISTERS.search(line):
            found[name][0] = int(used[1])
        if stack := STACK.search(line):
            found[name][1] = int(stack[1])
        if spilled := SPILLS.search(line):
            found[name][2] += sum(map(int, spilled.groups()))
    return found


def main() -> None:
    [ptxas] = sys.argv[1:]
    by_architecture = {architecture: functions(ptxas, architecture) for architecture in ARCHITECTURES}
    print("| registers, bytes of stack |", " | ".join(ARCHITECTURES), "|")
    print("|---" * (1 + len(ARCHITECTURES)) + "|")
    spilled = []
    for name in sorted(by_architecture[ARCHITECTURES[0]]):
        row = []
        for architecture, found in by_architecture.items():
            registers, stack, spills = found[name]
            row.append(f"{registers}, {stack}")
            if spills:
                spilled.append(f"{name} on {architecture}: {spills} bytes")
        print(f"| `{name}` |", " | ".join(row), "|")
    if spilled:
        raise SystemExit("registers are spilled: " + "; ".join(spilled))


if __name__ == "__main__":
    main()
