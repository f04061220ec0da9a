//! Synthetic record for tests of the writers: two parabolic lines on a swaying fairlead.

use std::f64::consts::TAU;
use std::time::Duration;

use super::record::{
    Catenary, Column, Counters, Form, Frame, LineRecord, Node, Record, StaticLine, Surroundings,
};

const DEPTH: f64 = 200.0;
const ELEMENTS: usize = 20;

fn columns() -> Vec<Column> {
    let of = |name: &str, unit: &str, description: &str| Column::new(name, unit, description, Form::Real);
    vec![
        of("fairlead.x", "m", "displacement"),
        of("fairlead.fx", "N", "end force, on the vessel"),
        of("fairlead.fy", "N", "end force, on the vessel"),
        of("fairlead.fz", "N", "end force, on the vessel"),
        of("line1.tension_b", "N", "tension at end B"),
        of("line1.tension_a", "N", "tension at end A"),
        of("line1.tension_max", "N", "greatest tension"),
        of("line1.laid_length", "m", "length on the seabed"),
        of("line1.sag", "m", "sag"),
        of("line2.tension_b", "N", "tension at end B"),
    ]
}

/// Shape with end B displaced along x by `shift` [m]; `side` is 1 or -1.
fn shape(side: f64, shift: f64) -> Vec<Node> {
    (0..=ELEMENTS)
        .map(|i| {
            let u = i as f64 / ELEMENTS as f64;
            let hang = ((u - 0.4) / 0.6).max(0.0);
            Node {
                s: 835.0 * u,
                position: [
                    side * (837.0 - 797.0 * u) + shift * u,
                    0.0,
                    -DEPTH + 186.0 * hang * hang,
                ],
                tension: 0.7e6 + 0.2e6 * hang,
                bending: None,
            }
        })
        .collect()
}

fn line(name: &str, side: f64) -> LineRecord {
    let figures = StaticLine {
        tension_b: 911_089.46,
        horizontal: 736_939.29,
        sag: 81.3,
        laid_length: 260.0,
        bending: None,
    };
    LineRecord {
        name: name.to_string(),
        equilibrium: Some(StaticLine {
            tension_b: 911_120.0,
            ..figures
        }),
        catenary: Some(Catenary {
            figures,
            profile: shape(side, 0.0).iter().map(|node| node.position).collect(),
        }),
    }
}

/// Rows of the record.
pub(super) fn rows() -> Vec<Vec<f64>> {
    let row = |i: i32| {
        let time = 0.1 * f64::from(i);
        let sway = 5.0 * (TAU * time / 12.0).sin() * (time / 10.0).min(1.0);
        let pull = 911e3 + 30e3 * sway;
        vec![
            time,
            sway,
            pull,
            1e3 * sway,
            -535e3 - 12e3 * sway,
            pull,
            pull - 40e3,
            pull,
            260.0 - sway,
            81.3 - 0.1 * sway,
            911e3 - 30e3 * sway,
        ]
    };
    (0..=600).map(row).collect()
}

/// Returns the record.
pub(super) fn record() -> Record {
    let rows = rows();
    let mut record = Record::new("two lines on a seabed, swaying", columns(), rows.len());
    rows.iter().for_each(|row| record.add_row(row));
    record.course.frames = (0..13)
        .map(|i| {
            let time = 5.0 * f64::from(i);
            let shift = 12.0 * (TAU * time / 60.0).sin();
            Frame {
                time,
                lines: vec![shape(1.0, shift), shape(-1.0, shift)],
            }
        })
        .collect();
    record.lines = vec![line("line1", 1.0), line("line2", -1.0)];
    record.points = vec!["fairlead".to_string()];
    record.surroundings = Surroundings {
        water: true,
        seabed: Some(-DEPTH),
    };
    record.course.counters = Counters {
        substeps: 24_000,
        simulated: 60.0,
        wall: Duration::from_millis(40),
    };
    record
}
