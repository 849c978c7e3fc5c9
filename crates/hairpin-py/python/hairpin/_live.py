"""A view of a job while it runs: a line in a terminal, a bar in a notebook."""

from __future__ import annotations

import contextlib
import sys
from typing import Any


class _Line:
    def __init__(self) -> None:
        self._width = 0

    def __call__(self, what: str, done: int, of: int) -> None:
        text = f"{what} {done}/{of}"
        end = "\n" if done >= of else ""
        # Who looks on no more, or never did, stops no job.
        with contextlib.suppress(OSError, ValueError, AttributeError):
            sys.stderr.write("\r" + text.ljust(self._width) + end)
            sys.stderr.flush()
        self._width = 0 if end else len(text)


class _Cell:
    def __init__(self, display: Any) -> None:
        self._handle: Any = None
        self._display = display

    def __call__(self, what: str, done: int, of: int) -> None:
        from IPython.display import HTML

        bar = HTML(f"<progress value='{done}' max='{max(of, 1)}'></progress> {what} {done}/{of}")
        if self._handle is None:
            self._handle = self._display(bar, display_id=True)
        else:
            self._handle.update(bar)


def live() -> Any:
    """A `progress` that shows how far a job is: a bar in a notebook, a line on stderr elsewhere.

    >>> import hairpin
    >>> show = hairpin.live()
    >>> callable(show)
    True
    """
    try:
        from IPython import get_ipython
        from IPython.display import display

        if get_ipython() is not None and hasattr(get_ipython(), "kernel"):
            return _Cell(display)
    except ImportError:
        pass
    return _Line()
