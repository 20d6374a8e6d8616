"""OpenGL contexts without a display, created directly with the system's libraries.

MuJoCo's own contexts use PyOpenGL, which binds one platform per process and takes 0.2 s to import.
These can be tried one after the other.
"""

import ctypes
from typing import Any, Protocol

from arm_gazebo.errors import CameraError

POINTER = ctypes.c_void_p
EGL_PLATFORM_DEVICE = 0x313F
EGL_OPENGL_API = 0x30A2
EGL_MAX_DEVICES = 32
EGL_CONFIG = (
    *(0x3024, 8, 0x3023, 8, 0x3022, 8, 0x3021, 8),  # red, green, blue and alpha bits
    *(0x3025, 24, 0x3026, 8),  # depth and stencil bits
    *(0x3033, 0x0001),  # surface type: pbuffer
    *(0x3040, 0x0008),  # renderable type: OpenGL
    0x3038,  # end of the list
)
OSMESA_RGBA = 0x1908
GL_UNSIGNED_BYTE = 0x1401
DEPTH_BITS = 24
STENCIL_BITS = 8


class GlContext(Protocol):
    """An OpenGL context, current in the thread that created it until it is freed."""

    name: str

    def make_current(self) -> None:
        """Make it current again, in case another context has become current."""
        ...

    def free(self) -> None:
        """Release the context; idempotent."""
        ...


class EglContext:
    """A context on the first EGL device, GPU or software, that provides one."""

    name = "egl"

    def __init__(self) -> None:
        self._egl = _load("libEGL.so.1", "libEGL.so")
        self._declare()
        self._display, self._context = self._first_context()

    def make_current(self) -> None:
        """Make it current again; the thread that created it."""
        self._egl.eglMakeCurrent(self._display, None, None, self._context)

    def free(self) -> None:
        """Release the context; idempotent."""
        if self._context is None:
            return
        self._egl.eglMakeCurrent(self._display, None, None, None)
        self._egl.eglDestroyContext(self._display, self._context)
        # The display stays initialised: other contexts of this process use the same one.
        self._context = None

    def _declare(self) -> None:
        egl = self._egl
        egl.eglGetProcAddress.restype = POINTER
        egl.eglInitialize.argtypes = [POINTER, POINTER, POINTER]
        egl.eglChooseConfig.argtypes = [POINTER, POINTER, POINTER, ctypes.c_int, POINTER]
        egl.eglCreateContext.argtypes = [POINTER, POINTER, POINTER, POINTER]
        egl.eglCreateContext.restype = POINTER
        egl.eglMakeCurrent.argtypes = [POINTER, POINTER, POINTER, POINTER]
        egl.eglDestroyContext.argtypes = [POINTER, POINTER]
        egl.eglTerminate.argtypes = [POINTER]

    def _extension(self, name: str, result: Any, *arguments: Any) -> Any:
        address = self._egl.eglGetProcAddress(name.encode())
        if not address:
            raise CameraError(f"EGL lacks {name}")
        return ctypes.CFUNCTYPE(result, *arguments)(address)

    def _first_context(self) -> tuple[int, int]:
        query = self._extension("eglQueryDevicesEXT", ctypes.c_uint, ctypes.c_int, POINTER, POINTER)
        display_of = self._extension(
            "eglGetPlatformDisplayEXT", POINTER, ctypes.c_uint, POINTER, POINTER
        )
        devices = (POINTER * EGL_MAX_DEVICES)()
        count = ctypes.c_int()
        query(EGL_MAX_DEVICES, devices, ctypes.byref(count))
        for device in devices[: count.value]:
            display = display_of(EGL_PLATFORM_DEVICE, device, None)
            if not display or not self._egl.eglInitialize(display, None, None):
                continue
            context = self._context_on(display)
            if context:
                return display, context
            self._egl.eglTerminate(display)
        raise CameraError(f"none of {count.value} EGL devices provides an OpenGL context")

    def _context_on(self, display: int) -> int | None:
        attributes = (ctypes.c_int * len(EGL_CONFIG))(*EGL_CONFIG)
        config = POINTER()
        count = ctypes.c_int()
        self._egl.eglChooseConfig(display, attributes, ctypes.byref(config), 1, ctypes.byref(count))
        if count.value < 1 or not self._egl.eglBindAPI(EGL_OPENGL_API):
            return None
        context = self._egl.eglCreateContext(display, config, None, None)
        if context and self._egl.eglMakeCurrent(display, None, None, context):
            return context
        return None


class OsmesaContext:
    """A context of Mesa's off-screen library, which always renders in software."""

    name = "osmesa"

    def __init__(self) -> None:
        self._mesa = _load("libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so")
        self._mesa.OSMesaCreateContextExt.restype = POINTER
        self._mesa.OSMesaCreateContextExt.argtypes = [
            *([ctypes.c_uint] + [ctypes.c_int] * 3),
            POINTER,
        ]
        self._mesa.OSMesaMakeCurrent.argtypes = [
            *(POINTER, POINTER, ctypes.c_uint),
            *(ctypes.c_int, ctypes.c_int),
        ]
        self._mesa.OSMesaDestroyContext.argtypes = [POINTER]
        # MuJoCo draws into a framebuffer object, so the window's buffer only has to exist.
        self._window = ctypes.create_string_buffer(4)
        self._context = self._mesa.OSMesaCreateContextExt(
            OSMESA_RGBA, DEPTH_BITS, STENCIL_BITS, 0, None
        )
        if not self._context or not self._mesa.OSMesaMakeCurrent(
            self._context, self._window, GL_UNSIGNED_BYTE, 1, 1
        ):
            raise CameraError("OSMesa provides no OpenGL context")

    def make_current(self) -> None:
        """Make it current again; the thread that created it."""
        self._mesa.OSMesaMakeCurrent(self._context, self._window, GL_UNSIGNED_BYTE, 1, 1)

    def free(self) -> None:
        """Release the context; idempotent."""
        if self._context is None:
            return
        self._mesa.OSMesaMakeCurrent(None, None, GL_UNSIGNED_BYTE, 0, 0)
        self._mesa.OSMesaDestroyContext(self._context)
        self._context = None


def _load(*names: str) -> Any:
    for name in names:
        try:
            # Global, because MuJoCo looks up OpenGL functions among the process's symbols.
            return ctypes.CDLL(name, mode=ctypes.RTLD_GLOBAL)
        except OSError:
            continue
    raise CameraError(f"{names[0]} is not installed")
