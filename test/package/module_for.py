#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the Python package for the interpreter of another root, with its libraries beside it: module_for.py SOURCES BUILD TOP OUT.

BUILD: a Ninja build of the module viscera_python. TOP: a root with Python, its headers and those of pybind11. OUT: the folder for
the package. Only the sources of src/python are compiled, with the commands of the build; the rest is that of the build.
"""
import importlib.machinery
import importlib.util
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys


def commands(build):
    """Returns what ninja runs for the module: the commands that compile src/python, and the one that links."""
    printed = subprocess.run(["ninja", "-C", str(build), "-t", "commands", "viscera_python"], check=True, capture_output=True, text=True)
    lines = printed.stdout.splitlines()
    return [line for line in lines if re.search(r"-c \S*/src/python/\w+\.cpp", line)], lines[-1]


def wheel_script(sources):
    loader = importlib.machinery.SourceFileLoader("wheel_script", str(sources / "scripts/packaging/wheel"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("wheel_script", loader))
    loader.exec_module(module)
    return module


def main():
    sources, build, top, out = (pathlib.Path(text).resolve() for text in sys.argv[1:5])
    (python,) = [path.name for path in (top / "usr/include").glob("python3.[0-9]*")]
    headers = out / "include"  # these alone: those of the C library are this machine's
    for folder in (python, "pybind11", f"x86_64-linux-gnu/{python}"):
        shutil.copytree(top / "usr/include" / folder, headers / folder)
    package = out / "viscera"
    shutil.copytree(sources / "src/python/viscera", package)
    shutil.copytree(sources / "config", package / "share/viscera/config")
    module = package / f"_viscera.cpython-{python.replace('python', '').replace('.', '')}-x86_64-linux-gnu.so"
    compiling, linking = commands(build)
    assert compiling, f"{build}: no command compiles src/python"
    running = []
    for number, line in enumerate(compiling):
        line = re.sub(r"-isystem /usr/include/python3\.\d+", f"-isystem {headers}/{python} -isystem {headers}", line)
        place = re.search(r" -o (\S+)", line).group(1)
        line = re.sub(r" -MD -MT \S+ -MF \S+", "", line).replace(f" -o {place}", f" -o {out}/{number}.o")
        linking = linking.replace(f" {place}", f" {out}/{number}.o")
        running.append(line)
        if len(running) == os.cpu_count() or number == len(compiling) - 1:
            together = [subprocess.Popen(each, shell=True, cwd=build) for each in running]
            assert not any([each.wait() for each in together]), "the module is not compiled"
            running = []
    linking = re.sub(r" -o \S+", f" -o {shlex.quote(str(module))}", linking)
    subprocess.run(linking, shell=True, cwd=build, check=True)
    script = wheel_script(sources)
    script.strip(module)
    script.add_libraries(module)


if __name__ == "__main__":
    main()
