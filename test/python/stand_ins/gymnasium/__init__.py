# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Stand-in for Gymnasium, which Debian does not package: what viscera.gym uses of its API, as strict as its documentation.

It is not Gymnasium, and is for tests alone. utils.env_checker has the rules of Gymnasium's check_env and of its passive checker.
"""
from . import spaces, vector
from .core import Env, Wrapper
from .spaces import Space

__all__ = ["Env", "Space", "Wrapper", "spaces", "vector"]
__version__ = "1.1"
