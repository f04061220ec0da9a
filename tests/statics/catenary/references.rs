//! Comparison with rows of reference values.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use moorline::statics::catenary::{FlatSeabed, Section};

use super::Line;
use crate::common::greatest;

/// Greatest deviations of a solved line from a row of reference values: of forces relative to T at the fairlead (at least the anchor's if
/// that one is zero), and of positions and lengths relative to the length [-].
fn compare_row(row: &HashMap<String, String>, seabed: Option<FlatSeabed>) -> (f64, f64) {
    let number = |name: &str| -> f64 { row[name].parse().unwrap_or_else(|_| panic!("{name} of {row:?}")) };
    let section = |i: usize| Section {
        length: number(&format!("L{i}")),
        weight: number(&format!("w{i}")),
        axial_stiffness: number(&format!("EA{i}")),
    };
    let sections = (1..=number("nseg") as usize).map(section).collect();
    let line = Line::of(sections, number("XF"), number("ZF"), seabed);
    let solved = line.solve();
    let scale = match number("T_fair") {
        tension if tension > 0.0 => tension,
        _ => number("T_anch").max(f64::MIN_POSITIVE),
    };
    let vertical = (solved.vertical_b() - number("V_fair")).abs() / scale;
    if row["cls"].starts_with("degenerate") {
        return (vertical, 0.0);
    }
    let forces = [
        (solved.horizontal(), "H_fair"),
        (solved.tension_b(), "T_fair"),
        (solved.horizontal_a(), "H_anch"),
        (solved.vertical_a(), "V_anch"),
        (solved.tension_a(), "T_anch"),
    ];
    let middle = solved.at(0.5 * line.length());
    let lengths = [
        (middle.x, "mid_x"),
        (middle.z, "mid_z"),
        (solved.laid_length(), "laid_unstretched"),
        (solved.stretched_length(), "stretched_length"),
    ];
    let most = |pairs: &[(f64, &str)], scale: f64| {
        greatest(
            pairs
                .iter()
                .map(|(value, name)| (value - number(name)).abs() / scale),
        )
    };
    (most(&forces, scale).max(vertical), most(&lengths, line.length()))
}

/// Compares every row of a table, prints the greatest deviation of every class, and returns the number of rows.
fn compare_table(path: &Path, tolerance: f64) -> usize {
    let mut reader = csv::Reader::from_path(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let mut worst = BTreeMap::<String, (usize, f64, f64)>::new();
    let mut rows = 0;
    for row in reader.deserialize() {
        let row: HashMap<String, String> = row.expect("a row of the table");
        let height = row
            .get("seabed_height")
            .map_or(0.0, |height| height.parse().expect("seabed_height is a number"));
        let friction = row["CB"].parse().expect("CB is a number");
        let seabed = (row["seabed"] == "1").then_some(FlatSeabed { height, friction });
        let (force, length) = compare_row(&row, seabed);
        let entry = worst.entry(row["cls"].clone()).or_default();
        *entry = (entry.0 + 1, entry.1.max(force), entry.2.max(length));
        let found = format!(
            "row {} ({}): forces {force:e}, lengths {length:e}",
            row["id"], row["cls"]
        );
        assert!(force <= tolerance && length <= tolerance, "{found}");
        rows += 1;
    }
    for (class, (count, force, length)) in worst {
        println!("{count:3} rows {class}: forces {force:.1e}, lengths {length:.1e}");
    }
    rows
}

#[test]
fn every_row_of_the_reference_bank_is_met_to_nine_digits() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/reference/catenary.csv");
    assert!(compare_table(&path, 1e-9) >= 60);
}

#[test]
fn every_row_of_the_external_bank_is_met_to_nine_digits() {
    let Some(folder) = std::env::var_os("MOORLINE_REFERENCE") else {
        println!("skipped: MOORLINE_REFERENCE does not name the folder that holds catenary_bank.csv");
        return;
    };
    let rows = compare_table(&Path::new(&folder).join("catenary_bank.csv"), 1e-9);
    assert_eq!(rows, 182);
}
