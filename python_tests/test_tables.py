"""Tables of `moorline run` in Parquet, read by pyarrow, beside those in CSV."""

import csv
import math

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import scenes
from runs import run


MOVED = scenes.CHAIN + scenes.table("motion", "fairlead = { x = [[2.0, 8.0]], z = [[1.0, 6.0]] }")


def in_parquet(moorline, folder, output):
    """The folder of a run that writes Parquet, and columns of the same run in CSV."""
    paths = [folder / "csv.toml", folder / "parquet.toml"]
    for path, more in zip(paths, ["", 'format = "parquet"\n']):
        path.write_text(MOVED.replace("interval = 0.05\n", f"interval = 0.05\n{more}{output}"))
    columns = run(moorline, paths[0], folder / "csv")
    done = moorline("run", paths[1], "-o", folder / "parquet")
    assert done.returncode == 0, done.stderr
    return folder / "parquet", columns


@pytest.mark.parametrize("output, kind", [("", pa.float64()), ("digits = 6\n", pa.float32()), ("digits = 8\n", pa.float64())])
def test_results_in_parquet_are_those_in_csv_with_units_and_descriptions(moorline, tmp_path, output, kind):
    folder, columns = in_parquet(moorline, tmp_path, output)
    table = pq.read_table(folder / "results.parquet")
    assert table.column_names == list(columns)
    with open(folder / "results.units.csv") as file:
        units = {row["name"]: row for row in csv.DictReader(file)}
    for name, values in columns.items():
        field = table.schema.field(name)
        metadata = {key.decode(): value.decode() for key, value in field.metadata.items()}
        assert (metadata["unit"], metadata["description"]) == (units[name]["unit"], units[name]["description"])
        whole = name == "solver.substeps"
        assert field.type == (pa.float64() if name == "time" else pa.int64() if whole else kind), name
        found = table[name].to_pylist()
        if field.type == pa.float32():
            assert all(math.isclose(a, b, rel_tol=1e-7) for a, b in zip(found, values)), name
        else:
            assert found == list(values), name


def test_profiles_in_parquet_are_those_in_csv(moorline, tmp_path):
    folder, _ = in_parquet(moorline, tmp_path, "profile = true\n")
    table = pq.read_table(folder / "profile.parquet").to_pylist()
    with open(tmp_path / "csv" / "profile.csv") as file:
        rows = list(csv.DictReader(file))
    assert len(table) == len(rows)
    for found, row in zip(table, rows):
        assert found.keys() == row.keys()
        for name, text in row.items():
            assert found[name] == text if name == "line" else found[name] == float(text)
