"""A coupled simulation in libcosim (FMI 2.0): two moorings, one driven, one following it."""

import math

import pytest

libcosimpy = pytest.importorskip("libcosimpy")

from libcosimpy.CosimEnums import CosimVariableType  # noqa: E402
from libcosimpy.CosimExecution import CosimExecution  # noqa: E402
from libcosimpy.CosimManipulator import CosimManipulator  # noqa: E402
from libcosimpy.CosimObserver import CosimObserver  # noqa: E402
from libcosimpy.CosimSlave import CosimLocalSlave  # noqa: E402

from fmu_calls import Slave  # noqa: E402

NANOSECONDS = 1_000_000_000


@pytest.fixture
def execution():
    return CosimExecution.from_step_size(step_size=int(0.05 * NANOSECONDS))


def test_libcosim_gets_what_a_plain_loop_gets(execution, package, library):
    index = execution.add_local_slave(CosimLocalSlave(fmu_path=str(package("CHAIN", 2)), instance_name="mooring"))
    d = library("CHAIN", 2).description
    manipulator, observer = CosimManipulator.create_override(), CosimObserver.create_last_value()
    execution.add_manipulator(manipulator)
    execution.add_observer(observer)
    outputs = ["line1.tension_b", "fairlead.fx", "fairlead.fz"]
    references = [d.reference(name) for name in outputs]
    plain = Slave(library("CHAIN", 2)).initialize()
    for k in range(60):
        x = 2.0 * math.sin(0.035 * k)
        manipulator.slave_real_values(index, [d.reference("fairlead.x")], [x])
        assert execution.step()
        plain.expect(plain.set("fairlead.x", x))
        plain.expect(plain.step(0.05 * k, 0.05))
        assert observer.last_real_values(index, references) == pytest.approx([plain.get(n) for n in outputs], rel=1e-9)
    plain.free()


def test_libcosim_connects_two_moorings(execution, package, library):
    path = str(package("CHAIN", 2))
    first, second = (execution.add_local_slave(CosimLocalSlave(fmu_path=path, instance_name=name))
                     for name in ("first", "second"))
    d = library("CHAIN", 2).description
    x, sag = d.reference("fairlead.x"), d.reference("line1.sag")
    assert execution.connect_real_variables(first, sag, second, d.reference("fairlead.y")) == 0
    manipulator, observer = CosimManipulator.create_override(), CosimObserver.create_last_value()
    execution.add_manipulator(manipulator)
    execution.add_observer(observer)
    manipulator.slave_real_values(first, [x], [0.5])
    assert execution.simulate_until(int(1.0 * NANOSECONDS))
    assert execution.num_slave_variables(first) == len(d.variables)
    assert math.isfinite(observer.last_real_values(second, [d.reference("line1.tension_b")])[0])
    kinds = {v.name.decode(): v.type for v in execution.slave_variables(first)}
    assert kinds["solver.substeps"] == CosimVariableType.INTEGER.value
