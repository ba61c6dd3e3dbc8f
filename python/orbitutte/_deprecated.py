# SPDX-License-Identifier: MIT
"""Names of earlier versions, which work for one more version with a DeprecationWarning."""
from __future__ import annotations

import functools
import warnings
from collections.abc import Callable
from typing import Any


def tell(old: str, new: str, stacklevel: int = 3) -> None:
    """Warns that `old` is now called `new`."""
    warnings.warn(f"{old} is deprecated: its name is now {new}", DeprecationWarning, stacklevel=stacklevel)


def renamed_arguments(**new_names: str) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """A function that also takes arguments by their old names: old=new."""

    def decorate(function: Callable[..., Any]) -> Callable[..., Any]:
        @functools.wraps(function)
        def call(*arguments: Any, **named: Any) -> Any:
            for old, new in new_names.items():
                if old in named:
                    tell(f"the argument {old} of {function.__name__}", new)
                    if new in named:
                        raise TypeError(f"{function.__name__} got both {new} and {old}; leave out {old}")
                    named[new] = named.pop(old)
            return function(*arguments, **named)

        return call

    return decorate


def renamed_field(old: str, new: str) -> Any:
    """A property `old` with the value of `new`."""

    def value(self: Any) -> Any:
        tell(f"{type(self).__name__}.{old}", new)
        return getattr(self, new)

    return property(value, doc=f"Deprecated: its name is now {new}.")
