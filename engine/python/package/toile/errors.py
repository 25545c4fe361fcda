"""What goes wrong, as exceptions: a class for programs, a sentence with the cure for people."""

__all__ = ["DeviceError", "InputError", "InternalError", "ToileError", "UsageError"]


class ToileError(Exception):
    """A call that cannot be done; its text is one sentence that says what, where and what cures it.

    Attributes
    ----------
    kind : str
        "usage", "input", "device" or "internal"; each has a class of its own.
    """

    kind = "internal"


class UsageError(ToileError):
    """The call itself: a garment's number that there is not, a scene that was closed or is at work, a word that is not known."""

    kind = "usage"


class InputError(ToileError, ValueError):
    """What was given: a file, a name, a measure, an array's shape or numbers."""

    kind = "input"


class DeviceError(ToileError, OSError):
    """What the system does not give: a thread, a file that can be written."""

    kind = "device"


class InternalError(ToileError):
    """A fault of Toile's own. The scene that was called, if any, can only be closed."""

    kind = "internal"
