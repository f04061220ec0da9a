#!/usr/bin/env python3
"""Runs what release/build made, as a user does who has nothing else.

    python3 release/run.py DIST

For every platform of which DIST holds the program: it is copied alone into an empty folder, where it makes an FMU and runs the demo, which loads
an FMU as a host does. The FMU must hold the libraries of all platforms of the release. Windows programs run under wine, those for aarch64 under
qemu-aarch64-static with the libc of Debian's libc6-arm64-cross; what cannot run here is named with the reason. Wine 8 of Debian 12 has no
bcryptprimitives.dll, which every program of Rust needs for one function: mingw builds a stand-in of it for wine. On the platform of this machine FMPy
simulates the FMU too, and a C compiler builds and runs the host of capi/examples with the libraries of the release.
"""

import os
import pathlib
import platform
import shutil
import subprocess
import sys
import tarfile
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENE = ROOT / "scenes" / "oc3_catenary.toml"
MACHINE = {"AMD64": "x86_64", "arm64": "aarch64"}.get(platform.machine(), platform.machine())
THIS = f"{MACHINE}-{platform.system().lower()}"
ARM_LIBC = pathlib.Path("/usr/aarch64-linux-gnu")
FOLDERS = {"x86_64-linux": "linux64", "x86_64-windows": "win64", "x86_64-darwin": "darwin64"}
"""Folders of FMI 2.0 where they are not the names of platforms."""
RANDOM = """
#include <windows.h>
BOOLEAN NTAPI SystemFunction036(PVOID, ULONG);
__declspec(dllexport) BOOL WINAPI ProcessPrng(PBYTE data, SIZE_T size) { return SystemFunction036(data, (ULONG)size); }
"""
"""The function of bcryptprimitives.dll, by that of advapi32.dll."""


def runner(name):
    """Words before the program of a platform, or the reason why it cannot run here."""
    if name == THIS:
        return []
    if name == "x86_64-windows" and THIS == "x86_64-linux":
        return ["wine"] if shutil.which("wine") else "wine is not installed"
    if name == "aarch64-linux" and THIS == "x86_64-linux":
        qemu = shutil.which("qemu-aarch64-static")
        if qemu is None or not ARM_LIBC.is_dir():
            return "qemu-aarch64-static or libc6-arm64-cross is not installed"
        return [qemu, "-L", str(ARM_LIBC)]
    return f"this machine is {THIS}"


def run(words, folder, **environment):
    """Runs a program and returns what it prints."""
    done = subprocess.run([str(word) for word in words], cwd=folder, capture_output=True, text=True, env={**os.environ, **environment})
    if done.returncode != 0:
        sys.exit(f"error: {' '.join(map(str, words))} ended with {done.returncode}\n{done.stdout}\n{done.stderr}")
    return done.stdout


def wine_settings(folder):
    """Environment of wine: a fresh prefix in a folder, no messages, and the library that old versions lack."""
    library = folder / "bcryptprimitives.dll"
    compiler = shutil.which("x86_64-w64-mingw32-gcc")
    if compiler is not None:
        (folder / "random.c").write_text(RANDOM)
        run([compiler, "-shared", "-o", library, folder / "random.c", "-ladvapi32"], folder)
    return {"WINEPREFIX": str(folder / "prefix"), "WINEDEBUG": "-all", "WINEPATH": f"Z:{folder}".replace("/", "\\")}


def unpack(archive, folder):
    """Unpacks the file of a platform and returns the folder in it."""
    if archive.suffix == ".zip":
        zipfile.ZipFile(archive).extractall(folder)
    else:
        tarfile.open(archive).extractall(folder, filter="data")
    (inner,) = folder.iterdir()
    return inner


def alone(program, words, platforms, folder, settings):
    """Runs a program in an empty folder and returns the FMU that it made."""
    folder.mkdir()
    program = shutil.copy2(program, folder)
    (folder / "scene.toml").write_bytes(SCENE.read_bytes())
    call = [*words, program]
    print("  ", run([*call, "--version"], folder, **settings).strip())
    run([*call, "fmu", "scene.toml", "-o", "scene.fmu"], folder, **settings)
    run([*call, "demo", "-o", "demo"], folder, **settings)
    with zipfile.ZipFile(folder / "scene.fmu") as fmu:
        found = {name.split("/")[1] for name in fmu.namelist() if name.startswith("binaries/")}
    if found != {FOLDERS.get(name, name) for name in platforms} or not (folder / "demo" / "report.html").is_file():
        sys.exit(f"error: the FMU holds libraries for {sorted(found)}, the release for {sorted(platforms)}; or the demo wrote no report")
    print(f"   fmu and demo ran; the FMU has {(folder / 'scene.fmu').stat().st_size / 1e6:.2f} MB: {', '.join(sorted(found))}")
    return folder / "scene.fmu"


def in_fmpy(fmu):
    """Simulates an FMU in FMPy, where it is installed."""
    try:
        from fmpy import simulate_fmu
    except ImportError as error:
        print(f"   FMPy: not run, {error}")
        return
    result = simulate_fmu(str(fmu), stop_time=2.0, output_interval=0.05, output=["line1.tension_b"])
    print(f"   FMPy: line1.tension_b at 2 s is {result['line1.tension_b'][-1]:.6e} N")


def in_c(release, folder):
    """Builds and runs the host in C, where there is a compiler for Unix."""
    compiler = shutil.which("cc")
    if compiler is None or THIS.endswith("windows"):
        print("   C: not run, there is no compiler cc")
        return
    run([compiler, "-I", release / "include", ROOT / "capi" / "examples" / "host.c", "-L", release / "lib", "-lmoorline_c", "-lm", "-o", "host"], folder)
    path = {"LD_LIBRARY_PATH": str(release / "lib"), "DYLD_LIBRARY_PATH": str(release / "lib")}
    print("   C:", run([folder / "host", SCENE], folder, **path).strip())


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: release/run.py DIST")
    dist = pathlib.Path(sys.argv[1]).resolve()
    with zipfile.ZipFile(dist / "moorline_fmu.zip") as libraries:
        platforms = {name.split("/")[0] for name in libraries.namelist()}
    for name in sorted(platforms):
        archive = next(dist.glob(f"moorline-*-{name}.[tz]*"), None)
        words = "its program is not in the folder" if archive is None else runner(name)
        if isinstance(words, str):
            print(f"{name}: NOT RUN, {words}")
            continue
        print(f"{name}: {' '.join(words) or 'natively'}")
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            (folder / "release").mkdir()
            release = unpack(archive, folder / "release")
            program = release / ("moorline.exe" if name.endswith("windows") else "moorline")
            settings = wine_settings(folder) if words == ["wine"] else {}
            fmu = alone(program, words, platforms, folder / "alone", settings)
            if name == THIS:
                in_fmpy(fmu)
                in_c(release, folder)


if __name__ == "__main__":
    main()
