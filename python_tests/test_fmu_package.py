"""The files of an FMU beside its description and library, and the SSP package around it."""

import csv
import io
import os
import pathlib
import subprocess
import sys
import zipfile

import fmpy
import fmpy.ssp.ssd
import fmpy.validation
import pytest
from lxml import etree

import scenes

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCHEMAS = pathlib.Path(fmpy.__file__).parent
FILES = sorted([*(ROOT / "scenes").glob("*.toml"), ROOT / "tests/scenes/barge.toml", ROOT / "tests/scenes/platform.toml"])
REFERENCE = "extra/org.fmi-standard.fmi-ls-ref/"
OSP = "{https://open-simulation-platform.com/OspModelDescription/1.0.0}"


def read(path, name):
    with zipfile.ZipFile(path) as archive:
        return archive.read(name)


def names(path):
    with zipfile.ZipFile(path) as archive:
        return archive.namelist()


def description(path):
    return fmpy.read_model_description(str(path))


def table(path, name):
    rows = list(csv.reader(io.StringIO(read(path, REFERENCE + name).decode())))
    return rows[0], [[float(cell) for cell in row] for row in rows[1:]]


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_scene_of_the_repository_makes_a_sound_fmu_that_meets_its_reference(moorline, version, path, tmp_path):
    fmu = tmp_path / "x.fmu"
    done = moorline("fmu", path, "-o", fmu, "--fmi", version)
    assert done.returncode == 0, done.stderr
    assert fmpy.validation.validate_fmu(str(fmu)) == []
    check = "from fmu_manipulation_toolbox.cli.fmutool import fmutool; fmutool()"
    tool = subprocess.run([sys.executable, "-c", check, "-input", fmu, "-check"], capture_output=True, text=True)
    assert "No semantic error" in tool.stdout + tool.stderr
    verified = moorline("fmu", "--verify", fmu)
    assert verified.returncode == 0 and "deviation" in verified.stdout, verified.stderr
    schema = etree.XMLSchema(etree.parse(str(SCHEMAS / "schema/fmi3/fmi3TerminalsAndIcons.xsd")))
    schema.assertValid(etree.fromstring(read(fmu, "terminalsAndIcons/terminalsAndIcons.xml")))


def test_results_that_differ_from_the_reference_are_reported_with_exit_code_1(moorline, package, version, tmp_path):
    changed = tmp_path / "changed.fmu"
    with zipfile.ZipFile(package("CHAIN", version)) as source, zipfile.ZipFile(changed, "w") as target:
        for entry in source.infolist():
            data = source.read(entry)
            if entry.filename.endswith("reference_results.csv"):
                rows = data.decode().splitlines()
                cells = rows[5].split(",")
                cells[rows[0].split(",").index("line1.tension_b")] = "1.0"
                data = "\n".join([*rows[:5], ",".join(cells), *rows[6:]]).encode()
            target.writestr(entry, data)
    done = moorline("fmu", "--verify", changed)
    assert done.returncode == 1 and "line1.tension_b" in done.stderr, done.stderr


def test_an_fmu_without_reference_results_cannot_be_verified(moorline, package, version, tmp_path):
    bare = tmp_path / "bare.fmu"
    with zipfile.ZipFile(package("CHAIN", version)) as source, zipfile.ZipFile(bare, "w") as target:
        for entry in source.infolist():
            if not entry.filename.startswith("extra/"):
                target.writestr(entry, source.read(entry))
    done = moorline("fmu", "--verify", bare)
    assert done.returncode == 2 and "experiments.xml" in done.stderr, done.stderr


def test_another_host_meets_the_reference(package, version):
    path = package("BARGE", version)
    inputs, stimuli = table(path, "reference_inputs.csv")
    outputs, expected = table(path, "reference_results.csv")
    experiment = etree.fromstring(read(path, REFERENCE + "experiments.xml")).find("Experiment").attrib
    import numpy

    signals = numpy.array([tuple(row) for row in stimuli], dtype=[(name, float) for name in inputs])
    found = fmpy.simulate_fmu(str(path), stop_time=float(experiment["stopTime"]), output=outputs[1:], input=signals,
                              step_size=float(experiment["stepSize"]), output_interval=float(experiment["stepSize"]),
                              set_input_derivatives=False, use_event_mode=False)
    assert len(found) == len(expected)
    for name, column in zip(outputs[1:], range(1, len(outputs))):
        reference = numpy.array([row[column] for row in expected])
        assert numpy.abs(found[name] - reference).max() <= 1e-6 * max(numpy.abs(reference).max(), 1e-12), name


def test_the_manifest_gives_every_file_of_the_reference_a_role(package, version):
    path = package("CHAIN", version)
    manifest = etree.fromstring(read(path, REFERENCE + "fmi-ls-manifest.xml"))
    space = "{http://fmi-standard.org/fmi-ls-manifest}"
    assert manifest.tag == "fmiReferences"
    assert manifest.get(space + "fmi-ls-name") == "org.fmi-standard.fmi-ls-ref"
    assert manifest.get(space + "fmi-ls-version") and manifest.get(space + "fmi-ls-description")
    sources = {os.path.normpath(REFERENCE + related.get("source")): related.get("role") for related in manifest}
    assert set(sources) <= set(names(path))
    assert {name for name in names(path) if name.startswith(REFERENCE)} - {REFERENCE + "fmi-ls-manifest.xml"} <= set(sources)


@pytest.mark.parametrize("scene", ["CHAIN", "BARGE", "FAIRLEADS"])
def test_terminals_and_groups_name_variables_that_exist(package, version, scene):
    path = package(scene, version)
    known = {v.name: v.causality for v in description(path).modelVariables}
    terminals = etree.fromstring(read(path, "terminalsAndIcons/terminalsAndIcons.xml")).iter("TerminalMemberVariable")
    members = [member.get("variableName") for member in terminals]
    moved = [name for name, causality in known.items() if causality == "input"]
    assert set(moved) <= set(members) <= set(known)
    if version == 2:
        osp = etree.fromstring(read(path, "extra/com.open-simulation-platform/OspModelDescription.xml"))
        assert {group.get("ref") for group in osp.iter(OSP + "Variable")} == set(members)
        groups = [element.get("name") for element in osp.iter() if element.get("name")]
        assert len(groups) == len(set(groups))


def test_starts_lie_between_the_declared_limits(package, version):
    limited = 0
    for variable in description(package("CHAIN_PROFILE", version)).modelVariables:
        limits = [float(limit) if limit is not None else other
                  for limit, other in ((variable.min, -float("inf")), (variable.max, float("inf")))]
        limited += variable.min is not None
        if variable.start is not None and variable.type != "Boolean":
            assert limits[0] <= float(variable.start) <= limits[1], variable.name
        if variable.causality == "parameter" and variable.type == "Real" and float(variable.start):
            assert float(variable.nominal) == abs(float(variable.start)), variable.name
    assert limited > 10


def test_the_page_has_every_variable_and_the_figure(package, version):
    path = package("BARGE", version)
    page = read(path, "documentation/index.html").decode()
    assert "<svg" in page and all(f"<td>{v.name}" in page for v in description(path).modelVariables if v.name != "time")
    assert b"MIT License" in read(path, "documentation/licenses/license.txt")


def test_author_and_date_are_written_where_they_are_given(moorline, version, tmp_path, monkeypatch):
    (tmp_path / "scene.toml").write_text(scenes.CHAIN)
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1764108000")
    fmu = tmp_path / "x.fmu"
    assert moorline("fmu", tmp_path / "scene.toml", "-o", fmu, "--fmi", version, "--author", "A. Nyone").returncode == 0
    found = description(fmu)
    assert (found.author, found.generationDateAndTime) == ("A. Nyone", "2025-11-25T22:00:00Z")
    assert found.license and found.defaultExperiment.tolerance == "0.02"
    assert moorline("fmu", "--verify", fmu).returncode == 0
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "yesterday")
    done = moorline("fmu", tmp_path / "scene.toml", "-o", fmu)
    assert done.returncode == 2 and "SOURCE_DATE_EPOCH" in done.stderr


def test_two_scenes_have_libraries_of_two_names(package, version):
    identifiers = {scene: description(package(scene, version)).coSimulation.modelIdentifier for scene in ("CHAIN", "BARGE")}
    assert identifiers == {"CHAIN": "moorline_one_chain_line_on_a_seabed", "BARGE": "moorline_two_opposite_lines_of_a_vessel"}
    for scene, identifier in identifiers.items():
        (binary,) = [name for name in names(package(scene, version)) if name.startswith("binaries/")]
        assert pathlib.PurePosixPath(binary).stem == identifier


def test_a_profile_of_scalars_has_no_arrays(moorline, version, tmp_path):
    (tmp_path / "scene.toml").write_text(scenes.CHAIN_PROFILE.replace("profile = true", 'profile = "scalar"'))
    fmu = tmp_path / "x.fmu"
    assert moorline("fmu", tmp_path / "scene.toml", "-o", fmu, "--fmi", version).returncode == 0
    found = description(fmu).modelVariables
    assert all(not variable.dimensions for variable in found)
    assert sum(".profile." in variable.name for variable in found) == 4 * 21
    assert fmpy.validation.validate_fmu(str(fmu)) == []
    assert moorline("fmu", "--verify", fmu).returncode == 0


@pytest.mark.parametrize("scene", ["CHAIN", "BARGE", "WINCH"])
def test_an_ssp_package_holds_the_fmu_and_connects_all_of_it(moorline, version, scene, tmp_path):
    (tmp_path / "scene.toml").write_text(getattr(scenes, scene))
    package = tmp_path / "x.ssp"
    done = moorline("fmu", tmp_path / "scene.toml", "-o", package, "--fmi", version, "--ssp")
    assert done.returncode == 0, done.stderr
    text = read(package, "SystemStructure.ssd")
    schema = etree.XMLSchema(etree.parse(str(SCHEMAS / "ssp/schema/SystemStructureDescription.xsd")))
    schema.assertValid(etree.fromstring(text))
    system = fmpy.ssp.ssd.read_ssd(str(package)).system
    (component,) = system.elements
    (tmp_path / "inner.fmu").write_bytes(read(package, component.source))
    inner = description(tmp_path / "inner.fmu")
    wanted = {v.name for v in inner.modelVariables if v.causality in ("input", "output") and not v.dimensions}
    assert {connector.name for connector in component.connectors} == wanted
    assert len(system.connections) == len(wanted)
    assert fmpy.validation.validate_fmu(str(tmp_path / "inner.fmu")) == []


def test_ecos_steps_the_fmu(package, version):
    ecos = pytest.importorskip("ecospy", reason="the package ecospy is not installed: it needs libtbb12 of the system")
    with ecos.EcosSimulationStructure() as structure:
        structure.add_model("mooring", str(package("CHAIN", version)))
        with structure.create_simulation(ecos.EcosFixedStepAlgorithm(0.05)) as simulation:
            simulation.init()
            simulation.step(20)
            assert simulation.get_real("mooring::line1.tension_b") > 1e5
