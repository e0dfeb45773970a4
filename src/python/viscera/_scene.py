# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""The Python part of the package viscera, on top of the compiled part."""
import json
import os

from . import _libraries

_libraries.load_missing()

from ._viscera import (Error, GpuError, LatticeError, MeshError, SceneBase, SceneError, Session, Skin, Stylus,
                       VectorSession, __version__)  # noqa: E402  after its libraries are loaded


def _shipped(name):
    """Returns the file of a shipped scene: below share/ of this package or an installed prefix, or in a build's sources."""
    up = os.path.abspath(__file__)
    while os.path.dirname(up) != up:
        up = os.path.dirname(up)
        config = os.path.join(up, "share", "viscera", "config")
        try:
            with open(os.path.join(up, "share", "viscera", "config_folder.txt"), encoding="utf-8") as file:
                config = file.read().strip()
        except OSError:
            pass  # installed
        file = os.path.join(config, "scenes", name + ".yaml")
        if os.path.exists(file):
            return file
    raise SceneError(f"'{name}' is neither a file nor the name of a shipped scene")


class Scene(SceneBase):
    """A validated scene.

    source     a file, the name of a shipped scene, YAML text (of several lines), or a dict of the same keys
    overrides  in the syntax of --set on the command line: strings "key=value", or a dict from key to value
    mesh       mesh file for the first body; for scenes from files
    Raises SceneError with file, line, key and accepted range.
    """

    def __init__(self, source, overrides=(), mesh=""):
        file = text = label = ""
        if isinstance(source, dict):
            try:
                text, label = json.dumps(source, ensure_ascii=False, allow_nan=False), "dict"
            except (TypeError, ValueError, RecursionError) as error:
                raise SceneError(f"dict: {error}") from None
        elif isinstance(source, str) and "\n" in source:
            text, label = source, "text"
        else:
            file = os.fspath(source)
            if not isinstance(file, str):
                raise TypeError("source: must be a file, a name, text or a dict")
            if not os.path.exists(file) and "/" not in file:
                file = _shipped(file)
        if mesh and not file:
            raise SceneError("mesh: for scenes from files; name it in bodies[0].mesh here")
        if isinstance(overrides, dict):
            overrides = [f"{key}={json.dumps(value) if not isinstance(value, str) else value}"
                         for key, value in overrides.items()]
        elif isinstance(overrides, str):
            overrides = [overrides]
        super().__init__(file=file, text=text, label=label, mesh=os.fspath(mesh), overrides=list(overrides))

    def __repr__(self):
        return f"viscera.Scene({self.name!r}, bodies={self.bodies}, styluses={self.styluses})"


for _public in (Error, GpuError, LatticeError, MeshError, Scene, SceneError, Session, Skin, Stylus, VectorSession):
    _public.__module__ = __package__  # the public name, also for pickle and tracebacks
