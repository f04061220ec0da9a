"""The C functions of an unpacked FMU, called as they are: every call returns its status, nothing is smoothed over.

FMPy drives the FMU as users do; this module is for what FMPy keeps from a test: statuses, null pointers, wrong counts,
raw state bytes, calls out of order. Both versions of FMI behind the same names.
"""

import ctypes
import os
import pathlib
import platform
import sys
import time
import xml.etree.ElementTree as ET
import zipfile
from ctypes import (
    CFUNCTYPE, POINTER, Structure, byref, c_bool, c_char_p, c_double, c_int, c_size_t, c_ubyte, c_uint32, c_void_p,
)

OK, WARNING, DISCARD, ERROR, FATAL = range(5)

LOGGER2 = CFUNCTYPE(None, c_void_p, c_char_p, c_int, c_char_p, c_char_p, c_char_p)
LOGGER3 = CFUNCTYPE(None, c_void_p, c_int, c_char_p, c_char_p)


class Callbacks2(Structure):
    _fields_ = [("logger", LOGGER2), ("allocate", c_void_p), ("free", c_void_p), ("finished", c_void_p),
                ("environment", c_void_p)]


def tasks(expected):
    """Threads that the system counts in this process, once they are as many as expected or a few seconds have passed.

    A thread that has been joined still counts until the system has taken it down.
    """
    for _ in range(500):
        count = len(os.listdir("/proc/self/task"))
        if count == expected:
            break
        time.sleep(0.01)
    return count


def unpack(fmu, folder):
    """Unpacks a .fmu file and returns the folder."""
    with zipfile.ZipFile(fmu) as archive:
        archive.extractall(folder)
    return pathlib.Path(folder)


class Description:
    """modelDescription.xml: token, variables, dependencies during initialization."""

    def __init__(self, folder):
        root = ET.parse(pathlib.Path(folder) / "modelDescription.xml").getroot()
        self.root = root
        self.version = int(root.get("fmiVersion")[0])
        self.token = root.get("guid") if self.version == 2 else root.get("instantiationToken")
        self.identifier = root.find("CoSimulation").get("modelIdentifier")
        self.variables = {}
        for position, element in enumerate(root.find("ModelVariables"), start=1):
            value = element[0] if self.version == 2 else element
            self.variables[element.get("name")] = {
                "position": position,
                "reference": int(element.get("valueReference")),
                "causality": element.get("causality"),
                "type": value.tag,
                "unit": value.get("unit"),
                "start": value.get("start"),
                "size": int(element[0].get("start")) if self.version == 3 and len(element) else 1,
            }
        key = "index" if self.version == 2 else "valueReference"
        unknowns = root.findall(".//InitialUnknowns/Unknown" if self.version == 2 else ".//InitialUnknown")
        names = {v["position"]: name for name, v in self.variables.items()}
        self.initial_dependencies = {
            names[int(u.get(key))]: {names[int(d)] for d in u.get("dependencies").split()} for u in unknowns
        }

    def names(self, *causalities):
        return [name for name, v in self.variables.items() if v["causality"] in causalities]

    def reference(self, name):
        return self.variables[name]["reference"]


class Library:
    """The shared library of an unpacked FMU."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.description = Description(folder)
        self.version = self.description.version
        machine = "aarch64" if platform.machine() in ("aarch64", "arm64") else "x86_64"
        system = {"linux": "linux", "darwin": "darwin", "win32": "windows"}[sys.platform]
        place = f"{machine}-{system}"
        if self.version == 2 and machine == "x86_64":
            place = {"linux": "linux64", "darwin": "darwin64", "windows": "win64"}[system]
        suffix = {"linux": "so", "darwin": "dylib", "windows": "dll"}[system]
        self.path = self.folder / "binaries" / place / f"{self.description.identifier}.{suffix}"
        self.dll = ctypes.CDLL(str(self.path))

    def function(self, name):
        return getattr(self.dll, f"fmi{self.version}{name}")


def resource_location(library, form=None):
    """What a host passes: `form` overrides, with {path} for the plain path."""
    path = library.folder.absolute() / "resources"
    if form is not None:
        return form.format(path=path)
    return path.as_uri() if library.version == 2 else f"{path}/"


class Slave:
    """One instance. Methods return the status; values come back through `real` and `integer`, which check it."""

    def __init__(self, library, logging=True, token=None, resources=None, with_logger=True):
        self.library, self.version = library, library.version
        self.messages = []
        keep = lambda status, category, text: self.messages.append((status, category.decode(), text.decode()))
        token = (library.description.token if token is None else token).encode()
        resources = resource_location(library) if resources is None else resources
        resources = resources if isinstance(resources, bytes) else resources.encode()
        instantiate = library.function("Instantiate" if self.version == 2 else "InstantiateCoSimulation")
        instantiate.restype = c_void_p
        if self.version == 2:
            def logger(_environment, _name, status, category, format, argument):
                assert format == b"%s"
                keep(status, category, argument)
            self.logger = LOGGER2(logger) if with_logger else LOGGER2()
            self.callbacks = Callbacks2(self.logger, None, None, None, None)
            instantiate.argtypes = [c_char_p, c_int, c_char_p, c_char_p, c_void_p, c_int, c_int]
            self.handle = instantiate(b"mooring", 1, token, resources, byref(self.callbacks), 0, int(logging))
        else:
            self.logger = LOGGER3(lambda _e, status, category, text: keep(status, category, text))
            if not with_logger:
                self.logger = LOGGER3()
            instantiate.argtypes = [c_char_p, c_char_p, c_char_p, c_bool, c_bool, c_bool, c_bool, c_void_p, c_size_t,
                                    c_void_p, LOGGER3, c_void_p]
            self.handle = instantiate(b"mooring", token, resources, False, logging, False, False, None, 0, None,
                                      self.logger, None)

    def call(self, name, *arguments):
        return self.library.function(name)(c_void_p(self.handle), *arguments)

    def expect(self, status):
        assert status == OK, self.messages[-1:]

    def free(self):
        function = self.library.function("FreeInstance")
        function.restype = None
        function(c_void_p(self.handle))
        self.handle = None

    # ---- life

    def enter(self, start=0.0, stop=None, tolerance=None):
        arguments = [tolerance is not None, c_double(tolerance or 0.0), c_double(start), stop is not None,
                     c_double(stop or 0.0)]
        if self.version == 3:
            return self.call("EnterInitializationMode", *(c_bool(a) if isinstance(a, bool) else a for a in arguments))
        status = self.call("SetupExperiment", *(int(a) if isinstance(a, bool) else a for a in arguments))
        return status or self.call("EnterInitializationMode")

    def exit(self):
        return self.call("ExitInitializationMode")

    def initialize(self, start=0.0, **values):
        self.expect(self.enter(start))
        for name, value in values.items():
            self.expect(self.set(name.replace("__", "."), value))
        self.expect(self.exit())
        return self

    def step(self, time, step):
        if self.version == 2:
            return self.call("DoStep", c_double(time), c_double(step), 1)
        flags = [c_bool() for _ in range(3)]
        self.reached = c_double()
        return self.call("DoStep", c_double(time), c_double(step), c_bool(True), *map(byref, flags),
                         byref(self.reached))

    def run(self, count, step=0.05, start=0.0, drive=lambda time: {}):
        """Steps and returns the outputs after each step."""
        rows = []
        for k in range(count):
            for name, value in drive(start + k * step).items():
                self.expect(self.set(name, value))
            self.expect(self.step(start + k * step, step))
            rows.append(self.outputs())
        return rows

    def terminate(self):
        return self.call("Terminate")

    def reset(self):
        return self.call("Reset")

    # ---- values

    def _access(self, verb, kind, references, values, counts=None):
        names = {"real": ("Real", "Float64"), "integer": ("Integer", "Int32"), "boolean": ("Boolean", "Boolean"),
                 "string": ("String", "String")}
        name = verb + names[kind][self.version - 2]
        array = (c_uint32 * len(references))(*references)
        n_references, n_values = counts or (len(references), len(values))
        tail = [c_size_t(n_values)] if self.version == 3 else []
        return self.call(name, array, c_size_t(n_references), values, *tail)

    def get_references(self, references, size=None, kind="real", counts=None):
        values = ({"real": c_double, "integer": c_int}.get(kind, c_void_p) * (size or len(references)))()
        return self._access("Get", kind, references, values, counts), list(values)

    def set_references(self, references, values, kind="real", counts=None):
        if kind == "integer":
            values = [int(value) for value in values]
        array = ({"real": c_double, "integer": c_int}.get(kind, c_void_p) * len(values))(*values)
        return self._access("Set", kind, references, array, counts)

    def set_derivatives(self, references, orders, values):
        n = len(references)
        return self.call("SetRealInputDerivatives", (c_uint32 * n)(*references), c_size_t(n), (c_int * n)(*orders),
                         (c_double * n)(*values))

    def set(self, name, value):
        """Sets a scalar, or an array to its values or to one number throughout."""
        variable = self.library.description.variables[name]
        kind = "integer" if variable["type"] in ("Integer", "Int32") else "real"
        values = [*value] if hasattr(value, "__len__") else [value] * variable["size"]
        return self.set_references([variable["reference"]], values, kind)

    def get(self, name):
        variable = self.library.description.variables[name]
        kind = "integer" if variable["type"] in ("Integer", "Int32") else "real"
        status, values = self.get_references([variable["reference"]], variable["size"], kind)
        self.expect(status)
        return values[0] if variable["size"] == 1 else values

    def values(self, *causalities):
        return {name: self.get(name) for name in self.library.description.names(*causalities)}

    def outputs(self):
        return self.values("output")

    # ---- state

    def _state_name(self, name):
        return name if self.version == 2 else name.replace("FMUstate", "FMUState").replace("DeSerialize", "Deserialize")

    def save(self, state=None):
        state = c_void_p() if state is None else state
        self.expect(self.call(self._state_name("GetFMUstate"), byref(state)))
        return state

    def restore(self, state):
        return self.call(self._state_name("SetFMUstate"), state)

    def free_state(self, state):
        return self.call(self._state_name("FreeFMUstate"), byref(state))

    def serialize(self, state):
        size = c_size_t()
        self.expect(self.call(self._state_name("SerializedFMUstateSize"), state, byref(size)))
        data = (c_ubyte * size.value)()
        self.expect(self.call(self._state_name("SerializeFMUstate"), state, data, size))
        return bytes(data)

    def serialize_into(self, state, size):
        return self.call(self._state_name("SerializeFMUstate"), state, (c_ubyte * size)(), c_size_t(size))

    def deserialize(self, data):
        state = c_void_p()
        status = self.call(self._state_name("DeSerializeFMUstate"), (c_ubyte * len(data))(*data), c_size_t(len(data)),
                           byref(state))
        return status, state
