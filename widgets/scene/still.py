"""The picture of what stands still, kept.

Where a computer draws without a graphics card, a probe of many facets costs 60 ms a frame; its kept picture 2 ms.
"""

from __future__ import annotations

from typing import Any

from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLFramebufferObject

_READ, _DRAW = 0x8CA8, 0x8CA9  # GL_READ_FRAMEBUFFER, GL_DRAW_FRAMEBUFFER
_COLOUR_AND_DEPTH = 0x4000 | 0x0100  # GL_COLOR_BUFFER_BIT, GL_DEPTH_BUFFER_BIT
_NEAREST = 0x2600
_UNSIGNED_CHAR = 3


class StillPicture:
    """
    Keeps colour and depth of the renderer of what stands still.

    Between two frames with the same camera, size and content, its renderer draws nothing: the kept picture is
    copied under what lives. Facets that were painted meanwhile are drawn into the kept picture alone.

    Parameters
    ----------
    window : vtkRenderWindow
    renderer : vtkRenderer
        Of what stands still.
    """

    def __init__(self, window: Any, renderer: Any) -> None:
        self._window, self._renderer = window, renderer
        self._kept: Any = None
        self._key: object = None
        self._size = (0, 0)
        self._hidden: list[Any] = []
        self._copy_in = self._copy_out = False
        self._observers = [
            renderer.AddObserver("StartEvent", lambda _caller, _event: self._begin()),
            renderer.AddObserver("EndEvent", lambda _caller, _event: self._end()),
        ]

    def prepare(self, key: object, actors: list[Any], fresh: Any | None) -> bool:
        """
        Before a frame: draw all of `actors`, or the kept picture and `fresh` alone; return whether all.

        Parameters
        ----------
        key : object
            Equal as long as the kept picture is right; None: no picture is kept, as while all moves.
        actors : list of vtkProp
            What stands still.
        fresh : vtkProp or None
            What is to be drawn into the kept picture.
        """
        whole = key is None or key != self._key or self._kept is None
        self._key = key
        self._copy_in, self._copy_out = not whole, key is not None and (whole or fresh is not None)
        self._renderer.SetPreserveColorBuffer(not whole)
        self._renderer.SetPreserveDepthBuffer(not whole)
        if not whole:
            self._hidden = [actor for actor in actors if actor.GetVisibility()]
            for actor in self._hidden:
                actor.VisibilityOff()
        if fresh is not None:
            fresh.SetVisibility(not whole)
        return whole

    def finish(self, fresh: Any) -> None:
        """After a frame: show again what was not drawn."""
        for actor in self._hidden:
            actor.VisibilityOn()
        self._hidden = []
        fresh.VisibilityOff()

    def forget(self) -> None:
        """Draw all the next time."""
        self._key = None

    def close(self) -> None:
        """Give its memory back; the window's context must still be there."""
        for observer in self._observers:
            self._renderer.RemoveObserver(observer)
        if self._kept is not None:
            self._kept.ReleaseGraphicsResources(self._window)
            self._kept = None

    def _begin(self) -> None:
        if self._copy_in:
            self._copy(self._kept, self._window.GetRenderFramebuffer())

    def _end(self) -> None:
        if not self._copy_out:
            return
        width, height = self._window.GetSize()
        if self._kept is None or self._size != (width, height):
            self._size = width, height
            if self._kept is not None:
                self._kept.ReleaseGraphicsResources(self._window)
            self._kept = vtkOpenGLFramebufferObject()
            self._kept.SetContext(self._window)
            state = self._window.GetState()
            state.PushFramebufferBindings()
            # as VTK makes its own: nothing at all is copied where the depths have other formats
            depth = self._window.GetRenderBufferTargetDepthSize()
            self._kept.PopulateFramebuffer(width, height, True, 1, _UNSIGNED_CHAR, True, depth, 0)
            state.PopFramebufferBindings()
        self._copy(self._window.GetRenderFramebuffer(), self._kept)

    def _copy(self, source: Any, target: Any) -> None:
        width, height = self._window.GetSize()
        state = self._window.GetState()
        state.PushFramebufferBindings()
        source.Bind(_READ)
        source.ActivateReadBuffer(0)
        target.Bind(_DRAW)
        target.ActivateDrawBuffer(0)
        whole = [0, width, 0, height]
        vtkOpenGLFramebufferObject.Blit(whole, whole, _COLOUR_AND_DEPTH, _NEAREST)
        state.PopFramebufferBindings()
