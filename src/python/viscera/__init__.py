# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Soft tissue that is touched, cut and felt, stepped in this process. docs/python.md has an example and a table.

Lengths are in metres, forces in newtons, times in seconds; poses are in the tissue frame.
"""
import pkgutil

__all__ = ["Error", "GpuError", "LatticeError", "MeshError", "Scene", "SceneError", "Session", "Skin", "Stylus",
           "VectorSession", "__version__"]
# viscera.msg and viscera.srv, which ROS makes, may lie in a folder of this name that comes later in the path.
__path__ = pkgutil.extend_path(__path__, __name__)


def __getattr__(name):
    """Loads the simulator when it is first asked for: a program that wants the messages of ROS alone has no use for it."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from . import _scene
    globals().update((each, getattr(_scene, each)) for each in __all__)
    return globals()[name]


def __dir__():
    return sorted(set(globals()) | set(__all__))
