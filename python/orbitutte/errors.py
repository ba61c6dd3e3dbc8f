# SPDX-License-Identifier: MIT
"""The exceptions and the warnings of orbitutte. Memory that runs out is Python's own MemoryError."""


class Error(Exception):
    """The family of all exceptions that orbitutte raises on purpose. The message is one sentence."""


class MeshError(Error, ValueError):
    """The mesh, or the vertices marked on it, cannot be embedded as asked; names the vertex, edge or face."""


class ArgumentError(Error, ValueError):
    """An argument has no meaning: a signature that names no orbifold, an option out of its range."""


class FileError(Error, OSError):
    """A file could not be opened, read or written."""


class Cancelled(Error):
    """A progress callback returned False."""


class EmbeddingWarning(UserWarning):
    """An embedding did not converge, or is not certified, or something about it deserves a look."""


class MeshWarning(UserWarning):
    """Something in the file of a mesh was ignored although it may matter."""


for _class in (Error, MeshError, ArgumentError, FileError, Cancelled, EmbeddingWarning, MeshWarning):
    _class.__module__ = "orbitutte"
