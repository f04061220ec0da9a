"""Checks of binaries: what they export and import, and that they hold no trace of the machine that built them."""

import importlib.util
import pathlib
import re

import lief

SYSTEM_DLLS = re.compile(
    r"(?i)(api-ms-win-.*|advapi32|bcrypt|bcryptprimitives|kernel32|msvcrt|ntdll|python3|shell32|user32|userenv|ucrtbase|vcruntime140(_1)?|ws2_32)\.dll")
"""Libraries that every Windows has, those of the compiler of Microsoft, and that of the interpreter for a module of Python."""


LINUX_LIBRARIES = re.compile(r"(ld-linux-\S+|lib(c|dl|gcc_s|m|pthread|rt))\.so\.\d+")
"""Libraries that every Linux with glibc has: of those that manylinux allows."""


class Wrong(Exception):
    """A binary that must not be published."""


def declared(header):
    """Functions that a header declares."""
    code = re.sub(r"/\*.*?\*/|//[^\n]*|^\s*#[^\n]*", "", header.read_text(), flags=re.DOTALL | re.MULTILINE)
    return set(re.findall(r"\b(\w+)\s*\([^()]*(?:\([^()]*\)[^()]*)*\)\s*;", code))


def of_fmi():
    """Functions of both versions of FMI, by the headers that FMPy holds."""
    headers = pathlib.Path(importlib.util.find_spec("fmpy").origin).parent / "c-code"
    texts = {version: (headers / f"fmi{version}Functions.h").read_text() for version in (2, 3)}
    return {name for version, text in texts.items() for name in re.findall(rf"\b(fmi{version}\w+)TYPE\b", text)}


def exports(root):
    """Functions that each library exports: those of its headers."""
    headers = root / "capi" / "moordyn" / "include"
    return {
        "moorline_fmu": of_fmi(),
        "moorline_c": declared(root / "capi" / "include" / "moorline.h"),
        "moordyn": declared(headers / "MoorDyn.h") | declared(headers / "MoorDyn2.h"),
    }


def library(path, exported, glibc, root):
    """Claims that a library exports these functions and no others, and all that `program` claims."""
    binary = program(path, glibc, root)
    names = {name.lstrip("_") if isinstance(binary, lief.MachO.Binary) else name for name in exported_names(binary)}
    if names != exported:
        missing, others = sorted(exported - names), sorted(names - exported)
        raise Wrong(f"{path.name}: it lacks the functions {missing} and exports {others} besides")


def program(path, glibc, root):
    """Claims that a program or library runs on other machines: symbols, imports, no folder of this machine, no symbols for a debugger."""
    binary = lief.parse(str(path))
    if isinstance(binary, lief.MachO.FatBinary):
        binary = binary.at(0)
    if isinstance(binary, lief.ELF.Binary):
        check_elf(path, binary, glibc)
    elif isinstance(binary, lief.PE.Binary):
        others = sorted(one.name for one in binary.imports if not SYSTEM_DLLS.fullmatch(one.name))
        if others:
            raise Wrong(f"{path.name}: it needs {', '.join(others)}, which Windows does not have")
    content = path.read_bytes()
    for folder in (root, pathlib.Path.home()):
        if len(folder.parts) > 2 and str(folder).encode() in content:
            raise Wrong(f"{path.name}: it holds the name of the folder {folder}")
    return binary


def check_elf(path, binary, glibc):
    """Claims that an ELF file needs no younger glibc and no other library, and is stripped."""
    number = lambda version: tuple(map(int, version.split(".")))
    needed = {one.name for group in binary.symbols_version_requirement for one in group.get_auxiliary_symbols()}
    versions = [name.removeprefix("GLIBC_") for name in needed if re.fullmatch(r"GLIBC_[\d.]+", name)]
    younger = sorted(version for version in versions if number(version) > number(glibc))
    if younger:
        raise Wrong(f"{path.name}: it needs symbols of glibc {', '.join(younger)}, younger than {glibc}")
    others = sorted(name for name in binary.libraries if not LINUX_LIBRARIES.fullmatch(name))
    if others:
        raise Wrong(f"{path.name}: it needs {', '.join(others)}, which a Linux may not have")
    if any(section.name == ".symtab" for section in binary.sections):
        raise Wrong(f"{path.name}: it is not stripped")
    print(f"{path.name}: glibc {max(versions, key=number, default='none')} at most, {path.stat().st_size / 1e6:.2f} MB")


def exported_names(binary):
    """Names of the functions and data that a library exports."""
    if isinstance(binary, lief.ELF.Binary):
        return {symbol.name for symbol in binary.dynamic_symbols if symbol.exported}
    if isinstance(binary, lief.PE.Binary):
        return {entry.name for entry in binary.get_export().entries}
    return {symbol.name for symbol in binary.exported_symbols}
