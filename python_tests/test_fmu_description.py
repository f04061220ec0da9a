"""modelDescription.xml: what checkers say of it, and whether it tells the truth."""

import math
import subprocess
import sys
import zipfile

import fmpy.validation
import pytest

import scenes
from fmu_calls import OK

SCENES = ["CHAIN", "CHAIN_PROFILE", "TWO_ROPES", "CURRENT", "CURRENT_ALONE", "WAVES", "HOSTED", "MATCHED"]


@pytest.mark.parametrize("scene", SCENES)
def test_fmpy_finds_no_problem(package, version, scene):
    assert fmpy.validation.validate_fmu(str(package(scene, version))) == []


@pytest.mark.parametrize("scene", SCENES)
def test_fmutool_finds_no_semantic_error(package, version, scene):
    check = "from fmu_manipulation_toolbox.cli.fmutool import fmutool; fmutool()"
    done = subprocess.run([sys.executable, "-c", check, "-input", package(scene, version), "-check"],
                          capture_output=True, text=True)
    said = done.stdout + done.stderr
    assert "No semantic error" in said and f"compliant with FMI-{version}.0" in said, said


def test_the_container_is_the_same_each_time(package, moorline, version, tmp_path):
    (tmp_path / "scene.toml").write_text(scenes.CHAIN)
    assert moorline("fmu", tmp_path / "scene.toml", "-o", tmp_path / "b.fmu", "--fmi", version).returncode == 0
    assert (tmp_path / "b.fmu").read_bytes() == package("CHAIN", version).read_bytes()


def test_the_container_has_forward_slashes_and_a_library_that_may_run(package, version):
    with zipfile.ZipFile(package("CHAIN", version)) as archive:
        entries = {entry.orig_filename: entry for entry in archive.infolist()}
    assert all("\\" not in name for name in entries)
    assert "modelDescription.xml" in entries and "resources/scene.toml" in entries
    (binary,) = [name for name in entries if name.startswith("binaries/")]
    assert entries[binary].external_attr >> 16 & 0o111


def test_names_and_causalities_are_those_that_hosts_rely_on(library, version):
    d = library("CHAIN", version).description
    assert d.names("input") == [f"fairlead.{a}" for a in ("x", "y", "z", "vx", "vy", "vz")]
    assert d.names("output") == [
        "fairlead.fx", "fairlead.fy", "fairlead.fz", "line1.tension_b", "line1.tension_a", "line1.tension_max",
        "line1.laid_length", "line1.sag", "solver.substeps", "solver.input_error"]
    assert d.names("calculatedParameter") == [
        "line1.catenary_sag", "line1.catenary_horizontal", "line1.catenary_tension_b"]
    assert set(d.names("parameter")) == {
        "chain.axial_stiffness", "chain.mass", "chain.diameter", "chain.axial_damping", "chain.drag_normal",
        "chain.drag_tangential", "chain.added_mass_normal", "chain.added_mass_tangential", "line1.length",
        "water.density", "seabed.depth", "gravity", "solver.tolerance", "solver.input_reconstruction"}
    assert [v["reference"] for v in d.variables.values()] == list(range(1, len(d.variables) + 1))


def test_a_scene_that_asks_for_the_energy_balance_has_its_outputs(library, version):
    plain, balanced = (set(library(name, version).description.names("output")) for name in ("CHAIN", "CHAIN_BALANCED"))
    assert balanced - plain == {"solver.energy_error", "solver.power_residual"}


def test_only_what_the_scene_gives_is_a_parameter(library, version):
    names = library("TWO_ROPES", version).description.names("parameter")
    assert "rope.weight" in names and "rope.mass" not in names and "wire.damping_ratio" in names
    assert not any(name.startswith(("water.", "seabed.")) for name in names)
    assert "slack.section1.length" in names and "slack.section2.length" in names and "span.length" in names


def test_every_real_variable_has_a_unit(library, version):
    d = library("CHAIN_PROFILE", version).description
    assert [n for n, v in d.variables.items() if v["type"] in ("Real", "Float64") and not v["unit"]] == []
    expected = {"fairlead.x": "m", "fairlead.vx": "m/s", "fairlead.fx": "N", "line1.sag": "m", "chain.mass": "kg/m",
                "chain.drag_normal": "1", "water.density": "kg/m3", "gravity": "m/s2", "chain.axial_damping": "N.s"}
    assert {name: d.variables[name]["unit"] for name in expected} == expected


def test_profiles_are_scalars_in_fmi2_and_arrays_in_fmi3(library, version):
    d = library("CHAIN_PROFILE", version).description
    profile = [name for name in d.variables if ".profile." in name]
    if version == 2:
        assert len(profile) == 4 * 21 and "line1.profile.x[1]" in profile and "line1.profile.tension[21]" in profile
    else:
        assert profile == [f"line1.profile.{q}" for q in ("x", "y", "z", "tension")]
        assert all(d.variables[name]["size"] == 21 for name in profile)
    plain = library("CHAIN", version).description
    assert list(plain.variables)[:30] == list(d.variables)[:30], "asking for profiles moves no other variable"


def test_the_flow_of_the_water_is_scalars_in_fmi2_and_arrays_with_as_many_starts_in_fmi3(library, version):
    d = library("HOSTED", version).description
    flow = [name for name in d.variables if ".flow." in name]
    labels = ["vx", "vy", "vz", "ax", "ay", "az", "x", "y", "z"]
    if version == 2:
        assert flow == [f"line1.flow.{label}[{node}]" for label in labels for node in range(1, 22)]
    else:
        assert flow == [f"line1.flow.{label}" for label in labels]
        assert all(d.variables[name]["size"] == 21 for name in flow)
        assert d.variables["line1.flow.az"]["start"].split() == ["0.0"] * 21
    units = {name.split(".")[2].split("[")[0]: d.variables[name]["unit"] for name in flow}
    assert units == dict.fromkeys(labels[:3], "m/s") | dict.fromkeys(labels[3:6], "m/s2") | dict.fromkeys(labels[6:], "m")


def test_profile_begins_and_ends_at_the_points(slave, version):
    one = slave("CHAIN_PROFILE").initialize(fairlead__x=1.0)
    if version == 2:
        ends = [[one.get(f"line1.profile.{a}[{n}]") for a in "xyz"] for n in (1, 21)]
    else:
        ends = [[one.get(f"line1.profile.{a}")[n] for a in "xyz"] for n in (0, 20)]
    assert ends[0] == pytest.approx([837.6, 0.0, -200.0], abs=1e-9)
    assert ends[1] == pytest.approx([41.868, 0.0, -14.0], abs=1e-9)


def test_starts_are_the_scenes_own_numbers_to_the_last_bit(library, version):
    d = library("CHAIN", version).description
    assert float(d.variables["chain.axial_stiffness"]["start"]) == 753.6e6
    assert float(d.variables["gravity"]["start"]) == 9.80665
    assert all(float(d.variables[name]["start"]) == 0.0 for name in d.names("input"))


def test_a_clash_of_names_is_refused_by_name(moorline, version, tmp_path):
    scene, fmu = tmp_path / "scene.toml", tmp_path / "x.fmu"
    scene.write_text(scenes.TWO_ROPES.replace('name = "span"', 'name = "slack"'))
    done = moorline("fmu", scene, "-o", fmu, "--fmi", version)
    assert done.returncode == 2 and "slack" in done.stderr and not fmu.exists(), done.stderr


@pytest.mark.parametrize("scene", SCENES)
def test_outputs_depend_on_what_is_declared_and_on_nothing_else(slave, version, scene):
    """Changes every input and parameter, one at a time, during initialization."""
    one = slave(scene)
    d = one.library.description
    unknowns = d.names("output", "calculatedParameter")
    moved = {name: 0.3 for name in d.names("input") if name.endswith((".x", ".y", ".z")) or ".flow." in name}

    def solve(changes):
        one.expect(one.reset())
        one.expect(one.enter())
        for name, value in {**moved, **changes}.items():
            status = one.set(name, value)
            if status != OK:
                return None
        return {name: one.get(name) for name in unknowns}

    base = solve({})
    influences = {name: set() for name in unknowns}
    for known in d.names("input", "parameter"):
        start = float(d.variables[known]["start"].split()[0])
        other = 1.0 if known == "solver.input_reconstruction" else 1.001 * start if start else 0.31
        if known == "solver.tolerance":
            other = 0.5 * start
        after = solve({known: other})
        if after is None:
            assert known == "solver.tolerance" and "profile" in one.messages[-1][2]
            continue
        for unknown in unknowns:
            if after[unknown] != base[unknown]:
                influences[unknown].add(known)
    undeclared = {u: known - d.initial_dependencies[u] for u, known in influences.items()}
    assert {u: known for u, known in undeclared.items() if known} == {}
    # What carries force is moved by all that is declared; a result that cannot change here, like a sag on the seabed, may not.
    for name in unknowns:
        if name.endswith(("tension_b", "catenary_tension_b")):
            missing = d.initial_dependencies[name] - influences[name]
            assert missing <= {"chain.diameter"}, (name, missing)


def test_outputs_do_not_change_between_steps(slave):
    """The description says that outputs depend on no input after initialization."""
    one = slave().initialize()
    one.run(3, drive=lambda t: {"fairlead.x": math.sin(t)})
    before = one.outputs()
    for name in one.library.description.names("input"):
        one.expect(one.set(name, 0.7))
        assert one.outputs() == before, name
