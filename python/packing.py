"""The wheel of the Python package, around a module that cargo built."""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent


def wheel(module, output, libraries=(), platform=None):
    """Packs a wheel into the folder `output`: maturin writes its description, and wheel packs it. It contains the FMU `libraries` that the module does
    not contain itself, and is for a `platform` by its name in wheels, or for this one. Needs maturin and wheel in the environment of this interpreter.
    """
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        described = sys.executable, "-m", "maturin", "pep517", "write-dist-info", "--interpreter", sys.executable
        subprocess.run(
            [*described, "--manifest-path", HERE / "Cargo.toml", "--metadata-directory", folder], check=True, stdout=subprocess.DEVNULL
        )
        if platform is not None:
            (tags,) = folder.glob("*.dist-info/WHEEL")
            tags.write_text(re.sub(r"(?m)^Tag: (\w+-\w+)-\w+$", rf"Tag: \1-{platform}", tags.read_text()))
        package = folder / "moorline"
        left_out = shutil.ignore_patterns("__pycache__", "*.so", "*.dylib", "*.dll", "*.pyd")
        shutil.copytree(HERE / "package" / "moorline", package, ignore=left_out)
        shutil.copy2(module, package / ("_moorline.pyd" if module.suffix == ".dll" else "_moorline.abi3.so"))
        for library in libraries:
            shutil.copy2(library, package)
        output.mkdir(parents=True, exist_ok=True)
        subprocess.run([sys.executable, "-m", "wheel", "pack", folder, "--dest-dir", output], check=True)
