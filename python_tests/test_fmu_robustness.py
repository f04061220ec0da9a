"""The FMU in a hostile house: odd folders, many instances, threads, unloading, foreign locale, calls in any order.

What could end the process or leak into it runs in a child process.
"""

import math
import os
import pathlib
import shutil
import subprocess
import sys
import textwrap
import threading
import time

import fmpy
import pytest

from fmu_calls import ERROR, OK, Library, Slave, unpack

HERE = pathlib.Path(__file__).resolve().parent


def child(code, *arguments, **options):
    """Runs code in a new Python; it must end well and say nothing but what it prints last."""
    environment = {**os.environ, **options.pop("environment", {}), "PYTHONPATH": str(HERE),
                   "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run([sys.executable, "-c", textwrap.dedent(code), *map(str, arguments)], capture_output=True,
                          text=True, env=environment, **options)
    assert done.returncode == 0, (done.returncode, done.stdout[-2000:], done.stderr[-2000:])
    return done


def swing(time):
    return {"fairlead.x": 2.0 * math.sin(0.7 * time)}


FORMS = {
    2: ["file://{path}", "file:{path}", "file://localhost{path}", "file:///{path}", "{path}", "{path}/", "{uri}",
        "{uri}/", "FILE://{path}"],
    3: ["{path}", "{path}/", "{uri}"],
}


@pytest.mark.parametrize("folder", ["plain", "sp dir ø {x}", "100% sure", "a+b#c&d"])
def test_every_form_of_the_resource_location_is_understood(package, version, tmp_path, folder):
    library = Library(unpack(package("CHAIN", version), tmp_path / folder))
    place = library.folder / "resources"
    for form in FORMS[version]:
        location = form.format(path=place, uri=place.as_uri())
        one = Slave(library, resources=location)
        assert one.handle, (location, one.messages)
        one.free()


def test_fmpy_simulates_from_an_odd_folder(package, version, tmp_path):
    folder = tmp_path / "sp dir ø {x}"
    folder.mkdir()
    shutil.copy(package("CHAIN", version), folder / "line ø.fmu")
    unpacked = unpack(folder / "line ø.fmu", folder / "un packed")
    for source in (folder / "line ø.fmu", unpacked):
        result = fmpy.simulate_fmu(str(source), stop_time=0.5, output_interval=0.05)
        assert math.isfinite(result["line1.tension_b"][-1])


def test_two_thousand_instances_leave_neither_memory_nor_files(package, version, tmp_path):
    unpack(package("CHAIN", version), tmp_path)
    child("""
        import os, resource, sys
        from fmu_calls import Library, Slave
        library = Library(sys.argv[1])
        def cycle(count):
            for _ in range(count):
                one = Slave(library).initialize()
                one.expect(one.step(0.0, 0.05))
                state = one.save()
                one.expect(one.free_state(state))
                one.free()
        def resident():
            with open("/proc/self/statm") as file:
                return int(file.read().split()[1]) * resource.getpagesize()
        cycle(200)
        memory, files = resident(), len(os.listdir("/proc/self/fd"))
        cycle(2000)
        grown = resident() - memory
        assert grown < 2e6, grown
        assert len(os.listdir("/proc/self/fd")) == files
        """, tmp_path)


def test_eight_threads_with_an_instance_each_get_the_same_bits(library, version):
    loaded = library("CHAIN", version)
    rows = [None] * 8

    def simulate(k):
        one = Slave(loaded).initialize()
        rows[k] = one.run(60, drive=swing)
        one.free()

    threads = [threading.Thread(target=simulate, args=(k,)) for k in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert rows[0] is not None and all(row == rows[0] for row in rows)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="only some systems fork")
def test_a_forked_process_makes_threads_of_its_own(package, version, tmp_path):
    unpack(package("TWO_ROPES_ON_THREADS", version), tmp_path)
    child("""
        import os, signal, sys
        from fmu_calls import Library, Slave
        one = Slave(Library(sys.argv[1])).initialize()
        rows = one.run(3)
        read, write = os.pipe()
        forked = os.fork()
        if not forked:
            signal.alarm(30)  # rather than wait for ever
        rows = repr(one.run(3, start=0.15))
        one.free()
        if not forked:
            os.write(write, rows.encode())
            os._exit(0)
        assert os.waitpid(forked, 0)[1] == 0
        assert os.read(read, 1 << 20).decode() == rows
        """, tmp_path)


def test_instances_do_not_disturb_each_other(slave):
    alone = slave().initialize().run(20, drive=swing)
    one, other = slave().initialize(), slave().initialize(chain__mass=150.0)
    rows = []
    for k in range(20):
        for instance in (one, other):
            for name, value in swing(0.05 * k).items():
                instance.expect(instance.set(name, value))
            instance.expect(instance.step(0.05 * k, 0.05))
        rows.append(one.outputs())
    assert rows == alone


def test_the_library_can_be_loaded_and_unloaded_a_hundred_times(package, version, tmp_path):
    unpack(package("CHAIN", version), tmp_path)
    child("""
        import _ctypes, sys, threading
        from fmu_calls import Library, Slave
        def use():
            library = Library(sys.argv[1])
            one = Slave(library).initialize()
            one.expect(one.step(0.0, 0.05))
            assert one.step(9.0, 0.05) == 3
            one.free()
            _ctypes.dlclose(library.dll._handle)
        def mapped():
            with open("/proc/self/maps") as file:
                return sys.argv[1] in file.read()
        for _ in range(100):
            use()
        assert not mapped(), "nothing keeps the library loaded"
        assert threading.active_count() == 1
        from fmu_calls import tasks
        assert tasks(1) == 1, "no thread of the library lives on"
        """, tmp_path)


def test_a_library_whose_instances_had_threads_can_be_unloaded(package, version, tmp_path):
    unpack(package("TWO_ROPES_ON_THREADS", version), tmp_path)
    child("""
        import _ctypes, sys
        from fmu_calls import Library, Slave, tasks
        for _ in range(5):
            library = Library(sys.argv[1])
            one = Slave(library).initialize()
            one.run(5)
            assert tasks(2) == 2, "one thread of the library"
            one.free()
            assert tasks(1) == 1, "no thread of the library lives on"
            _ctypes.dlclose(library.dll._handle)
            with open("/proc/self/maps") as file:
                assert sys.argv[1] not in file.read(), "nothing keeps the library loaded"
        """, tmp_path)


@pytest.mark.skipif(sys.platform != "linux", reason="only some systems have paths that are no text")
def test_a_path_that_is_not_utf_8_works(package, version, tmp_path):
    library = Library(unpack(package("CHAIN", version), tmp_path / "fmu"))
    folder = os.fsencode(tmp_path) + b"/odd \xff\xfe"
    shutil.copytree(os.fsencode(library.folder / "resources"), folder)
    forms = [folder, b"file://" + folder, b"file://" + folder.replace(b"\xff\xfe", b"%FF%FE")]
    for location in forms[:1] if version == 3 else forms:
        one = Slave(library, resources=location)
        assert one.handle, (location, one.messages)
        one.free()


def test_a_uri_of_another_scheme_is_refused_by_name(library, version):
    one = Slave(library("CHAIN", version), resources="http://example.org/resources")
    assert not one.handle
    assert 'is a URI of scheme "http"' in one.messages[-1][2]


def test_no_output_is_ever_no_number_with_ok(slave):
    for start in (1e9, 1e12, 1e15, 1e300):
        one = slave()
        if one.enter(start) != OK or one.exit() != OK:
            continue
        for k in range(3):
            if one.step(start + 0.05 * k, 0.05) != OK:
                break
            for name in one.library.description.names("output"):
                variable = one.library.description.variables[name]
                kind = "integer" if variable["type"] in ("Integer", "Int32") else "real"
                status, values = one.get_references([variable["reference"]], variable["size"], kind)
                assert status != OK or all(map(math.isfinite, values)), (start, name, values)
                assert status == OK or name in one.messages[-1][2]


@pytest.mark.parametrize("value", [1e6, 1e8, 1e11])
def test_a_displacement_beyond_the_scene_is_refused_before_anything_is_solved(slave, value):
    one = slave()
    one.expect(one.enter())
    one.expect(one.set("fairlead.x", value))
    began = time.perf_counter()
    assert one.exit() == ERROR
    assert "fairlead.x" in one.messages[-1][2] and "size of the scene" in one.messages[-1][2]
    one = slave().initialize()
    before = one.outputs()
    one.expect(one.set("fairlead.x", value))
    assert one.step(0.0, 0.05) == ERROR
    assert "size of the scene" in one.messages[-1][2]
    assert one.outputs() == before
    one.expect(one.set("fairlead.x", 0.1))
    one.expect(one.step(0.0, 0.05))
    assert time.perf_counter() - began < 5.0


def test_a_host_that_samples_too_coarsely_is_warned_once(slave):
    """A fast circle of the fairlead: 12 points a period are too few without velocities, and enough with them."""
    period, warned = 2.0, {}
    for points, velocities in ((12, False), (60, False), (60, True)):
        one, step = slave(logging=True).initialize(), period / points
        for k in range(10 * points):
            phase, ramp = 2.0 * math.pi * k / points, 0.5 * math.pi * min(k / (3.0 * points), 1.0)
            grown, growth = math.sin(ramp) ** 2, math.sin(2.0 * ramp) * 0.5 * math.pi / (3.0 * period)
            one.expect(one.set("fairlead.x", grown * math.sin(phase)))
            one.expect(one.set("fairlead.z", 0.5 * grown * math.cos(phase)))
            if velocities:
                speed = grown * 2.0 * math.pi / period
                one.expect(one.set("fairlead.vx", growth * math.sin(phase) + speed * math.cos(phase)))
                one.expect(one.set("fairlead.vz", 0.5 * (growth * math.cos(phase) - speed * math.sin(phase))))
            one.expect(one.step(k * step, step))
        warnings = [text for _, _, text in one.messages if "solver.input_error" in text]
        warned[points, velocities] = (len(warnings), one.get("solver.input_error"))
        assert all("communication steps per period" in text for text in warnings)
    assert warned[12, False][0] == 1 and warned[12, False][1] > 0.02, warned
    assert warned[60, False][0] == 0 and warned[60, False][1] < 0.02, warned


def test_an_instance_that_gets_its_state_from_another_warns_as_that_one_does(slave):
    one, other = slave(logging=True).initialize(), slave(logging=True)
    state = one.save()
    status, back = other.deserialize(one.serialize(state))
    other.expect(status)
    other.expect(other.restore(back))
    for host in (one, other):
        for k in range(40):
            host.expect(host.set("fairlead.x", 2.0 * math.sin(math.pi * k / 3.0)))
            host.expect(host.step(0.5 * k, 0.5))
    noted = [[text for _, _, text in host.messages if "solver.input_error" in text] for host in (one, other)]
    assert len(noted[0]) == 1 and noted[1] == noted[0]
    one.free_state(state)
    other.free_state(back)


def test_no_output_no_file_and_no_dependence_on_locale_or_folder(package, version, tmp_path):
    unpack(package("CHAIN", version), tmp_path / "fmu")
    before = sorted(p for p in tmp_path.rglob("*"))
    closed = tmp_path / "closed"
    closed.mkdir(mode=0o555)
    code = """
        import locale, os, sys
        from fmu_calls import Library, Slave
        try:
            locale.setlocale(locale.LC_ALL, "")
        except locale.Error:
            pass  # a machine without German still must not be disturbed by the variable
        os.chdir(sys.argv[2])
        one = Slave(Library(sys.argv[1]))
        one.expect(one.set("line1.length", 836.25))
        one.initialize()
        for k in range(20):
            one.expect(one.step(0.05 * k, 0.05))
        assert one.step(99.0, 0.05) == 3 and one.set("fairlead.x", float("nan")) == 3
        assert one.get("line1.length") == 836.25
        one.free()
        """
    for language in ("de_DE.UTF-8", "C"):
        done = child(code, tmp_path / "fmu", closed, environment={"LC_ALL": language})
        assert done.stdout == "" and done.stderr == ""
    closed.rmdir()
    assert sorted(p for p in tmp_path.rglob("*")) == before


@pytest.mark.parametrize("seed", range(4))
def test_calls_in_any_order_never_end_the_process(package, version, tmp_path, seed):
    unpack(package("TWO_ROPES" if seed % 2 else "CHAIN", version), tmp_path)
    done = child("""
        import random, sys
        from fmu_calls import Library, Slave
        rng = random.Random(int(sys.argv[2]))
        library = Library(sys.argv[1])
        names = list(library.description.variables)
        starts = [float(v["start"] or 0.0) for v in library.description.variables.values()]
        references = [v["reference"] for v in library.description.variables.values()]
        numbers = [0.0, -1.0, float("nan"), float("inf"), -float("inf")]
        statuses = set()
        for _ in range(12):
            one = Slave(library, logging=rng.random() < 0.5)
            states, time = [], 0.0
            for _ in range(150):
                action, status = rng.randrange(14), 0
                if action == 0: status = one.enter(rng.choice(numbers), rng.choice([None, 10.0]))
                elif action == 1: status = one.exit()
                elif action == 2: status = one.terminate() if rng.random() < 0.1 else 0
                elif action == 3: status = one.reset() if rng.random() < 0.2 else 0
                elif action in (4, 5):
                    k = rng.randrange(len(names))
                    status = one.set(names[k], starts[k] * rng.uniform(0.95, 1.05) if starts[k] else rng.random())
                elif action == 6: status = one.set_references([rng.choice(references)], [rng.choice(numbers)])
                elif action == 7: status = one.get_references(rng.sample(references, 3), 3)[0]
                elif action == 8: status = one.get_references([rng.randrange(2**32)], 1)[0]
                elif action in (9, 10):
                    h = rng.choice([0.05, 0.0, 0.01])
                    status = one.step(time, h)
                    time += h if status == 0 else 0.0
                elif action == 11:
                    states.append(one.save())
                    status = 0
                elif action == 12 and states:
                    status = one.restore(rng.choice(states))
                elif action == 13 and states:
                    status, state = one.deserialize(one.serialize(rng.choice(states)))
                    states.append(state)
                assert status in (0, 1, 3), status
                statuses.add(status)
            for state in states:
                one.free_state(state)
            one.free()
        assert {0, 3} <= statuses
        """, tmp_path, seed)
    assert done.stdout == "" and done.stderr == ""
