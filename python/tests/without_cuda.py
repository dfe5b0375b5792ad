"""Lets PyTorch's wheel for Linux, installed without CUDA's 3.5 GB, start on the processor.

`python without_cuda.py`, run by the Python that PyTorch is installed in, says of CUDA's libraries which of them
PyTorch is linked with and lacks, and puts one in its place that has the same names and ends the process wherever it
is called. PyTorch itself stays as it is: what it computes on the processor is what it computes everywhere.
It needs a C compiler, and `ldd` to look with.
"""

import importlib.util
import re
import subprocess
import tempfile
from pathlib import Path


def missing(folder):
    """The libraries that PyTorch lacks, each with its symbols' version ("" for none), and all symbols by version."""
    done = subprocess.run(["ldd", "-r", folder / "libtorch_python.so"], capture_output=True, text=True)
    said = done.stdout + done.stderr
    libraries = sorted(set(re.findall(r"(\S+) => not found", said)))
    symbols = {}
    for name, version in re.findall(r"undefined symbol: (\w+)(?:, version (\S+))?", said):
        # Python's own are there as soon as Python runs.
        if not re.match(r"_?Py", name):
            symbols.setdefault(version, set()).add(name)
    return libraries, symbols


def build(path, names, versions):
    """A library at `path` whose functions are `names`, in the symbol versions of `versions`; each is a trap."""
    with tempfile.TemporaryDirectory() as folder:
        source, script = Path(folder) / "traps.c", Path(folder) / "versions.map"
        source.write_text("".join(f"void {name}(void) {{ __builtin_trap(); }}\n" for name in sorted(names)))
        script.write_text("".join(f"{v} {{ global: {'; '.join(sorted(n))}; }};\n" for v, n in versions.items() if v))
        named = [f"-Wl,--version-script={script}"] if any(versions) else []
        subprocess.run(
            ["cc", "-shared", "-nostdlib", "-fno-builtin", f"-Wl,-soname,{path.name}", *named, source, "-o", path],
            check=True,
        )


def main():
    found = importlib.util.find_spec("torch")
    assert found is not None and found.origin is not None, "PyTorch is not installed"
    folder = Path(found.origin).parent / "lib"
    libraries, symbols = missing(folder)
    # A version is called as its library is, except nvshmem's.
    by_library = {name: {} for name in libraries}
    for version, names in symbols.items():
        if version == "NVSHMEM":
            owner = next(name for name in libraries if name.startswith("libnvshmem_host"))
        elif version:
            owner = version
        else:
            owner = next(name for name in libraries if name.startswith("libnccl"))
        by_library[owner][version] = names
    for library, versions in by_library.items():
        build(folder / library, set().union(*versions.values()), versions)
    print(f"PyTorch starts without {', '.join(libraries)}" if libraries else "PyTorch lacks nothing")


if __name__ == "__main__":
    main()
